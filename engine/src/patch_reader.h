// SPDX-License-Identifier: MIT
// Reads a patch of sound. Private to the patch files. [control]
#pragma once
#include <string>

#include "patch_tables.h"

namespace knotwave::engine {

/// The patch a document holds, its kind already known.
Result<PatchSpec> read_patch(const base::Node& root, const std::string& source_name,
                             FileShelf& shelf);

class PatchReader : private PatchTables {
 public:
  PatchReader(const base::Node& root, const std::string& source_name, FileShelf& shelf)
      : PatchTables(root, source_name, shelf) {}
  Result<PatchSpec> read();

 private:
  void read_top();
  void read_tuning(TableReader& top);
  void require_amp();
  void read_oscillators();
  void read_oscillator(const Node::Member& member);
  void read_noise();
  void read_crossfade();
  void read_shaper();
  void read_filter();
  void check_envelope_name(TableReader& reader, const std::string& name);
};

}  // namespace knotwave::engine
