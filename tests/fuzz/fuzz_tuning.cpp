// SPDX-License-Identifier: MIT
// Any bytes as a scale and, after a NUL, a keyboard mapping: an error with a message, or a tuning
// whose every note has a finite pitch.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "knotwave/engine/tuning.h"

#include "fuzz_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace knotwave;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const std::size_t nul = text.find('\0');
  const std::string_view scl = text.substr(0, nul);
  const std::string_view kbm = nul == std::string_view::npos ? text : text.substr(nul + 1);
  for (const auto& [scale, mapping] : {std::pair{scl, kbm}, {scl, std::string_view()}}) {
    const auto tuning = engine::Tuning::create(scale, "fuzz.scl", mapping, "fuzz.kbm");
    if (!tuning) {
      FUZZ_CHECK(!tuning.error().message.empty() && !tuning.error().source.empty());
      continue;
    }
    for (int note = -1; note <= 128; ++note) {
      FUZZ_CHECK(std::abs(tuning->midi_pitch(note)) < 2000);
      FUZZ_CHECK(std::isfinite(tuning->hz(note)) && tuning->hz(note) >= 0);
    }
  }
  return 0;
}
