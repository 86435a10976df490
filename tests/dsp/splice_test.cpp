// SPDX-License-Identifier: MIT
// How clean joins sound: a 220 Hz sine under an envelope that is retriggered, measured 5 to 20 kHz
// under a Blackman window of 85 ms round the splice. The sine itself leaves less than -180 dB
// there.
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"

#include "envelopes.h"
#include "support/seed.h"
#include "support/spectrum.h"

namespace {

using namespace knotwave::test;
using knotwave::base::SampleTime;
using knotwave::curves::NurbsCurve;

constexpr std::size_t kWindow = 4096;

// 10 log10 of the summed squares of the lines from 5 to 20 kHz; a sine of amplitude 1 would be 0.
double splatter_db(const std::vector<double>& samples) {
  std::vector<double> windowed(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kWindow;
    windowed[i] = samples[i] * (0.42 - 0.5 * std::cos(angle) + 0.08 * std::cos(2 * angle)) / 0.42;
  }
  const auto lines = knotwave::support::line_spectrum(windowed);
  double power = 0;
  for (std::size_t k = 5000 * kWindow / 48000; k <= 20000 * kWindow / 48000; ++k) {
    power += std::norm(lines[k]);
  }
  return 10 * std::log10(power + 1e-40);
}

struct Gate {
  SampleTime time;
  bool on = true;
};

// The tone under the envelope through all gates, kWindow samples with the last gate in the middle.
double splice_db(const EnvelopeProgram& program, const std::vector<Gate>& gates, double phase,
                 int* limited = nullptr) {
  const std::int64_t first = gates.back().time.sample - static_cast<std::int64_t>(kWindow / 2);
  const std::int64_t end = first + static_cast<std::int64_t>(kWindow);
  std::int64_t here = std::min(first, gates.front().time.sample);
  std::vector<double> y(static_cast<std::size_t>(end - here));
  auto rest = std::span(y);
  Envelope envelope;
  for (const Gate& gate : gates) {
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
  std::vector<double> tone(y.end() - kWindow, y.end());
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double seconds = static_cast<double>(i) / kRate;
    tone[i] *= std::sin(2 * std::numbers::pi * (220 * seconds + phase));
  }
  return splatter_db(tone);
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

// Random gates that end in a retrigger, from 1 ms to 0.5 s apart.
std::vector<Gate> random_gates(std::mt19937_64& random, int count) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Gate> gates;
  std::int64_t sample = 10000;
  for (int i = 0; i < count; ++i) {
    const bool on = i == 0 || i == count - 1 || unit(random) < 0.5;
    gates.push_back({{sample, static_cast<std::uint32_t>(random())}, on});
    sample += static_cast<std::int64_t>(kRate * (0.001 + 0.5 * unit(random) * unit(random)));
  }
  return gates;
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

struct Worst {
  double rest_db = -400, retrigger_db = -400;
  int limited = 0;
};

template <class Gates>
Worst worst_of(const EnvelopeProgram& program, int count, const Gates& gates_of) {
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<double> unit(0, 1);
  Worst worst;
  for (int i = 0; i < 16; ++i) {
    const Gate gate{{10000, static_cast<std::uint32_t>(random())}, true};
    worst.rest_db = std::max(worst.rest_db, splice_db(program, {gate}, i / 16.0));
  }
  for (int i = 0; i < count; ++i) {
    const std::vector<Gate> gates = gates_of(random, i);
    const double db = splice_db(program, gates, unit(random), &worst.limited);
    worst.retrigger_db = std::max(worst.retrigger_db, db);
  }
  return worst;
}

Worst worst_of(const EnvelopeProgram& program, int count) {
  return worst_of(program, count,
                  [](auto& random, int i) { return random_gates(random, 2 + i % 3); });
}

void report(double attack_s, const Worst& worst) {
  std::printf("attack %3.0f ms: from rest %.1f dBFS, retriggered %.1f dBFS, %d joins limited\n",
              1000 * attack_s, worst.rest_db, worst.retrigger_db, worst.limited);
}

TEST(Splice, AThousandRetriggersStayBelowMinus110DbFromTenMillisecondsOn) {
  for (const double attack_s : {0.01, 0.02, 0.05, 0.2}) {
    const Worst worst = worst_of(adsr(attack_s, 0.1, 0.3), knotwave::support::test_count(250));
    report(attack_s, worst);
    EXPECT_LT(worst.retrigger_db, -110) << attack_s;
    EXPECT_GT(worst.limited, 0);
  }
}

TEST(Splice, ShorterAttacksAreNoWorseThanFromRest) {
  for (const double attack_s : {0.001, 0.002, 0.005}) {
    const Worst worst = worst_of(adsr(attack_s, 0.1, 0.3), knotwave::support::test_count(100));
    report(attack_s, worst);
    EXPECT_LT(worst.retrigger_db, worst.rest_db + 1) << attack_s;
  }
}

TEST(Splice, StraightLinesAreNoWorseThanFromRest) {
  for (const double attack_s : {0.002, 0.01, 0.05}) {
    const double decay = attack_s + 0.1, end = decay + 0.3;
    const NurbsCurve curve = curve_of({0, 1, 0.6, 0}, 1, {}, {0, 0, attack_s, decay, end, end});
    const Worst worst =
        worst_of(program_of_sections(curve, attack_s, 0.1, 0.3), knotwave::support::test_count(60));
    report(attack_s, worst);
    EXPECT_LT(worst.retrigger_db, worst.rest_db + 1) << attack_s;
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

// A thousand retriggers.
TEST(Splice, ShortAttacksOfAnyShapeAreNoWorseThanFromRest) {
  std::mt19937_64 random(knotwave::support::test_seed() + 7);
  double most = -400;
  for (const double attack_s : {0.001, 0.002, 0.005}) {
    for (int i = 0; i < 14 * knotwave::support::test_count(4); ++i) {
      const int degree = 1 + i % 7;
      const EnvelopeProgram program = random_attack(random, degree, i / 7 % 2 == 0, attack_s);
      const Worst worst =
          worst_of(program, 6, [&](auto&, int) { return attack_and_retrigger(random); });
      const double floor_db = std::max(worst.rest_db, -111.0);
      most = std::max(most, worst.retrigger_db - floor_db);
      EXPECT_LT(worst.retrigger_db, floor_db + 1) << "degree " << degree << ", " << attack_s;
    }
  }
  std::printf("retriggered at most %.1f dB above rest\n", most);
}

}  // namespace
