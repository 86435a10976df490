// SPDX-License-Identifier: MIT
// The longest step of a curve that a sampling policy allows. Private to curves. [control]
#pragma once
#include <optional>
#include <string>

#include "knotwave/curves/tessellate.h"

#include "curve_distance.h"

namespace knotwave::curves {

/// What one step of a policy costs: 1 is what is allowed. Policies: MaxError and MaxStep.
class StepCost {
 public:
  StepCost(const NurbsCurve& curve, const Sampling& sampling)
      : curve_(curve), homogeneous_(curve), sampling_(sampling) {}

  /// Over [a, b], a < b, inside one stretch. Above kTooMuch it may be more than it says.
  double of(double a, double b) const;
  /// How many times as long a step would cost about 1.
  double growth(double cost) const;
  /// What is left of the span from a on.
  double rest_of_span(double a) const { return next_knot(a) - a; }
  /// The end of the shortest step from a: the next double, or, beside 0, where that would
  /// underflow, 2^-80 of the span; weights of 1e-6 to 1e6 leave nothing to happen in less.
  double shortest_step(double a) const;
  /// Why not even the shortest step from a will do.
  std::string why_none(double a) const;

 private:
  static constexpr double kTooMuch = 6;
  using Value = std::array<double, kMaxDim>;
  using Place = std::array<DoubleDouble, kMaxDim>;

  bool is_error() const { return std::holds_alternative<MaxError>(sampling_); }
  double allowed_error() const;
  double next_knot(double u) const;
  Value value_at(double u, Side side) const;
  static BezierPiece over_weights(const Place& start, const Place& end, const BezierPiece& piece);

  double error_of(double a, double b) const;
  double rounding_of(double a, double b) const;
  double movement_of(double a, double b) const;
  double difference_of(double a, double b) const;

  /// work(left, right, piece) for each span's part of [a, b] while it returns true.
  template <class Work>
  void for_each_piece(double a, double b, Work work) const;

  const NurbsCurve& curve_;
  HomogeneousCurve homogeneous_;
  const Sampling& sampling_;
};

/// Steps as long as their cost allows, one after the other.
class StepSearch {
 public:
  StepSearch(const NurbsCurve& curve, const Sampling& sampling) : cost_(curve, sampling) {}

  /// The end of the step that begins at a, at most `end`; none if even the shortest costs too much.
  std::optional<double> next(double a, double end);
  std::string why_none(double a) const { return cost_.why_none(a); }

 private:
  StepCost cost_;
  double length_ = 0;  ///< of the last step
};

}  // namespace knotwave::curves
