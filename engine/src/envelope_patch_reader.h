// SPDX-License-Identifier: MIT
// Reads a patch of the envelope generator. Private to the patch files. [control]
#pragma once
#include <string>

#include "knotwave/engine/envelope_patch.h"

#include "patch_tables.h"

namespace knotwave::engine {

class EnvelopePatchReader : private PatchTables {
 public:
  EnvelopePatchReader(const base::Node& root, const std::string& source_name, FileShelf& shelf)
      : PatchTables(root, source_name, shelf) {
    patch_.has_sound = false;
    patch_.mode = PlayMode::mono;
    patch_.polyphony = kUsualEnvelopeVoices;
  }
  Result<EnvelopePatchSpec> read();

 private:
  // envelope_patch_reader.cpp
  void refuse_sound();
  void read_top();
  void read_notes(TableReader& top);
  void read_trigger();
  void read_trigger_source(TableReader& reader);
  void read_trigger_channel(TableReader& reader);
  void read_keys(TableReader& reader);
  void read_ports();
  void require_work();
  // Where `key` stands although what the table is about has none.
  void refuse(TableReader& reader, std::initializer_list<const char*> keys, bool belongs,
              const char* to_what);
  std::string port_name(TableReader& reader, const char* key);

  // envelope_patch_outputs.cpp
  void read_outputs();
  void read_output(const Node& table, int number);
  void read_source(TableReader& reader, OutputSpec& output);
  void read_destination(TableReader& reader, OutputSpec& output);
  void read_output_channel(TableReader& reader, OutputSpec& output);
  void read_law(TableReader& reader, OutputSpec& output);
  void read_address(TableReader& reader, OutputSpec& output);
  void read_events();
  void read_event(const Node& table, int number);
  void read_place(TableReader& reader, PlaceEventSpec& event);

  EnvelopePatchSpec spec_;
};

}  // namespace knotwave::engine
