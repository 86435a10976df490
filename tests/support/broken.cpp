// SPDX-License-Identifier: MIT
#include "support/broken.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace knotwave::support {
namespace fs = std::filesystem;
namespace {

const std::string kFolder = std::string(KNOTWAVE_SOURCE_DIR) + "/tests/golden/broken/";

void remove_all(std::string& text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part)) {
    text.erase(at, part.size());
  }
}

}  // namespace

std::vector<BrokenFile> broken_files(const std::string& prefix) {
  std::vector<BrokenFile> files;
  std::set<std::string> named;
  std::ifstream table(kFolder + "EXPECT.tsv");
  EXPECT_TRUE(table) << "tests/golden/broken/EXPECT.tsv is missing";
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream fields(line);
    BrokenFile file;
    std::getline(fields, file.name, '\t');
    std::getline(fields, file.code, '\t');
    std::getline(fields, file.report);
    file.path = kFolder + file.name;
    named.insert(file.name);
    EXPECT_TRUE(fs::exists(file.path)) << file.name;
    if (file.name.starts_with(prefix)) files.push_back(file);
  }
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".toml")) continue;
    EXPECT_TRUE(named.contains(name)) << name << " has no line in EXPECT.tsv";
    if (!named.contains(name) && name.starts_with(prefix)) {
      files.push_back({name, kFolder + name, "", ""});
    }
  }
  return files;
}

std::string broken_report(const BrokenFile& file, const Error& error) {
  std::string report = error.to_string();
  remove_all(report, kFolder);
  remove_all(report, std::string(KNOTWAVE_SOURCE_DIR) + "/");
  if (const char* out = std::getenv("KNOTWAVE_BROKEN_OUT")) {
    std::ofstream(out, std::ios::app)
        << file.name << '\t' << to_string(error.code) << '\t' << report << '\n';
  }
  return report;
}

}  // namespace knotwave::support
