// SPDX-License-Identifier: MIT
// docs/patch-format.md against the readers: every key and word in its tables is accepted with its
// example, and every key the readers ask for is in the tables.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "knotwave/engine/bank.h"

#include "engine/format_page.h"

namespace knotwave::engine {
namespace {

const std::string kRoot = KNOTWAVE_SOURCE_DIR;
const std::string kPage = kRoot + "/docs/patch-format.md";

constexpr const char* kCurves =
    "[curves.ring]\ndegree = 1\npoints = [0, 1]\n"
    "[surfaces.row]\ndegree_u = 1\ndegree_v = 1\npoints = [[0, 1], [1, 0]]\n";

// A patch with a table of every kind, and the files its examples name beside it.
class PatchDocument : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("knotwave_patch_doc_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write("just.scl", "just\n2\n3/2\n2/1\n");
    write("keys.kbm", "0\n0\n127\n60\n69\n440\n12\n");
    write("cycle.wav", "RIFF");
    write("curves.toml", std::string("format = 1\nkind = 'curve'\n") + kCurves);
    write("p.toml", patch().text());
  }
  void TearDown() override {
    std::error_code failed;
    fs::remove_all(folder_, failed);
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  static Document patch() {
    Document document;
    document.set("", "format", "1");
    document.set("", "kind", "'patch'");
    document.set("[curves.ring]", "degree", "1");
    document.set("[curves.ring]", "points", "[0, 1]");
    document.set("[surfaces.row]", "degree_u", "1");
    document.set("[surfaces.row]", "degree_v", "1");
    document.set("[surfaces.row]", "points", "[[0, 1], [1, 0]]");
    document.set("[oscillators.a]", "wave", "'row'");
    document.set("[envelopes.amp]", "curve", "'ring'");
    document.set("[lfos.wow]", "curve", "'sine'");
    document.set("[noise]", "level_db", "-20");
    document.set("[filter]", "kind", "'low'");
    document.set("[shaper]", "curve", "'ring'");
    document.set("[crossfade]", "between", "['a', 'noise']");
    document.set("[[maps]]", "from", "'mod'");
    document.set("[[maps]]", "to", "'pitch'");
    return document;
  }
  static Document bank() {
    Document document;
    document.set("", "format", "1");
    document.set("", "kind", "'bank'");
    document.set("[[programs]]", "patch", "'p.toml'");
    return document;
  }
  void expect_accepted(const Document& document, const std::string& what) {
    const auto bank = read_bank(write("test.toml", document.text()));
    EXPECT_TRUE(bank) << what << ": " << bank.error().to_string() << "\n" << document.text();
  }
  // The example put into its table, with what it needs and without what it excludes.
  void try_key(Document document, const std::string& section, const Row& row) {
    if (row.key.starts_with("wave_")) document.remove(section, "wave");
    if (row.key == "wave_frame") document.set(section, "wave_file", "'cycle.wav'");
    if (row.key == "surface") document.set(section, "from", "['mod', 'key']");
    if (row.key == "low" || row.key == "high") {
      document.set(section, "to", "'curve.ring.weight.0'");
      document.set(section, "low", "0.4");
      document.set(section, "high", "5");
    }
    if (row.key == "curve_file") {
      document.remove(section, "degree");
      document.remove(section, "points");
    }
    document.set(section, row.key, row.example);
    expect_accepted(document, section + " " + row.key);
  }
  fs::path folder_;
};

TEST_F(PatchDocument, EveryDocumentedKeyIsAcceptedWithItsExample) {
  const std::map<std::string, std::string> patch_sections = {
      {"The patch itself", ""},
      {"Curves and surfaces", "[curves.ring]"},
      {"[oscillators.NAME]", "[oscillators.a]"},
      {"[noise]", "[noise]"},
      {"[crossfade]", "[crossfade]"},
      {"[shaper]", "[shaper]"},
      {"[filter]", "[filter]"},
      {"[envelopes.NAME]", "[envelopes.amp]"},
      {"[lfos.NAME]", "[lfos.wow]"},
      {"[[maps]]", "[[maps]]"}};
  const std::map<std::string, std::string> bank_sections = {{"The bank itself", ""},
                                                            {"[[programs]]", "[[programs]]"}};
  auto sections = documented(kPage);
  int keys = 0;
  for (const auto& [heading, section] : patch_sections) {
    EXPECT_FALSE(sections[heading].empty()) << heading;
    for (const Row& row : sections[heading]) try_key(patch(), section, row), ++keys;
  }
  for (const auto& [heading, section] : bank_sections) {
    EXPECT_FALSE(sections[heading].empty()) << heading;
    for (const Row& row : sections[heading]) try_key(bank(), section, row), ++keys;
  }
  for (const Row& row : sections["[drums]"]) {
    Document document = bank();
    document.set("[drums]", "keys", "[]");
    try_key(document, "[drums]", row);
    ++keys;
  }
  for (const Row& row : sections["[[drums.keys]]"]) {
    Document document = bank();
    document.set("[[drums.keys]]", "key", "36");
    document.set("[[drums.keys]]", "patch", "'p.toml'");
    document.set("[[drums.keys]]", row.key, row.example);
    expect_accepted(document, row.key);
    ++keys;
  }
  EXPECT_GE(keys, 80);
}

TEST_F(PatchDocument, EveryDocumentedSourceAndTargetIsAccepted) {
  auto sections = documented(kPage);
  ASSERT_GE(sections["Sources"].size(), 17u);
  ASSERT_GE(sections["Targets"].size(), 23u);
  for (const Row& row : sections["Sources"]) {
    std::istringstream words(row.key);  // "cc0 … cc119" are two
    for (std::string word; words >> word;) {
      if (word == "…") continue;
      Document document = patch();
      if (word == "free.NAME") {
        document.set("[[maps]] # onto it", "from", "'mod'");
        document.set("[[maps]] # onto it", "to", "'free.NAME'");
      }
      document.set("[[maps]]", "from", "'" + word + "'");
      expect_accepted(document, word);
    }
  }
  for (const Row& row : sections["Targets"]) {
    const bool curve = row.key.starts_with("curve.");
    std::string word = std::regex_replace(row.key, std::regex("\\.[IK]$"),
                                          curve && row.key.ends_with("K") ? ".2" : ".0");
    const char* name = curve                              ? "ring"
                       : row.key.starts_with("lfo.")      ? "wow"
                       : row.key.starts_with("envelope.") ? "amp"
                                                          : "a";
    word = std::regex_replace(word, std::regex("NAME"), name);
    Document document = patch();
    document.set("[[maps]]", "to", "'" + word + "'");
    if (row.key.ends_with("K")) document.set("[curves.ring]", "points", "[0, 0.5, 1]");
    if (curve) {
      document.set("[[maps]]", "low", row.key.ends_with("K") ? "0.25" : "0.5");
      document.set("[[maps]]", "high", row.key.ends_with("K") ? "0.75" : "2");
    }
    expect_accepted(document, word);
  }
}

TEST_F(PatchDocument, EveryKeyTheReadersAskForIsDocumented) {
  std::set<std::string> known;
  for (const auto& [heading, rows] : documented(kPage)) {
    for (const Row& row : rows) known.insert(row.key);
  }
  // The names of tables have headings instead of rows.
  for (const char* table : {"curves", "surfaces", "oscillators", "noise", "crossfade", "shaper",
                            "filter", "envelopes", "lfos", "maps", "programs", "drums"}) {
    known.insert(table);
  }
  int asked = 0;
  for (const auto& entry : fs::directory_iterator(kRoot + "/engine/src")) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("patch_") && !name.starts_with("bank_reader")) continue;
    for (const std::string& key : keys_asked_for(entry.path().string())) {
      EXPECT_TRUE(known.contains(key)) << name << " reads '" << key << "'";
      ++asked;
    }
  }
  EXPECT_GE(asked, 70);
}

}  // namespace
}  // namespace knotwave::engine
