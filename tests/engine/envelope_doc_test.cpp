// SPDX-License-Identifier: MIT
// docs/envelope-format.md against the reader: every key and word in its tables is accepted with its
// example, and every key the reader asks for is in the tables. And the shipped patches.
#include <set>

#include <gmock/gmock.h>
#include <unistd.h>

#include "knotwave/engine/envelope_patch_program.h"

#include "engine/format_page.h"

namespace knotwave::engine {
namespace {

const std::string kRoot = KNOTWAVE_SOURCE_DIR;
const std::string kPage = kRoot + "/docs/envelope-format.md";

class EnvelopeDocument : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("knotwave_envelope_doc_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write("curves.toml",
          "format = 1\nkind = 'curve'\n[curves.swell]\ndegree = 1\npoints = [0, 1]\n");
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
    document.set("", "kind", "'envelope'");
    document.set("[ports.synth]", "wire", "'din'");
    document.set("[curves.swell]", "degree", "1");
    document.set("[curves.swell]", "points", "[0, 0.5, 1]");
    document.set("[surfaces.row]", "degree_u", "1");
    document.set("[surfaces.row]", "degree_v", "1");
    document.set("[surfaces.row]", "points", "[[0, 0], [0, 1]]");
    document.set("[envelopes.swell]", "curve", "'swell'");
    document.set("[lfos.wow]", "curve", "'sine'");
    document.set("[[maps]]", "from", "'mod'");
    document.set("[[maps]]", "to", "'free.depth'");
    document.set("[[outputs]]", "from", "'swell'");
    document.set("[[outputs]]", "to", "'cc1'");
    document.set("[[events]]", "envelope", "'swell'");
    return document;
  }
  void expect_accepted(const Document& document, const std::string& what) {
    const auto spec = read_envelope_patch(write("test.toml", document.text()));
    ASSERT_TRUE(spec) << what << ": " << spec.error().to_string() << "\n" << document.text();
    const auto program = EnvelopePatchProgram::create(*spec);
    EXPECT_TRUE(program) << what << ": " << program.error().to_string() << "\n" << document.text();
  }
  // The example put into its table, with what it needs and without what it excludes.
  void try_key(const std::string& section, const Row& row) {
    Document document = patch();
    const std::string& key = row.key;
    if (section == "[[events]]" && key != "gate") document.set(section, "note", "1");
    if (key == "notes_port") document.set("", "notes", "'thru'");
    if (section == "[trigger]") {
      const std::set<std::string> of_clock = {"beats", "offset_beats", "gate"};
      if (of_clock.contains(key)) document.set(section, "from", "'clock'");
      if (key == "threshold") document.set(section, "from", "'cc20'");
    }
    if (key == "address" || key == "rate_hz") {
      if (section == "[[outputs]]") document.set(section, "to", "'osc'");
      if (section == "[[outputs]]") document.set(section, "address", "'/a'");
    }
    if (key == "cv_channel") document.set(section, "to", "'cv'");
    if (key == "volts") document.remove(section, "note");
    if (key == "volts") document.set(section, "gate", "1");
    if (section == "[[maps]]" && key == "surface") {
      document.set(section, "from", "['mod', 'velocity']");
    }
    if (key == "low" || key == "high") {
      document.set(section, "to", "'curve.swell.weight.0'");
      document.set(section, "low", "0.4");
      document.set(section, "high", "5");
    }
    if (key == "curve_file") {
      document.remove(section, "degree");
      document.remove(section, "points");
    }
    if (section != "[[events]]") document.set("[[events]]", "gate", "1");
    document.set(section, key, row.example);
    expect_accepted(document, section + " " + key);
  }
  fs::path folder_;
};

TEST_F(EnvelopeDocument, EveryDocumentedKeyIsAcceptedWithItsExample) {
  const std::map<std::string, std::string> sections = {{"The patch itself", ""},
                                                       {"[trigger]", "[trigger]"},
                                                       {"[ports.NAME]", "[ports.synth]"},
                                                       {"Curves and surfaces", "[curves.swell]"},
                                                       {"[envelopes.NAME]", "[envelopes.swell]"},
                                                       {"[lfos.NAME]", "[lfos.wow]"},
                                                       {"[[maps]]", "[[maps]]"},
                                                       {"[[outputs]]", "[[outputs]]"},
                                                       {"[[events]]", "[[events]]"}};
  auto pages = documented(kPage);
  int keys = 0;
  for (const auto& [heading, section] : sections) {
    EXPECT_FALSE(pages[heading].empty()) << heading;
    for (const Row& row : pages[heading]) try_key(section, row), ++keys;
  }
  EXPECT_GE(keys, 65);
}

TEST_F(EnvelopeDocument, EveryDocumentedTargetAndDestinationIsAccepted) {
  auto pages = documented(kPage);
  ASSERT_EQ(pages["Targets"].size(), 6u);
  for (const Row& row : pages["Targets"]) {
    Document document = patch();
    document.set("[[events]]", "gate", "1");
    std::string word = std::regex_replace(row.key, std::regex("\\.I$"), ".0");
    word = std::regex_replace(word, std::regex("\\.K$"), ".2");
    word = std::regex_replace(word, std::regex("NAME"), word.starts_with("lfo") ? "wow" : "swell");
    document.set("[[maps]]", "to", "'" + word + "'");
    if (word.starts_with("curve.")) {
      const bool is_knot = row.key.ends_with("K");
      const bool is_point = row.key.ends_with("point.I");
      document.set("[[maps]]", "low", is_knot ? "0.25" : is_point ? "-1" : "0.5");
      document.set("[[maps]]", "high", is_knot ? "0.75" : "2");
    }
    expect_accepted(document, word);
  }
  ASSERT_EQ(pages["Destinations"].size(), 7u);
  for (const Row& row : pages["Destinations"]) {
    std::istringstream words(row.key);  // "cc0 … cc119" are two
    for (std::string word; words >> word;) {
      if (word == "…") continue;
      Document document = patch();
      document.set("[[events]]", "gate", "1");
      document.set("[[outputs]]", "to", "'" + word + "'");
      if (word == "osc") document.set("[[outputs]]", "address", "'/a'");
      expect_accepted(document, word);
    }
  }
}

TEST_F(EnvelopeDocument, EveryKeyTheReaderAsksForIsDocumented) {
  std::set<std::string> known;
  for (const auto& [heading, rows] : documented(kPage)) {
    for (const Row& row : rows) known.insert(row.key);
  }
  // The names of tables have headings instead of rows.
  for (const char* table : {"trigger", "ports", "curves", "surfaces", "envelopes", "lfos", "maps",
                            "outputs", "events"}) {
    known.insert(table);
  }
  int asked = 0;
  for (const char* source : {"patch_tables", "patch_envelopes", "patch_maps",
                             "envelope_patch_reader", "envelope_patch_outputs"}) {
    const std::string path = kRoot + "/engine/src/" + source + ".cpp";
    for (const std::string& key : keys_asked_for(path)) {
      EXPECT_TRUE(known.contains(key)) << source << " reads '" << key << "'";
      ++asked;
    }
  }
  EXPECT_GE(asked, 75);
}

// The page's own patches read.
TEST_F(EnvelopeDocument, ThePatchAtTheTopOfThePageIsOne) {
  const std::string page = read_text(kPage);
  const std::size_t begin = page.find("```toml\n") + 8;
  const std::string text = page.substr(begin, page.find("```", begin) - begin);
  const auto spec = parse_envelope_patch(text, "page.toml");
  ASSERT_TRUE(spec) << spec.error().to_string();
  EXPECT_TRUE(EnvelopePatchProgram::create(*spec));
}

TEST(ShippedEnvelopes, EachReadsCompilesAndFitsOnAScreen) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(kRoot + "/examples/envelopes")) {
    const std::string path = entry.path().string();
    const auto spec = read_envelope_patch(path);
    ASSERT_TRUE(spec) << spec.error().to_string();
    const auto program = EnvelopePatchProgram::create(*spec);
    EXPECT_TRUE(program) << program.error().to_string();
    EXPECT_FALSE(spec->patch.name.empty()) << path;
    const std::string text = read_text(path);
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 75) << path;
    ASSERT_EQ(spec->texts.size(), 1u);
    EXPECT_EQ(spec->texts[0].bytes, text);
    ++count;
  }
  EXPECT_GE(count, 6);
}

}  // namespace
}  // namespace knotwave::engine
