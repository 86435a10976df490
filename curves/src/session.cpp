// SPDX-License-Identifier: MIT
#include "knotwave/curves/session.h"

#include <algorithm>
#include <array>
#include <string>

#include "knotwave/base/document.h"

namespace knotwave::curves {
namespace {

using base::number_text;

Error misuse(const char* call, const std::string& what) {
  return fail(ErrorCode::usage, std::string("session: ") + call + "() " + what);
}

}  // namespace

Result<void> CurveSession::check_open(const char* call) const {
  if (open_) return {};
  return misuse(call, "without begin()");
}

Result<void> CurveSession::check_width(const char* call, Target target, const NurbsCurve& curve) {
  if (!is_target(target)) {
    return fail(ErrorCode::value_out_of_range, std::string("session: ") + call + "(): target " +
                                                   std::to_string(static_cast<int>(target)) +
                                                   " is outside 0.." +
                                                   std::to_string(kTargetCount - 1));
  }
  if (curve.dim() <= widest(target)) return {};
  return fail(ErrorCode::dimension_mismatch,
              std::string("session: ") + call + "(" + to_string(target) + "): curve '" +
                  curve.name() + "' has " + std::to_string(curve.dim()) +
                  " coordinates, the target takes " + std::to_string(widest(target)) + " at most");
}

Result<void> CurveSession::check_complete(const char* call) const {
  if (auto ok = check_open(call); !ok) return ok;
  if (curve_) return {};
  return misuse(call, "without a curve() since begin()");
}

Result<void> CurveSession::begin() {
  if (open_) return misuse("begin", "inside begin() .. end()");
  open_ = true;
  return {};
}

Result<void> CurveSession::curve(Target target, NurbsCurve curve) {
  if (auto ok = check_open("curve"); !ok) return ok;
  if (curve_) return misuse("curve", "twice since begin()");
  if (auto ok = check_width("curve", target, curve); !ok) return ok;
  for (const Bound& other : attributes_) {
    if (other.target != target) continue;
    return fail(ErrorCode::duplicate_name,
                std::string("session: ") + to_string(target) + " already is an attribute");
  }
  curve_ = Bound{target, std::move(curve)};
  return {};
}

Result<void> CurveSession::attribute(Target target, NurbsCurve curve) {
  if (auto ok = check_open("attribute"); !ok) return ok;
  if (auto ok = check_width("attribute", target, curve); !ok) return ok;
  const bool is_taken = (curve_ && curve_->target == target) ||
                        std::any_of(attributes_.begin(), attributes_.end(),
                                    [&](const Bound& other) { return other.target == target; });
  if (is_taken) {
    return fail(ErrorCode::duplicate_name,
                std::string("session: ") + to_string(target) + " already has a curve");
  }
  attributes_.push_back({target, std::move(curve)});
  return {};
}

Result<void> CurveSession::keep(double u_a, double u_b) {
  if (auto ok = check_open("keep"); !ok) return ok;
  if (!(u_a < u_b)) {
    return fail(ErrorCode::empty_domain, "session: keep() from u = " + number_text(u_a) + " to " +
                                             number_text(u_b) + " keeps nothing");
  }
  if (!parts_.empty() && u_a < parts_.back().u_b) {
    return fail(ErrorCode::knots_decrease, "session: keep() from u = " + number_text(u_a) +
                                               ", which is below the end of the part before, " +
                                               number_text(parts_.back().u_b));
  }
  parts_.push_back({u_a, u_b});
  return {};
}

void CurveSession::close() {
  open_ = false;
  curve_.reset();
  attributes_.clear();
  parts_.clear();
}

Result<std::vector<Stretch>> CurveSession::all_stretches(int max_values) const {
  const NurbsCurve& curve = curve_->curve;
  std::vector<Part> parts = parts_;
  if (parts.empty()) parts.push_back({curve.u_min(), curve.u_max()});
  std::vector<Stretch> all;
  int left = max_values;
  for (const Part& part : parts) {
    auto stretches = sample_parameters(curve, sampling_, part.u_a, part.u_b, left);
    if (!stretches) return stretches;
    for (Stretch& stretch : *stretches) {
      left -= static_cast<int>(stretch.size());
      all.push_back(std::move(stretch));
    }
  }
  return all;
}

void CurveSession::hand_over(const Stretch& stretch, const SessionCalls& calls) const {
  const auto dim = static_cast<std::size_t>(curve_->curve.dim());
  if (calls.begin) calls.begin(stretch.front());
  for (const double u : stretch) {
    const Side side = u == stretch.back() ? Side::left : Side::right;
    std::array<double, 2UL * kMaxDim> value{};
    curve_->curve.derivatives(u, calls.slope ? 1 : 0, side, value);
    if (calls.value) calls.value(u, std::span(value).first(dim));
    if (calls.slope) calls.slope(u, std::span(value).subspan(dim, dim));
    if (!calls.attribute) continue;
    for (const Bound& attribute : attributes_) {
      std::array<double, kMaxDim> numbers{};
      attribute.curve.evaluate(u, side, numbers);
      const auto width = static_cast<std::size_t>(attribute.curve.dim());
      calls.attribute(attribute.target, u, std::span(numbers).first(width));
    }
  }
  if (calls.end) calls.end(stretch.back());
}

Result<void> CurveSession::end(const SessionCalls& calls, int max_values) {
  auto ok = check_complete("end");
  if (ok) {
    const auto stretches = all_stretches(max_values);
    if (stretches) {
      for (const Stretch& stretch : *stretches) hand_over(stretch, calls);
    } else {
      ok = stretches.error();
    }
  }
  close();
  return ok;
}

Result<MapSet> CurveSession::end_as_maps() {
  if (auto ok = check_complete("end_as_maps"); !ok) {
    close();
    return ok.error();
  }
  std::vector<Bound> all = std::move(attributes_);
  all.push_back(std::move(*curve_));
  const bool has_gaps = !parts_.empty();
  close();
  if (has_gaps)
    return fail(ErrorCode::unsupported, "session: maps have no gaps, but keep() was called");
  MapSet maps;
  for (Bound& bound : all) {
    // An attribute's own u is the common one.
    const double a = bound.curve.u_min(), b = bound.curve.u_max();
    const auto key = maps.define(Map1{bound.target, a, b, std::move(bound.curve)});
    if (!key) return key.error();
    maps.enable(*key);
  }
  return maps;
}

}  // namespace knotwave::curves
