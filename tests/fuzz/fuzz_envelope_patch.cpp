// SPDX-License-Identifier: MIT
// Any bytes as an envelope patch: either an error with a place and a message, or a patch that keeps
// the limits, whose names all lead somewhere, and which plays within its ranges whatever the bytes
// say as events. The folder of the patch does not exist, so no file is read.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "knotwave/engine/envelope_player.h"

#include "fuzz_check.h"

namespace {

using namespace knotwave;

template <class Items>
bool is_index(int index, const Items& items) {
  return index >= 0 && static_cast<std::size_t>(index) < items.size();
}

bool is_port(const engine::EnvelopePatchSpec& spec, const std::string& name) {
  return name.empty() || std::any_of(spec.ports.begin(), spec.ports.end(),
                                     [&](const auto& port) { return port.name == name; });
}

void check_spec(const engine::EnvelopePatchSpec& spec) {
  FUZZ_CHECK(!spec.patch.has_sound && spec.patch.oscillators.empty());
  FUZZ_CHECK(spec.patch.polyphony >= 1 && spec.patch.polyphony <= engine::kMaxEnvelopeVoices);
  FUZZ_CHECK(spec.outputs.size() <= engine::kMaxOutputs);
  FUZZ_CHECK(spec.place_events.size() <= engine::kMaxPlaceEvents);
  FUZZ_CHECK(spec.ports.size() <= engine::kMaxOutputPorts);
  FUZZ_CHECK(!spec.outputs.empty() || !spec.place_events.empty());
  FUZZ_CHECK(is_port(spec, spec.notes_port));
  for (const engine::OutputSpec& output : spec.outputs) {
    FUZZ_CHECK(is_port(spec, output.port));
    FUZZ_CHECK(output.of_low < output.of_high);
    FUZZ_CHECK(output.curve.empty() || spec.patch.curves.find_curve(output.curve) != nullptr);
    const int index = output.source_index;
    FUZZ_CHECK(output.source == engine::MapSource::envelope ? is_index(index, spec.patch.envelopes)
               : output.source == engine::MapSource::lfo
                   ? is_index(index, spec.patch.lfos)
                   : is_index(index, spec.patch.free_numbers));
  }
  for (const engine::PlaceEventSpec& event : spec.place_events) {
    FUZZ_CHECK(is_port(spec, event.port));
    FUZZ_CHECK(is_index(event.envelope, spec.patch.envelopes));
  }
}

// Three bytes at a time as messages, whatever they are.
void play(const engine::EnvelopePatchProgram& program, const std::uint8_t* bytes,
          std::size_t size) {
  auto made = engine::EnvelopePlayer::create({}, &program);
  FUZZ_CHECK(made.has_value());
  engine::EnvelopePlayer& player = **made;
  for (std::size_t i = 0; i + 3 <= std::min<std::size_t>(size, 240); i += 3) {
    engine::Event event;
    event.midi.time.sample = player.now();
    event.midi.bytes[0] = static_cast<std::uint8_t>(bytes[i] | 0x80);
    event.midi.bytes[1] = bytes[i + 1] & 127;
    event.midi.bytes[2] = bytes[i + 2] & 127;
    player.handle(event);
    player.render(bytes[i] & 63);
    player.predict(bytes[i + 1]);
    player.take_messages();
    for (int voice = 0; voice < player.voices(); ++voice) {
      for (std::size_t k = 0; k < program.outputs().size(); ++k) {
        const engine::OutputSpec& spec = program.outputs()[k].spec;
        for (const double value : player.values(voice, static_cast<int>(k))) {
          const auto [low, high] = std::minmax({spec.low, spec.high, spec.rest});
          FUZZ_CHECK(value >= low && value <= high);
        }
      }
    }
  }
  player.release_all();
  FUZZ_CHECK(player.newest_voice() < player.voices());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto spec = engine::parse_envelope_patch(text, "/no-such-folder/fuzz.toml");
  if (!spec) {
    fuzz::check_error(spec.error());
    return 0;
  }
  check_spec(*spec);
  const auto program = engine::EnvelopePatchProgram::create(*spec);
  if (!program) {
    fuzz::check_error(program.error());
    return 0;
  }
  play(**program, bytes, size);
  return 0;
}
