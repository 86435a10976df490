// SPDX-License-Identifier: MIT
// Aliases through the whole program: knotwave-render plays notes tuned so that 65536 samples hold a
// whole odd number of cycles, and every line of the spectrum is read without a window.
// docs/alias-free.md
#include <cstdio>
#include <cstring>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/fft.h"
#include "knotwave/io/midi_file.h"

#include "support/program.h"
#include "support/spectrum.h"

namespace {

using namespace knotwave;
using Lines = std::vector<std::complex<double>>;

constexpr double kRateHz = 48000;
constexpr int kNotes[] = {33, 60, 84, 96, 108};
constexpr const char* kTuning = KNOTWAVE_SOURCE_DIR "/examples/tunings/coherent_48000";

constexpr const char* kCorners = R"(
[curves.wave]                # six cubics, corners between them
degree = 3
points = [0, 0.9, 0.2, 0.7, 1, -0.4, 0.1, 0.3, -0.9, -0.2, -0.5, 0.6, 0.4, -1, -0.3, -0.8, 0.5, -0.1, 0]
knots  = [0,0,0,0, 1,1,1, 2,2,2, 3,3,3, 4,4,4, 5,5,5, 6,6,6,6]
)";
constexpr const char* kSmooth = R"(
[curves.wave]                # sixteen points, C2
degree = 3
periodic = true
points = [0.5, 1, -0.2, -0.4, 0.1, -0.7, -0.8, 0, 0.3, 1, 0.6, 0.3, 0.1, -0.4, -0.9, -0.5]
)";

std::string patch_text(const std::string& curve, const char* wave) {
  return std::string(R"(
format = 1
kind   = "patch"
name   = "alias test"
velocity_db = 0
tuning = ")") +
         kTuning + ".scl\"\nkeymap = \"" + kTuning + ".kbm\"\n" + curve + R"(
[curves.on]
degree = 1
points = [1, 1]
[oscillators.a]
wave = ")" +
         wave + R"("
[envelopes.amp]
curve = "on"
seconds = 0.01
sustain_at = 0.01
)";
}

std::vector<std::uint8_t> held_note(int key) {
  io::Song song;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = 480;
  const auto byte = static_cast<std::uint8_t>(key);
  song.events = {{0, 0, {0x90, byte, 127}, 0, 0}, {1920, 0, {0x80, byte, 64}, 0, 0}};
  song.length_ticks = 1920;  // 2 s at 120 bpm
  return io::write_midi(song);
}

/// One period's worth of steady sound, left channel, scaled so that the waveform's peak is 1.
std::vector<float> steady(const std::string& patch, int key) {
  const support::ScratchFolder scratch;
  const auto song = held_note(key);
  EXPECT_TRUE(base::write_file(scratch.file("p.toml"), patch));
  EXPECT_TRUE(base::write_file(scratch.file("n.mid"),
                               {reinterpret_cast<const char*>(song.data()), song.size()}));
  const auto run = support::run_program(
      {"knotwave-render", scratch.file("p.toml"), scratch.file("n.mid"), "-o", "-", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::vector<float> stereo(run.out.size() / 4);
  std::memcpy(stereo.data(), run.out.data(), stereo.size() * 4);
  std::vector<float> left(support::kCoherentSize);
  constexpr std::size_t kFirst = 9600;
  if (stereo.size() < 2 * (kFirst + left.size())) return {};
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = stereo[2 * (kFirst + i)];
  return left;
}

/// c[n] of the drawn cycle by an oracle of its own: 2^20 exact values and one transform.
Lines exact_lines(const std::string& text) {
  const auto set = curves::parse_curves("format = 1\nkind = \"curve\"\n" + text, "test");
  EXPECT_TRUE(set);
  const auto& curve = set->curves.front();
  constexpr int kSize = 1 << 20;
  std::vector<double> cycle(kSize);
  for (int i = 0; i < kSize; ++i) {
    curve.evaluate(curve.u_min() + (curve.u_max() - curve.u_min()) * i / kSize,
                   std::span(&cycle[static_cast<std::size_t>(i)], 1));
  }
  return dsp::harmonics_of_cycle(cycle, 2048);
}

/// A saw from -1 to 1: c[n] = i / (2 pi n) * 2 in magnitude 1 / (pi n).
Lines saw_lines() {
  Lines lines(2049);
  for (int n = 1; n <= 2048; ++n) {
    lines[static_cast<std::size_t>(n)] = {0, 1 / (std::numbers::pi * n)};
  }
  return lines;
}

/// The gain of the path, from the fundamental; then everything else has to fit.
void check(const char* name, const std::string& curve, const char* wave, const Lines& exact) {
  for (const int key : kNotes) {
    auto samples = steady(patch_text(curve, wave), key);
    ASSERT_FALSE(samples.empty());
    const double f0 = 440 * std::exp2((key - 69) / 12.0);
    const int bin = support::coherent_bin(f0, kRateHz);
    const double gain = std::abs(support::line_spectrum(samples)[static_cast<std::size_t>(bin)]) /
                        (2 * std::abs(exact[1]));
    for (float& x : samples) x = static_cast<float>(x / gain);
    const auto report = support::measure_coherent(samples, bin, kRateHz, exact);
    std::printf(
        "%-8s MIDI %3d %8.2f Hz  worst line %7.1f dBFS at %6.0f Hz, below 18 kHz %7.1f;"
        "  passband %.5f dB over %d harmonics\n",
        name, key, bin * kRateHz / support::kCoherentSize, report.worst_db, report.worst_hz,
        report.worst_18k_db, report.passband_db, report.passband_harmonics);
    EXPECT_LT(report.worst_db, -110) << name << " at " << key;
    EXPECT_LT(report.passband_db, 0.01) << name << " at " << key;
    EXPECT_GE(report.passband_harmonics, 1);
  }
}

TEST(AliasThroughRender, SawIsCleanTo110Decibels) { check("saw", "", "saw", saw_lines()); }

TEST(AliasThroughRender, CornersOfSixCubicsAreCleanTo110Decibels) {
  check("corners", kCorners, "wave", exact_lines(kCorners));
}

TEST(AliasThroughRender, SixteenSmoothPointsAreCleanTo110Decibels) {
  check("smooth", kSmooth, "wave", exact_lines(kSmooth));
}

}  // namespace
