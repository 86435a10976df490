// SPDX-License-Identifier: MIT
#include "sound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/base/elementary.h"
#include "knotwave/base/time.h"
#include "knotwave/io/sound_file.h"

namespace gallery {

using namespace knotwave;

void Stereo::add_tone(std::span<const double> notes, std::span<const double> levels, double pan) {
  constexpr std::array kPartials = {0.70, 0.20, 0.07, 0.03};  // of 1, 2, 3, 4 times the pitch
  const auto to_left = static_cast<float>(std::sqrt(1 - pan));
  const auto to_right = static_cast<float>(std::sqrt(pan));
  base::Phase phase;
  for (std::size_t i = 0; i < left.size(); ++i) {
    double value = 0;
    for (std::size_t k = 0; k < kPartials.size(); ++k) {
      value += kPartials[k] * base::sin_cos_cycles(phase.cycles() * double(k + 1)).sin;
    }
    phase = phase + base::phase_increment(base::note_to_hz(notes[i]), kRateHz);
    const auto sample = static_cast<float>(value * levels[i]);
    left[i] += sample * to_left;
    right[i] += sample * to_right;
  }
}

double fade(std::size_t i, std::size_t n) {
  constexpr std::size_t kFrames = kRateHz / 100;
  return static_cast<double>(std::min({i, n - 1 - i, kFrames})) / kFrames;
}

Result<void> Stereo::save(const std::string& path) {
  const std::size_t frames = left.size();
  std::vector<float> both(2 * frames);
  for (std::size_t i = 0; i < frames; ++i) {
    const auto gain = static_cast<float>(fade(i, frames));
    both[2 * i] = left[i] * gain;
    both[2 * i + 1] = right[i] * gain;
  }
  auto writer = io::SoundWriter::create({.path = path, .rate_hz = kRateHz});
  if (!writer) return writer.error();
  if (auto ok = writer->write(both); !ok) return ok;
  return writer->finish();
}

}  // namespace gallery
