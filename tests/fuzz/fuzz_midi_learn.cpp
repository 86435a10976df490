// SPDX-License-Identifier: MIT
// Any bytes as a MIDI learn file: an error at a place, or knobs that are written and read again to
// the same.
#include <cstddef>
#include <cstdint>

#include "knotwave/engine/midi_learn.h"

#include "fuzz_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace knotwave;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto spec = engine::parse_midi_learn(text, "fuzz");
  if (!spec) {
    fuzz::check_error(spec.error());
    return 0;
  }
  FUZZ_CHECK(engine::MidiLearn::create(*spec).has_value());
  const std::string written = engine::write_midi_learn(*spec);
  const auto again = engine::parse_midi_learn(written, "again");
  FUZZ_CHECK(again.has_value());
  FUZZ_CHECK(*again == *spec);
  FUZZ_CHECK(engine::write_midi_learn(*again) == written);
  return 0;
}
