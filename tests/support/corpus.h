// SPDX-License-Identifier: MIT
// Test data outside the repository, named by KNOTWAVE_CORPUS. A test that wants it says how many
// files it ran, and says so when there is none.
#pragma once
#include <string>
#include <vector>

namespace knotwave::support {

/// The corpus folder, or empty when KNOTWAVE_CORPUS is not set or names no folder.
std::string corpus_root();

/// Files below corpus_root()/sub with one of the extensions (".mid"), sorted; empty without.
std::vector<std::string> corpus_files(const std::string& sub,
                                      const std::vector<std::string>& extensions);

}  // namespace knotwave::support
