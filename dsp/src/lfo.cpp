// SPDX-License-Identifier: MIT
#include "knotwave/dsp/lfo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/dsp/elementary_block.h"

#include "moved_curve.h"

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = 64;
constexpr double kLongestDelay = 0x1p40;  // samples

// Both compilers we build with have it on every 64-bit target, and on WebAssembly.
__extension__ using Wide = unsigned __int128;

base::SampleTime later(base::SampleTime time, double samples) {
  const double wait = samples > 0 ? std::min(samples, kLongestDelay) : 0.0;
  const double whole = std::floor(wait);
  const std::uint64_t fraction =
      std::uint64_t{time.fraction} + static_cast<std::uint64_t>((wait - whole) * 0x1p32);
  return {
      time.sample + static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(fraction >> 32),
      static_cast<std::uint32_t>(fraction)};
}

}  // namespace

Lfo::Position Lfo::sum(Position a, Position b) KNOTWAVE_RT {
  const std::uint64_t phase = a.phase + b.phase;
  return {a.cycle + b.cycle + (phase < a.phase ? 1 : 0), phase};
}

Lfo::Position Lfo::difference(Position a, Position b) KNOTWAVE_RT {
  return {a.cycle - b.cycle - (a.phase < b.phase ? 1 : 0), a.phase - b.phase};
}

Lfo::Position Lfo::from_cycles(double cycles) KNOTWAVE_RT {
  if (!(std::abs(cycles) < 0x1p52)) return {};
  const auto whole = static_cast<std::int64_t>(std::floor(cycles));
  return {static_cast<std::uint64_t>(whole), base::phase_from_cycles(cycles).value};
}

void Lfo::start(const LfoSpec& spec, base::SampleTime time, double rate_hz,
                base::RandomStream stream) KNOTWAVE_RT {
  *this = {};
  sample_rate_hz_ = rate_hz;
  stream_ = stream;
  increment_ = base::phase_increment(spec.rate_hz, rate_hz).value;
  first_phase_ = base::phase_from_cycles(spec.phase_cycles).value;
  fade_start_ = later(time, spec.delay_s * rate_hz);
  if (spec.mode != LfoSpec::Mode::free) phase_start_ = fade_start_;
}

// The exact product, less the part of the first sample that had passed before the start.
Lfo::Position Lfo::at_sample(std::int64_t sample) const KNOTWAVE_RT {
  const Position begin{0, first_phase_};
  if (sample < base::first_sample(phase_start_)) return begin;
  const auto samples = static_cast<std::uint64_t>(sample - phase_start_.sample);
  const Wide run = Wide{increment_} * samples - (Wide{increment_} * phase_start_.fraction >> 32);
  return sum(begin, {static_cast<std::uint64_t>(run >> 64), static_cast<std::uint64_t>(run)});
}

Lfo::Position Lfo::at_beats(const LfoSpec& spec, std::int64_t sample, double beats) KNOTWAVE_RT {
  const Position begin{0, first_phase_};
  if (spec.mode == LfoSpec::Mode::free) return sum(begin, from_cycles(beats / spec.beats));
  if (sample < base::first_sample(phase_start_)) return begin;
  if (!has_origin_) {
    has_origin_ = true;
    origin_beats_ = beats;
  }
  return sum(begin, from_cycles((beats - origin_beats_) / spec.beats));
}

// Position at `sample`, where `plain` is that without a rate factor; afterwards the step to the
// next one adds what it is longer than a plain one.
Lfo::Position Lfo::in_time(const LfoSpec& spec, std::int64_t sample, double factor,
                           Position plain) KNOTWAVE_RT {
  const Position position = sum(plain, extra_);
  if (factor != 1 && sample >= base::first_sample(phase_start_)) {
    const base::Phase bent = base::phase_increment(spec.rate_hz * factor, sample_rate_hz_);
    extra_ = sum(extra_, difference({0, bent.value}, {0, increment_}));
  }
  return position;
}

// The same along the song: here the step is known once the sample is there.
Lfo::Position Lfo::in_song(const LfoSpec& spec, std::int64_t sample, double factor,
                           double beats) KNOTWAVE_RT {
  if (beats != beats) beats = last_beats_;
  if (factor != factor) factor = 0;
  if (factor != 1 && has_beats_ && sample > base::first_sample(phase_start_)) {
    extra_ = sum(extra_, from_cycles((factor - 1) * (beats - last_beats_) / spec.beats));
  }
  has_beats_ = true;
  last_beats_ = beats;
  return sum(at_beats(spec, sample, beats), extra_);
}

double Lfo::depth(const LfoSpec& spec, std::int64_t sample) const KNOTWAVE_RT {
  if (!(spec.fade_s > 0)) return 1;
  const double since = base::samples_since(fade_start_, sample);
  const double t = since > 0 ? std::min(since / (spec.fade_s * sample_rate_hz_), 1.0) : 0.0;
  return t * t * (3 - 2 * t);
}

void Lfo::draw_levels(std::uint64_t cycle) KNOTWAVE_RT {
  if (has_levels_ && levels_of_ == cycle) return;
  level_from_ = stream_.bipolar(cycle);
  level_to_ = stream_.bipolar(cycle + 1);
  levels_of_ = cycle;
  has_levels_ = true;
}

/// What the places of a chunk are worked out from, and where they go.
struct Lfo::Chunk {
  std::size_t n = 0;
  std::span<const double> rate_factor, tempo_beats;  ///< [n] or empty
  std::array<double, kChunk> u, from, step;          ///< from, step: levels of a random LFO
};

void Lfo::place_each(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
                     Chunk& chunk) KNOTWAVE_RT {
  const double u_min = cycle.u_min(), width = cycle.u_max() - cycle.u_min();
  const std::int64_t running = base::first_sample(phase_start_);
  const bool is_once = spec.mode == LfoSpec::Mode::one_shot;
  Position plain = at_sample(first);
  for (std::size_t i = 0; i < chunk.n; ++i) {
    const std::int64_t sample = first + static_cast<std::int64_t>(i);
    const double factor = chunk.rate_factor.empty() ? 1.0 : chunk.rate_factor[i];
    const Position position = chunk.tempo_beats.empty()
                                  ? in_time(spec, sample, factor, plain)
                                  : in_song(spec, sample, factor, chunk.tempo_beats[i]);
    plain = sample >= running ? sum(plain, {0, increment_}) : at_sample(sample + 1);
    const bool is_over = is_once && position.cycle != 0;
    chunk.u[i] = is_over ? cycle.u_max() : u_min + base::Phase{position.phase}.cycles() * width;
    if (spec.random) {
      draw_levels(is_over ? 0 : position.cycle);
      chunk.from[i] = level_from_;
      chunk.step[i] = level_to_ - level_from_;
    }
  }
}

/// Levels of a chunk that runs evenly from `position` on.
void Lfo::draw_each(Position position, Chunk& chunk) KNOTWAVE_RT {
  draw_levels(position.cycle);
  for (std::size_t i = 0; i < chunk.n; ++i) {
    chunk.from[i] = level_from_;
    chunk.step[i] = level_to_ - level_from_;
    const Position next = sum(position, {0, increment_});
    if (next.cycle != position.cycle && i + 1 < chunk.n) draw_levels(next.cycle);
    position = next;
  }
}

void Lfo::render(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
                 std::span<const double> rate_factor, std::span<const double> tempo_beats,
                 std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT {
  if (!(spec.beats > 0)) tempo_beats = {};
  const bool is_even =
      rate_factor.empty() && tempo_beats.empty() && spec.mode != LfoSpec::Mode::one_shot;
  Chunk chunk;
  for (std::size_t done = 0; done < out.size(); done += kChunk) {
    const auto part = out.subspan(done, std::min(kChunk, out.size() - done));
    const std::int64_t here = first + static_cast<std::int64_t>(done);
    chunk.n = part.size();
    const auto u = std::span(chunk.u).first(part.size());
    if (is_even && here >= base::first_sample(phase_start_)) {
      const Position position = sum(at_sample(here), extra_);
      phase_ramp({position.phase}, {increment_}, cycle.u_min(), cycle.u_max() - cycle.u_min(), u);
      if (spec.random) draw_each(position, chunk);
    } else {
      if (!rate_factor.empty()) chunk.rate_factor = rate_factor.subspan(done, part.size());
      if (!tempo_beats.empty()) chunk.tempo_beats = tempo_beats.subspan(done, part.size());
      place_each(spec, cycle, here, chunk);
    }
    render_moved(cycle, u, controls, done, part, cursor_);
    for (std::size_t i = 0; spec.random && i < part.size(); ++i) {
      part[i] = chunk.from[i] + chunk.step[i] * part[i];
    }
    for (std::size_t i = 0; spec.fade_s > 0 && i < part.size(); ++i) {
      part[i] *= depth(spec, here + static_cast<std::int64_t>(i));
    }
  }
}

}  // namespace knotwave::dsp
