// SPDX-License-Identifier: MIT
// tests/golden/broken: files with one fault each, and the first line of the report on each.
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::support {

/// One line of EXPECT.tsv.
struct BrokenFile {
  std::string name;  ///< curve_*.toml, patch_*.toml, bank_*.toml
  std::string path;
  std::string code;    ///< of the error
  std::string report;  ///< Error::to_string(), folders left out
};

/// The lines whose name begins with `prefix`; a test fails on a file that has no line, or the other
/// way round.
std::vector<BrokenFile> broken_files(const std::string& prefix);

/// An error's report without our folders, as in EXPECT.tsv. With KNOTWAVE_BROKEN_OUT set to a file,
/// the true line is appended there, so that a changed message is reviewed and not retyped.
std::string broken_report(const BrokenFile& file, const Error& error);

}  // namespace knotwave::support
