// SPDX-License-Identifier: MIT
// How clean joins sound: a 220 Hz sine under an envelope that is retriggered, measured 5 to 20 kHz
// under a Blackman window of 85 ms round the splice, at 16 phases of the sine.
//
// A window holds more than the retrigger: the note before may have begun 2 ms ago, and two attacks
// leave up to 3 dB more than one, joined or not. So a retrigger is held against what the same
// window holds without it (the gates before, nothing after) and, added by power, the very same
// attack from rest: begun at the same fraction of a sample and the same phase of the sine. Excess
// is what it leaves above that.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"
#include "knotwave/dsp/fft.h"

#include "envelopes.h"
#include "support/seed.h"

namespace {

using namespace knotwave::test;
using knotwave::base::SampleTime;
using knotwave::curves::NurbsCurve;

constexpr std::size_t kWindow = 4096;
constexpr int kPhases = 16;
constexpr int kSeeds = 5;
// More than a held sine leaves under the window: -153 dBFS.
constexpr double kNoise = 1e-15;

// Energy by phase of the sine: summed squares of the lines from 5 to 20 kHz. A sine of amplitude 1
// there would be 1.
using Energy = std::array<double, kPhases>;

double decibels_of(double power) { return 10 * std::log10(power + 1e-40); }

// The window times e^{2 pi i 220 t}: its imaginary and real part carry the sine at phases 0 and 90
// degrees, any other is a sum of these two.
const std::vector<std::complex<double>>& carrier() {
  static const auto made = [] {
    std::vector<std::complex<double>> wave(kWindow);
    for (std::size_t i = 0; i < kWindow; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kWindow;
      const double window = (0.42 - 0.5 * std::cos(angle) + 0.08 * std::cos(2 * angle)) / 0.42;
      const double cycles = 220 * static_cast<double>(i) / kRate;
      wave[i] = std::polar(2 * window / kWindow, 2 * std::numbers::pi * cycles);
    }
    return wave;
  }();
  return made;
}

Energy energy_of(std::span<const double> envelope) {
  static knotwave::dsp::Fft fft(kWindow);
  std::vector<std::complex<double>> lines(carrier());
  for (std::size_t i = 0; i < kWindow; ++i) lines[i] *= envelope[i];
  fft.forward(lines);
  double sines = 0, cosines = 0, both = 0;
  for (std::size_t k = 5000 * kWindow / 48000; k <= 20000 * kWindow / 48000; ++k) {
    const std::complex<double> mirror = std::conj(lines[kWindow - k]);
    const std::complex<double> cosine = 0.5 * (lines[k] + mirror);
    const std::complex<double> sine = std::complex<double>(0, -0.5) * (lines[k] - mirror);
    sines += std::norm(sine);
    cosines += std::norm(cosine);
    both += 2 * (sine * std::conj(cosine)).real();
  }
  Energy energy;
  for (int i = 0; i < kPhases; ++i) {  // half a turn more changes only the sign
    const double angle = std::numbers::pi * i / kPhases, s = std::sin(angle), c = std::cos(angle);
    energy[static_cast<std::size_t>(i)] = c * c * sines + s * s * cosines + s * c * both;
  }
  return energy;
}

double worst_of(const Energy& energy) { return *std::max_element(energy.begin(), energy.end()); }

struct Gate {
  SampleTime time;
  bool on = true;
};

// The tone under the envelope through the first `count` gates, the last of all in the middle.
Energy energy_of(const EnvelopeProgram& program, std::span<const Gate> gates, std::size_t count,
                 int* limited = nullptr) {
  const std::int64_t first = gates.back().time.sample - static_cast<std::int64_t>(kWindow / 2);
  const std::int64_t end = first + static_cast<std::int64_t>(kWindow);
  std::int64_t here = std::min(first, gates.front().time.sample);
  std::vector<double> y(static_cast<std::size_t>(end - here));
  auto rest = std::span(y);
  Envelope envelope;
  for (const Gate& gate : gates.first(count)) {
    const auto before = static_cast<std::size_t>(first_sample(gate.time) - here);
    envelope.render(program, here, {}, rest.first(before));
    rest = rest.subspan(before);
    here += static_cast<std::int64_t>(before);
    if (gate.on) {
      envelope.gate_on(program, gate.time, kRate, 1);
    } else {
      envelope.gate_off(program, gate.time);
    }
  }
  envelope.render(program, here, {}, rest);
  if (limited != nullptr) *limited += envelope.limited_joins();
  return energy_of(std::span(y).last(kWindow));
}

// Held at the end of its second section.
EnvelopeProgram program_of_sections(const NurbsCurve& curve, double attack_s, double decay_s,
                                    double release_s) {
  EnvelopeSpec spec;
  spec.seconds = attack_s + decay_s + release_s;
  spec.sustain_u = attack_s + decay_s;
  return program_of(curve, spec);
}

// Three sections of one span each: attack, decay, release.
std::vector<double> section_knots(int degree, double attack_s, double decay_s, double release_s) {
  const double d = attack_s + decay_s, r = d + release_s;
  std::vector<double> knots(1, 0.0);
  for (const double knot : {0.0, attack_s, d, r}) {
    knots.insert(knots.end(), static_cast<std::size_t>(degree), knot);
  }
  knots.push_back(r);
  return knots;
}

// Attack (an S), decay, sustain at 0.6, release; smooth where spans meet but for the end of the
// attack.
EnvelopeProgram adsr(double attack_s, double decay_s, double release_s) {
  const NurbsCurve curve = curve_of({0, 0, 1, 1, 1, 0.6, 0.6, 0.6, 0, 0}, 3, {},
                                    section_knots(3, attack_s, decay_s, release_s));
  return program_of_sections(curve, attack_s, decay_s, release_s);
}

// 2 to 4 random gates that end in a retrigger, at least `least_s` and up to `most_s` apart.
std::vector<Gate> random_gates(std::mt19937_64& random, double least_s, double most_s) {
  std::uniform_real_distribution<double> unit(0, 1);
  const int count = 2 + static_cast<int>(3 * unit(random));
  std::vector<Gate> gates;
  std::int64_t sample = 10000;
  for (int i = 0; i < count; ++i) {
    const bool on = i == 0 || i == count - 1 || unit(random) < 0.5;
    gates.push_back({{sample, static_cast<std::uint32_t>(random())}, on});
    const double apart_s = least_s + (most_s - least_s) * unit(random) * unit(random);
    sample += 1 + static_cast<std::int64_t>(kRate * apart_s);
  }
  return gates;
}

struct Worst {
  double rest_db = -400, retrigger_db = -400, excess_db = -400;
  int limited = 0;
};

// One retrigger more: the last of the gates. What lies below `floor` is no excess.
void measure(const EnvelopeProgram& program, std::span<const Gate> gates, Worst& worst,
             double floor = kNoise) {
  const Energy joined = energy_of(program, gates, gates.size(), &worst.limited);
  const Energy without = energy_of(program, gates, gates.size() - 1);
  const Energy rest = energy_of(program, gates.last(1), 1);
  worst.rest_db = std::max(worst.rest_db, decibels_of(worst_of(rest)));
  worst.retrigger_db = std::max(worst.retrigger_db, decibels_of(worst_of(joined)));
  for (std::size_t i = 0; i < kPhases; ++i) {
    const double allowed = std::max(without[i] + rest[i] + kNoise, floor);
    worst.excess_db = std::max(worst.excess_db, decibels_of(joined[i] / allowed));
  }
}

// `count` retriggers of each of five seeds.
template <class Gates>
Worst worst_of(const EnvelopeProgram& program, int count, const Gates& gates_of) {
  Worst worst;
  const std::uint64_t first_seed = knotwave::support::test_seed();
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937_64 random(first_seed + seed);
    for (int i = 0; i < count; ++i) measure(program, gates_of(random), worst);
  }
  return worst;
}

// A millisecond to half a second apart.
std::vector<Gate> gates_of_playing(std::mt19937_64& random) {
  return random_gates(random, 0.001, 0.5);
}

void report(double attack_s, const Worst& worst) {
  std::printf(
      "attack %3.0f ms: from rest %.1f dBFS, retriggered %.1f dBFS, excess %.2f dB, %d joins "
      "limited\n",
      1000 * attack_s, worst.rest_db, worst.retrigger_db, worst.excess_db, worst.limited);
}

TEST(Splice, AHeldToneLeavesNothingThatCounts) {
  const std::vector<double> held(kWindow, 1.0);
  EXPECT_LT(worst_of(energy_of(held)), kNoise);
}

TEST(Splice, AThousandRetriggersStayBelowMinus110DbFromTenMillisecondsOn) {
  for (const double attack_s : {0.01, 0.02, 0.05, 0.2}) {
    const Worst worst =
        worst_of(adsr(attack_s, 0.1, 0.3), knotwave::support::test_count(200), gates_of_playing);
    report(attack_s, worst);
    EXPECT_LT(worst.retrigger_db, -110) << attack_s;
    EXPECT_GT(worst.limited, 0);
  }
}

TEST(Splice, AThousandRetriggersOfShorterAttacksAreNoWorseThanFromRest) {
  for (const double attack_s : {0.001, 0.002, 0.005}) {
    const Worst worst =
        worst_of(adsr(attack_s, 0.1, 0.3), knotwave::support::test_count(200), gates_of_playing);
    report(attack_s, worst);
    EXPECT_LT(worst.excess_db, 1) << attack_s;
  }
}

// All gates within the attack or soon after, where a join has the least room, and as near to each
// other as two notes on a MIDI wire. (Nearer still, two attacks are one sound to a band that begins
// at 5 kHz: they add by amplitude, not by power.)
TEST(Splice, RetriggersWithinAnAttackAreNoWorseThanFromRest) {
  constexpr double kNearest = 0.00064;
  for (const double attack_s : {0.001, 0.002, 0.005, 0.01}) {
    const auto gates = [&](auto& random) { return random_gates(random, kNearest, 2 * attack_s); };
    const Worst worst =
        worst_of(adsr(attack_s, 0.1, 0.3), knotwave::support::test_count(200), gates);
    report(attack_s, worst);
    EXPECT_LT(worst.excess_db, 1) << attack_s;
    EXPECT_GT(worst.limited, 0);
  }
}

// An attack of one span with random points: anywhere between 0 and 1, or (stepped) first some at 0
// and then all at 1, which is the softest S of its degree or a sharp corner at one end. Then decay
// and release as soft as the degree allows.
EnvelopeProgram random_attack(std::mt19937_64& random, int degree, bool stepped, double attack_s) {
  std::uniform_real_distribution<double> unit(0, 1);
  const int zeros = static_cast<int>(unit(random) * degree);
  std::vector<double> points(1, 0.0);
  for (int i = 1; i < degree; ++i) points.push_back(stepped ? (i > zeros) : unit(random));
  points.push_back(1);
  for (const auto& [from, to] : {std::pair(1.0, 0.6), std::pair(0.6, 0.0)}) {
    for (int i = 1; i <= degree; ++i) points.push_back(2 * i <= degree ? from : to);
  }
  const NurbsCurve curve =
      curve_of(std::move(points), degree, {}, section_knots(degree, attack_s, 0.1, 0.3));
  return program_of_sections(curve, attack_s, 0.1, 0.3);
}

// One attack, out of the window by the time of the retrigger, and most often a release between.
// (Two attacks in one window are up to 3 dB more than one, joined or not.)
std::vector<Gate> attack_and_retrigger(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto fraction = [&] { return static_cast<std::uint32_t>(random()); };
  std::vector<Gate> gates = {{{10000, fraction()}, true}};
  std::int64_t sample = 10000 + static_cast<std::int64_t>(kRate * (0.05 + 0.3 * unit(random)));
  if (unit(random) < 0.7) {
    gates.push_back({{sample, fraction()}, false});
    sample += static_cast<std::int64_t>(kRate * (0.001 + 0.25 * unit(random) * unit(random)));
  }
  gates.push_back({{sample, fraction()}, true});
  return gates;
}

// The corners of a line are heard (from rest, too), its joins are not.
TEST(Splice, StraightLinesAreNoWorseThanFromRest) {
  for (const double attack_s : {0.002, 0.01, 0.05}) {
    const double decay = attack_s + 0.1, end = decay + 0.3;
    const NurbsCurve curve = curve_of({0, 1, 0.6, 0}, 1, {}, {0, 0, attack_s, decay, end, end});
    const Worst worst = worst_of(program_of_sections(curve, attack_s, 0.1, 0.3),
                                 knotwave::support::test_count(40), attack_and_retrigger);
    report(attack_s, worst);
    EXPECT_LT(worst.excess_db, 1) << attack_s;
  }
}

// A thousand and more retriggers. Degree 4 and up can be drawn softer than what a join keeps (value
// and slope, not curvature): there -110 dBFS is enough, as it is for attacks of 10 ms and more.
TEST(Splice, AttacksOfAnyShapeAreNoWorseThanFromRest) {
  const std::uint64_t seed = 1000 * knotwave::support::test_seed();
  for (const double attack_s : {0.001, 0.002, 0.005, 0.01, 0.05}) {
    for (const int degree : {1, 2, 3, 4, 5, 6, 7, 10, 15}) {
      std::mt19937_64 random(seed + static_cast<unsigned>(degree));
      const double floor = degree > 3 || attack_s > 0.009 ? 1e-11 : kNoise;
      Worst worst;
      for (int i = 0; i < knotwave::support::test_count(10); ++i) {
        const EnvelopeProgram program = random_attack(random, degree, i % 2 == 0, attack_s);
        for (int k = 0; k < 5; ++k) measure(program, attack_and_retrigger(random), worst, floor);
      }
      std::printf("degree %d, ", degree);
      report(attack_s, worst);
      EXPECT_LT(worst.excess_db, 1) << "degree " << degree << ", " << attack_s;
    }
  }
}

}  // namespace
