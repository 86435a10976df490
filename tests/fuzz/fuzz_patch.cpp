// SPDX-License-Identifier: MIT
// Any bytes as a patch: either an error with a place and a message, or a patch that keeps the
// limits and whose names all lead somewhere. The folder of the patch does not exist, so no file is
// read.
#include <cstddef>
#include <cstdint>

#include "knotwave/dsp/builtin_waves.h"
#include "knotwave/engine/patch.h"

#include "fuzz_check.h"

namespace {

using namespace knotwave;

bool is_curve(const engine::PatchSpec& patch, const std::string& name) {
  return patch.curves.find_curve(name) != nullptr;
}

void check_maps(const engine::PatchSpec& patch) {
  for (const auto& map : patch.maps) {
    FUZZ_CHECK(map.curve.empty() || is_curve(patch, map.curve));
    FUZZ_CHECK(map.surface.empty() || patch.curves.find_surface(map.surface) != nullptr);
    const bool to_free = map.target == engine::MapTarget::free_number;
    FUZZ_CHECK(map.target_index <= (to_free ? static_cast<int>(patch.free_numbers.size()) - 1
                                            : engine::kMaxOscillators));
    if (map.source == engine::MapSource::free_number) {
      FUZZ_CHECK(map.source_index < static_cast<int>(patch.free_numbers.size()));
    }
    if (map.source == engine::MapSource::envelope) {
      FUZZ_CHECK(map.source_index < static_cast<int>(patch.envelopes.size()));
    }
    if (map.source == engine::MapSource::lfo) {
      FUZZ_CHECK(map.source_index < static_cast<int>(patch.lfos.size()));
    }
    if (map.target == engine::MapTarget::curve_knot) {
      const auto* curve = patch.curves.find_curve(map.target_curve);
      FUZZ_CHECK(curve != nullptr &&
                 map.target_point < static_cast<int>(curve->spec().knots.size()));
      FUZZ_CHECK(map.low < map.high);
    }
    if (map.target == engine::MapTarget::curve_weight ||
        map.target == engine::MapTarget::curve_point) {
      const auto* curve = patch.curves.find_curve(map.target_curve);
      FUZZ_CHECK(curve != nullptr && map.target_point < curve->point_count());
      FUZZ_CHECK(map.low < map.high);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto patch = engine::parse_patch(text, "/no-such-folder/fuzz.toml");
  if (!patch) {
    fuzz::check_error(patch.error());
    return 0;
  }
  FUZZ_CHECK(patch->oscillators.size() <= engine::kMaxOscillators);
  FUZZ_CHECK(!patch->envelopes.empty() && patch->envelopes.size() <= engine::kMaxEnvelopes);
  FUZZ_CHECK(patch->lfos.size() <= engine::kMaxLfos);
  FUZZ_CHECK(patch->maps.size() <= engine::kMaxMaps);
  FUZZ_CHECK(patch->free_numbers.size() <= engine::kMaxFreeNumbers);
  for (const auto& oscillator : patch->oscillators) {
    FUZZ_CHECK(!oscillator.wave_file.empty() || is_curve(*patch, oscillator.wave) ||
               patch->curves.find_surface(oscillator.wave) != nullptr);
  }
  for (const auto& envelope : patch->envelopes) {
    const auto* curve = patch->curves.find_curve(envelope.curve);
    FUZZ_CHECK(curve != nullptr && curve->dim() <= 2);
    FUZZ_CHECK(envelope.spec.loop_start_u <= envelope.spec.loop_end_u);
  }
  for (const auto& lfo : patch->lfos) FUZZ_CHECK(is_curve(*patch, lfo.curve));
  check_maps(*patch);
  return 0;
}
