// SPDX-License-Identifier: MIT
#include "knotwave/dsp/glide.h"

#include <algorithm>
#include <array>

#include "moved_curve.h"

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = 64;

double built_in_s(double t) { return t * t * (3 - 2 * t); }

double on_domain(const curves::CurveProgram& curve, double t) {
  return curve.u_min() + t * (curve.u_max() - curve.u_min());
}

}  // namespace

void Glide::reset(double value) KNOTWAVE_RT {
  *this = {};
  from_ = target_ = value == value ? value : 0;
}

// 0 at the start, 1 and more from the end on.
double Glide::progress(std::int64_t sample, std::uint32_t fraction) const KNOTWAVE_RT {
  const double since =
      base::samples_since(start_, sample) + static_cast<double>(fraction) * 0x1p-32;
  if (!(since < samples_)) return 1;
  return since > 0 ? since / samples_ : 0;
}

void Glide::start(const curves::CurveProgram* curve, double target, base::SampleTime time,
                  double seconds, double rate_hz) KNOTWAVE_RT {
  if (target != target) return;
  const double t = progress(time.sample, time.fraction);
  if (t < 1) {
    const std::span<const double> controls = std::span(last_controls_).first(control_count_);
    const double c =
        curve != nullptr ? curve->at_u(on_domain(*curve, t), 0, controls) : built_in_s(t);
    from_ += (target_ - from_) * c;
  } else {
    from_ = target_;
  }
  target_ = target;
  start_ = time;
  samples_ = seconds > 0 ? seconds * rate_hz : 0;
}

void Glide::render(const curves::CurveProgram* curve, std::int64_t first,
                   std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT {
  std::array<double, kChunk> t;
  for (std::size_t done = 0; done < out.size(); done += kChunk) {
    const auto part = out.subspan(done, std::min(kChunk, out.size() - done));
    const std::int64_t here = first + static_cast<std::int64_t>(done);
    std::size_t moving = 0;
    while (moving < part.size()) {
      t[moving] = progress(here + static_cast<std::int64_t>(moving), 0);
      if (!(t[moving] < 1)) break;
      ++moving;
    }
    if (curve != nullptr) {
      for (std::size_t i = 0; i < moving; ++i) t[i] = on_domain(*curve, t[i]);
      render_moved(*curve, std::span<const double>(t).first(moving), controls, done,
                   part.first(moving), cursor_);
    } else {
      std::transform(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(moving), part.begin(),
                     built_in_s);
    }
    for (std::size_t i = 0; i < moving; ++i) part[i] = from_ + (target_ - from_) * part[i];
    std::fill(part.begin() + static_cast<std::ptrdiff_t>(moving), part.end(), target_);
  }
  const auto count = curve != nullptr ? static_cast<std::size_t>(curve->control_count()) : 0;
  control_count_ = controls.size() >= count && !out.empty() ? count : 0;
  for (std::size_t k = 0; k < control_count_; ++k) last_controls_[k] = controls[k][out.size() - 1];
}

}  // namespace knotwave::dsp
