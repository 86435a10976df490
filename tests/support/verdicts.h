// SPDX-License-Identifier: MIT
// Frozen verdicts on hostile files: what a reader says to each, and what the corpus expects of it.
#pragma once
#include <map>
#include <string>

namespace knotwave::support {

/// `accept N` with the number of warnings, or the name of the error code.
using Verdicts = std::map<std::string, std::string>;

/// Rows `file<TAB>verdict` after a heading line; empty when there is no such file.
Verdicts read_verdicts(const std::string& path);

/// Fails for every file whose verdict differs, is missing in the table, or is in it without a file.
/// On a difference the table as seen is written to `seen_path`, to be read and compared by eye.
void expect_verdicts(const Verdicts& frozen, const Verdicts& seen, const std::string& seen_path);

/// Column `expected` of an EXPECT.tsv, by file.
std::map<std::string, std::string> read_expectations(const std::string& path);

/// Whether a verdict is what an EXPECT.tsv sentence allows: "load..." is an accept without
/// warnings, "tolerate..." and "ignore..." an accept (with a warning when `warns`), "reject..." an
/// error; a sentence that gives a choice allows both.
bool is_expected(const std::string& verdict, const std::string& expectation, bool warns);

}  // namespace knotwave::support
