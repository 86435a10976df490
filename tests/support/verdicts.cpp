// SPDX-License-Identifier: MIT
#include "support/verdicts.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace knotwave::support {

Verdicts read_verdicts(const std::string& path) {
  Verdicts verdicts;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    const std::size_t tab = line.find('\t');
    verdicts[line.substr(0, tab)] = line.substr(tab + 1);
  }
  return verdicts;
}

void expect_verdicts(const Verdicts& frozen, const Verdicts& seen, const std::string& seen_path) {
  if (frozen == seen) return;
  std::ofstream out(seen_path);
  out << "file\tverdict\n";
  for (const auto& [file, verdict] : seen) out << file << '\t' << verdict << '\n';
  ADD_FAILURE() << "verdicts changed; the table as seen is in " << seen_path;
  for (const auto& [file, verdict] : seen) {
    const auto row = frozen.find(file);
    EXPECT_EQ(row == frozen.end() ? "(not in the table)" : row->second, verdict) << file;
  }
  for (const auto& [file, verdict] : frozen) {
    EXPECT_TRUE(seen.contains(file)) << file << " is in the table, but not in the corpus";
  }
}

std::map<std::string, std::string> read_expectations(const std::string& path) {
  std::map<std::string, std::string> expectations;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    expectations[line.substr(0, line.find('\t'))] = line.substr(line.rfind('\t') + 1);
  }
  return expectations;
}

bool is_expected(const std::string& verdict, const std::string& expectation, bool warns) {
  const auto begins = [&](const char* word) { return expectation.starts_with(word); };
  const auto holds = [&](const char* word) { return expectation.find(word) != std::string::npos; };
  const bool is_accept = verdict.starts_with("accept");
  const bool is_clean = verdict == "accept 0";
  if (begins("load")) return is_clean;
  if (begins("no crash") || begins("use 64-bit ticks")) return true;
  if (begins("reject")) return !is_accept || holds(" or ") || holds(", or ");
  if (begins("tolerate") && holds("or reject")) return true;
  return is_accept && (!warns || !is_clean);
}

}  // namespace knotwave::support
