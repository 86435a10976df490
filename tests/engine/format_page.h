// SPDX-License-Identifier: MIT
// The tables of a page about a file format, and documents made of their examples.
#pragma once
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace knotwave::engine {

namespace fs = std::filesystem;

inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string without_ticks(std::string text) {
  std::erase(text, '`');
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// The first two columns of the table rows below each heading that begin with a word in ticks.
struct Row {
  std::string key, example;
};
inline std::map<std::string, std::vector<Row>> documented(const std::string& page_path) {
  std::map<std::string, std::vector<Row>> sections;
  std::istringstream page(read_text(page_path));
  std::string heading;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) heading = without_ticks(line.substr(line.find(' ')));
    if (!line.starts_with("| `")) continue;
    std::istringstream cells(line.substr(2));
    Row row;
    std::getline(cells, row.key, '|');
    std::getline(cells, row.example, '|');
    row.key = without_ticks(row.key);
    row.example = without_ticks(row.example);
    sections[heading].push_back(row);
  }
  return sections;
}

// A document as sections of keys, in the order of a file.
class Document {
 public:
  void set(const std::string& section, const std::string& key, const std::string& value) {
    sections_[section][key] = value;
  }
  void remove(const std::string& section, const std::string& key) { sections_[section].erase(key); }
  std::string text() const {
    std::string text;
    for (const auto& [section, keys] : sections_) {
      text += section.empty() ? "" : section + "\n";
      for (const auto& [key, value] : keys) text += key + " = " + value + "\n";
    }
    return text;
  }

 private:
  std::map<std::string, std::map<std::string, std::string>> sections_;
};

/// Every key that the source of a reader asks for.
inline std::vector<std::string> keys_asked_for(const std::string& source_path) {
  static const std::regex asks(
      "(?:reader|top|again)\\.(?:number|integer|boolean|string|choice|numbers|node|table|array|"
      "required)\\(\"(\\w+)\"|(?:curve_name|read_range|port_name)\\((?:reader|again), \"(\\w+)\"|"
      "tables_of\\(\"(\\w+)\"|named_tables\\(\"(\\w+)\"|pair\\(\"(\\w+)\"");
  const std::string source = read_text(source_path);
  std::vector<std::string> keys;
  for (std::sregex_iterator match(source.begin(), source.end(), asks), end; match != end; ++match) {
    for (std::size_t group = 1; group < match->size(); ++group) {
      if ((*match)[group].matched) keys.push_back((*match)[group]);
    }
  }
  return keys;
}

}  // namespace knotwave::engine
