// SPDX-License-Identifier: MIT
// You learn: how the same kind of file becomes a waveform, free of aliases at any pitch.
// Run:       build/release/bin/03_hear_it_as_a_wave examples/curves/waves.toml out/wave.wav
// It plays:  a glide of four seconds from 55 Hz up six octaves, and not one wrong tone on the way.
// Next:      04_write_a_patch.cpp
#include <cstdio>
#include <vector>

#include "knotwave/base/elementary.h"
#include "knotwave/base/time.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/oscillator.h"
#include "knotwave/io/sound_file.h"

using namespace knotwave;

namespace {

constexpr int kRateHz = 48000;
constexpr int kFrames = 4 * kRateHz;

int complain(const Error& error) {
  std::fprintf(stderr, "%s\n", error.to_string().c_str());
  return 1;
}

/// The phase step of each sample: 55 Hz to 3520 Hz, even in pitch.
std::vector<base::Phase> glide() {
  std::vector<base::Phase> steps(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double octaves = 6.0 * static_cast<double>(i) / kFrames;
    steps[i] = base::phase_increment(55.0 * base::exp2(octaves), kRateHz);
  }
  return steps;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CURVES.toml OUT.wav\n", argv[0]);
    return 2;
  }
  const auto set = curves::read_curves(argv[1]);
  if (!set) return complain(set.error());
  if (set->curves.empty()) return complain(fail(ErrorCode::missing_key, "the file holds no curve"));

  // Exact Fourier coefficients, cut for every third of an octave, kept as B-splines.
  const auto tables = dsp::WaveTables::create(set->curves.front());
  if (!tables) return complain(tables.error());
  std::printf("%d levels, the richest has %d harmonics, %zu bytes\n", tables->level_count(),
              tables->level_harmonics(tables->level_count() - 1), tables->memory_bytes());

  dsp::TableOscillator oscillator;
  oscillator.start(base::Phase{}, 0);
  const std::vector<base::Phase> steps = glide();
  std::vector<float> left(kFrames), right(kFrames), stereo(2 * std::size_t{kFrames});
  oscillator.render(*tables, steps, {}, {}, left, right);
  for (std::size_t i = 0; i < kFrames; ++i) {
    stereo[2 * i] = 0.25f * left[i];
    stereo[2 * i + 1] = 0.25f * right[i];
  }

  auto writer = io::SoundWriter::create({.path = argv[2], .rate_hz = kRateHz});
  if (!writer) return complain(writer.error());
  if (auto ok = writer->write(stereo); !ok) return complain(ok.error());
  if (auto ok = writer->finish(); !ok) return complain(ok.error());
  std::printf("%s: 55 Hz to 3520 Hz in 4 s\n", argv[2]);
  return 0;
}
