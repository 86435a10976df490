// SPDX-License-Identifier: MIT
#include "knotwave/dsp/envelope.h"

#include <algorithm>
#include <cmath>

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = 64;

// The brake, for 0 <= x < 1: value 0 and slope 1 at 0, dies away with two derivatives. Its largest
// value, at x = 1/4, is kBrakePeak.
constexpr double kBrakePeak = 27.0 / 256;
/// How its length is looked for: steps of bisection, places looked at, and what may lie between.
constexpr int kBrakeSteps = 5, kBrakePlaces = 16;
constexpr double kBrakeMargin = 63.0 / 64;
constexpr double brake(double x) { return x * (1 - x) * (1 - x) * (1 - x); }
constexpr double brake_slope(double x) { return (1 - x) * (1 - x) * (1 - 4 * x); }

// How long the corner is rounded where a held curve goes on: 10 ms, but no more than a 32nd of what
// is left of it.
constexpr double kRoundedSeconds = 0.01;
constexpr double kRoundedPart = 32;

double limited_scale(double scale) {
  if (!(scale == scale)) return 1;
  return std::clamp(scale, 1e-4, 1e4);
}

}  // namespace

std::span<const double> Envelope::last_controls(const EnvelopeProgram& program) const KNOTWAVE_RT {
  const auto count = controls_moved_ ? static_cast<std::size_t>(program.program().control_count())
                                     : std::size_t{0};
  return std::span(last_controls_).first(count);
}

// From the unfolded parameter to the place on the curve. No sums over time: a loop is unfolded by
// one division, whatever came before.
double Envelope::place(const EnvelopeProgram& program, double u) const KNOTWAVE_RT {
  const EnvelopeSpec& spec = program.spec();
  const bool is_open = stage_ == Stage::gate_open;
  if (is_open && program.has_sustain()) return std::min(u, spec.sustain_u);
  if (!is_open || !program.has_loop()) return std::min(u, program.program().u_max());
  if (u < spec.loop_end_u) return u;
  const double length = spec.loop_end_u - spec.loop_start_u;
  const double turns = std::floor((u - spec.loop_start_u) / length);
  const double folded = u - turns * length;
  // Rounding may leave it a hair outside.
  if (folded < spec.loop_start_u) return spec.loop_start_u;
  return folded < spec.loop_end_u ? folded : spec.loop_start_u;
}

double Envelope::place_at(const EnvelopeProgram& program, std::int64_t sample) const KNOTWAVE_RT {
  const curves::CurveProgram& curve = program.program();
  if (stage_ == Stage::idle) return 1;
  const double run = place_.u + static_cast<double>(sample - place_.sample) * u_per_sample_;
  const double u = std::clamp(place(program, run), curve.u_min(), curve.u_max());
  return (u - curve.u_min()) / (curve.u_max() - curve.u_min());
}

Envelope::Now Envelope::now(const EnvelopeProgram& program,
                            base::SampleTime time) const KNOTWAVE_RT {
  if (stage_ == Stage::idle) return {};
  const auto at_time = [&](const Run& run) {
    const double samples = static_cast<double>(time.sample - run.sample) +
                           static_cast<double>(time.fraction) * 0x1p-32;
    return run.u + samples * u_per_sample_;
  };
  const curves::CurveProgram& curve = program.program();
  const auto controls = last_controls(program);
  const double u = at_time(place_);
  Now now;
  now.place_u = place(program, u);
  now.held = stage_ == Stage::gate_open && program.has_sustain() && u >= now.place_u;
  now.held = now.held && now.place_u == program.spec().sustain_u;
  now.ended = now.place_u >= curve.u_max() && !now.held;
  now.value = curve.at_u(now.place_u, 0, controls);
  if (!now.held && !now.ended) {
    now.slope_per_sample = curve.slope_at_u(now.place_u, 0, controls) * u_per_sample_;
  }
  const double age = join_ != nullptr ? at_time(age_) : 0;
  if (join_ != nullptr && age < join_->u_basis_end) {
    const curves::CurveProgram& basis = join_->basis;
    now.joining = true;
    now.value += deltas_.dp0 * basis.at_u(age, 0) + deltas_.dp1 * basis.at_u(age, 1);
    now.slope_per_sample +=
        (deltas_.dp0 * basis.slope_at_u(age, 0) + deltas_.dp1 * basis.slope_at_u(age, 1)) *
        u_per_sample_;
    const double x = (age - join_->u_join) / brake_u_;
    if (brake_slope_ != 0 && x < 1) {
      now.value = rounded(now.value, x);
      now.slope_per_sample += brake_slope_ * brake_slope(x) * u_per_sample_;
    }
  }
  return now;
}

void Envelope::run_from(double u, base::SampleTime time) KNOTWAVE_RT {
  place_ = {time.sample, u - static_cast<double>(time.fraction) * 0x1p-32 * u_per_sample_};
}

void Envelope::join(const EnvelopeProgram& program, const curves::JoinProgram& section,
                    const Now& from, base::SampleTime time) KNOTWAVE_RT {
  const curves::CurveProgram& curve = program.program();
  const auto controls = last_controls(program);
  const double value = curve.at_u(section.u_join, 0, controls);
  const double slope = curve.slope_at_u(section.u_join, 0, controls);
  const double wanted = from.slope_per_sample / u_per_sample_;
  deltas_ = section.moves_p1 || section.is_vertical
                ? section.join_from(value, slope, from.value, wanted)
                : section.join_c0_from(value, from.value);
  if (deltas_.limited) ++limited_joins_;
  const bool is_level = deltas_.limited && section.moves_p1;
  if (is_level) deltas_ = section.join_from(value, slope, from.value, 0);
  const bool lacks = is_level || !(section.moves_p1 || section.is_vertical);
  const double kept = slope + deltas_.dp0 * section.basis.slope_at_u(section.u_join, 0) +
                      deltas_.dp1 * section.basis.slope_at_u(section.u_join, 1);
  const double longest = section.u_basis_end - section.u_join;
  set_brake({section, from.value, kept, is_level}, lacks ? wanted : kept, longest);
  start(section, time);
}

// Held where the section starts: as drawn, and only the corner is rounded.
void Envelope::let_go(const EnvelopeProgram& program, const Now& from,
                      base::SampleTime time) KNOTWAVE_RT {
  const curves::JoinProgram& section = program.release_join();
  const double slope = program.program().slope_at_u(section.u_join, 0, last_controls(program));
  const double longest =
      std::min((program.program().u_max() - section.u_join) / kRoundedPart, rounding_u_);
  deltas_ = {};
  set_brake({section, from.value, slope, false}, 0,
            std::min(longest, section.u_basis_end - section.u_join));
  start(section, time);
}

void Envelope::start(const curves::JoinProgram& section, base::SampleTime time) KNOTWAVE_RT {
  join_ = &section;
  run_from(section.u_join, time);
  age_ = place_;
}

// What lacks from the section's slope to `wanted` is played by a brake of such a length that the
// sum stays inside the hull. With room r from the value to the hull, the section stays r B0 away
// from it, because its other points are inside and those that follow keep their share of r; r (B0 +
// B1) where P1 is level with P0. And B0(u) >= 1 - f u with f its slope where it is convex, or 1 /
// its length where it is not. So a brake of peak b that ends by u with b + r f u <= r is safe; from
// there on a longer one, up to a peak of r, is looked for. Without weights the first always is
// safe; otherwise the clamp in rounded() has the last word.
void Envelope::set_brake(const Joined& joined, double wanted, double longest) KNOTWAVE_RT {
  const curves::JoinProgram& section = joined.section;
  brake_slope_ = wanted - joined.slope;
  brake_u_ = longest;
  const double room = brake_slope_ > 0 ? section.high - joined.value : joined.value - section.low;
  const double steepness = std::abs(brake_slope_);
  const double fall = std::max(-section.basis.slope_at_u(section.u_join, 0),
                               1 / (section.u_basis_end - section.u_join));
  if (!(room > 0 && steepness > 0)) {
    brake_slope_ = 0;
    return;
  }
  brake_u_ = std::min(room / (steepness * kBrakePeak + room * fall), longest);
  double too_long = std::min(room / (steepness * kBrakePeak), longest);
  for (int i = 0; i < kBrakeSteps; ++i) {
    const double length = 0.5 * (brake_u_ + too_long);
    (fits(joined, room / steepness, length) ? brake_u_ : too_long) = length;
  }
}

// Whether a brake of this length stays inside the room, which is given by slope.
bool Envelope::fits(const Joined& joined, double room, double length) const KNOTWAVE_RT {
  const curves::JoinProgram& section = joined.section;
  for (int i = 1; i < kBrakePlaces; ++i) {
    const double x = static_cast<double>(i) / kBrakePlaces;
    const double u = section.u_join + x * length;
    double kept = section.basis.at_u(u, 0);
    if (joined.is_level) kept += section.basis.at_u(u, 1);
    if (!(length * brake(x) <= kBrakeMargin * room * kept)) return false;
  }
  return true;
}

// A joined value with the brake, at an age where it still plays.
double Envelope::rounded(double value, double x) const KNOTWAVE_RT {
  const double y = value + brake_slope_ * brake_u_ * brake(x);
  return std::clamp(y, join_->low, join_->high);
}

void Envelope::gate_on(const EnvelopeProgram& program, base::SampleTime time, double rate_hz,
                       double time_scale) KNOTWAVE_RT {
  const Now from = now(program, time);
  const bool joins = !from.ended && program.spec().retrigger == EnvelopeSpec::Retrigger::current;
  stage_ = Stage::gate_open;
  const double u_per_second = program.u_per_second() / limited_scale(time_scale);
  u_per_sample_ = u_per_second / rate_hz;
  rounding_u_ = kRoundedSeconds * u_per_second;
  if (joins) {
    join(program, program.start_join(), from, time);
  } else {
    join_ = nullptr;
    run_from(program.program().u_min(), time);
  }
}

void Envelope::gate_off(const EnvelopeProgram& program, base::SampleTime time) KNOTWAVE_RT {
  if (stage_ != Stage::gate_open) return;
  const Now from = now(program, time);
  stage_ = Stage::released;
  if (!program.has_release()) {
    run_from(from.place_u, time);
  } else if (from.held && !from.joining && from.place_u == program.release_join().u_join) {
    let_go(program, from, time);
  } else {
    join(program, program.release_join(), from, time);
  }
}

void Envelope::render(const EnvelopeProgram& program, std::int64_t first,
                      std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT {
  if (out.empty()) return;
  for (std::size_t done = 0; done < out.size(); done += kChunk) {
    const auto part = out.subspan(done, std::min(kChunk, out.size() - done));
    render_chunk(program, first + static_cast<std::int64_t>(done), controls, done, part);
  }
  const auto count = static_cast<std::size_t>(program.program().control_count());
  controls_moved_ = count > 0 && controls.size() >= count;
  for (std::size_t k = 0; controls_moved_ && k < count; ++k) {
    last_controls_[k] = controls[k][out.size() - 1];
  }
}

void Envelope::render_chunk(const EnvelopeProgram& program, std::int64_t first,
                            std::span<const double* const> controls, std::size_t offset,
                            std::span<double> out) KNOTWAVE_RT {
  const curves::CurveProgram& curve = program.program();
  const std::size_t n = out.size();
  const curves::GridRun run{place_.u, u_per_sample_, first - place_.sample};
  const double last_u = run.at(static_cast<std::int64_t>(n) - 1);
  const bool is_rest = stage_ == Stage::idle;
  const double last_place = is_rest ? curve.u_max() : place(program, last_u);

  const auto control_count = static_cast<std::size_t>(curve.control_count());
  if (control_count > 0 && controls.size() >= control_count) {
    std::array<const double*, curves::kMaxControls> here{};
    for (std::size_t k = 0; k < control_count; ++k) here[k] = controls[k] + offset;
    std::array<double, kChunk> u;
    for (std::size_t i = 0; i < n; ++i) {
      u[i] = is_rest ? last_place : place(program, run.at(static_cast<std::int64_t>(i)));
    }
    curve.render(std::span<const double>(u).first(n), std::span(here).first(control_count), out,
                 cursor_);
  } else if (!is_rest && last_place == last_u) {  // neither loop nor sustain in this chunk
    curve.render(run, out, cursor_);
  } else if (is_rest || (place(program, run.at(0)) == last_place && !program.has_loop())) {
    std::fill(out.begin(), out.end(), curve.at_u(last_place));
  } else {
    std::array<double, kChunk> u;
    for (std::size_t i = 0; i < n; ++i) u[i] = place(program, run.at(static_cast<std::int64_t>(i)));
    curve.render(std::span<const double>(u).first(n), out, cursor_);
  }
  if (is_rest) return;
  add_join(program, first, out);
  const bool open_hold = stage_ == Stage::gate_open && program.has_sustain();
  if (last_place >= curve.u_max() && !open_hold) {
    stage_ = Stage::idle;
    join_ = nullptr;
  }
}

// What the join adds; both bases are exactly 0 from u_basis_end on.
void Envelope::add_join(const EnvelopeProgram& program, std::int64_t first,
                        std::span<double> out) KNOTWAVE_RT {
  if (join_ == nullptr) return;
  const curves::GridRun run{age_.u, u_per_sample_, first - age_.sample};
  std::size_t n = 0;
  while (n < out.size() && run.at(static_cast<std::int64_t>(n)) < join_->u_basis_end) ++n;
  if (n == 0) {
    join_ = nullptr;
    return;
  }
  std::array<double, kChunk> basis0, basis1;
  join_->basis.render(run, std::span(basis0).first(n), join_cursor_, 0);
  join_->basis.render(run, std::span(basis1).first(n), join_cursor_, 1);
  for (std::size_t i = 0; i < n; ++i) out[i] += deltas_.dp0 * basis0[i] + deltas_.dp1 * basis1[i];
  if (program.program().moves_knots()) {  // the bases are those at rest: the hull has the last word
    for (double& y : out.first(n)) y = std::clamp(y, join_->low, join_->high);
  }
  if (brake_slope_ == 0) return;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = (run.at(static_cast<std::int64_t>(i)) - join_->u_join) / brake_u_;
    if (!(x < 1)) break;
    out[i] = rounded(out[i], x);
  }
}

}  // namespace knotwave::dsp
