// SPDX-License-Identifier: MIT
// Sounds of the gallery: tones whose pitch and level are curves.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace gallery {

inline constexpr int kRateHz = 48000;
inline constexpr std::size_t kSecond = kRateHz;  ///< in frames

/// The gain at frame i of n: 10 ms to rise at the start and to fall at the end.
double fade(std::size_t i, std::size_t n);

/// Left and right of a sound.
struct Stereo {
  std::vector<float> left, right;
  explicit Stereo(std::size_t frames) : left(frames), right(frames) {}

  /// Adds a soft tone: notes [n] are MIDI note numbers, levels [n] are 0..1; pan 0 is left, 1
  /// right.
  void add_tone(std::span<const double> notes, std::span<const double> levels, double pan);
  /// Fades both ends over 10 ms and writes a WAV.
  knotwave::Result<void> save(const std::string& path);
};

}  // namespace gallery
