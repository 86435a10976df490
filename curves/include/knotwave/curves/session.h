// SPDX-License-Identifier: MIT
// A curve and what goes along with it, put together as GLU does: begin, one curve, attributes, end;
// then handed to call-backs as few steps (GLU's tessellator) or as maps to evaluate (its renderer).
// [control]
// Source: Khronos, GLU 1.3 reference pages gluBeginCurve, gluNurbsCurve, gluNurbsCallback.
#pragma once
#include <optional>
#include <vector>

#include "knotwave/curves/map.h"
#include "knotwave/curves/tessellate.h"

namespace knotwave::curves {

struct SessionCalls : TessellatorCalls {
  /// After value and slope: an attribute at the same u, [its dim].
  std::function<void(Target target, double u, std::span<const double>)> attribute;
};

/// Between begin() and an end exactly one curve, at most one attribute a target, and any number of
/// parts to keep. What is refused changes nothing; after an end, failed or not, the session is as
/// before begin(). Errors of all calls: usage (called outside or twice inside begin .. end, or the
/// curve is missing), with the calls named.
class CurveSession {
 public:
  /// How the curve is sampled, here and from then on; a property, set inside or outside.
  explicit CurveSession(Sampling sampling = MaxError{}) : sampling_(sampling) {}
  void set_sampling(Sampling sampling) { sampling_ = sampling; }

  Result<void> begin();
  /// The curve that decides where values are, and what its numbers are for. Errors: dimension_
  /// mismatch (more coordinates than the target takes), value_out_of_range (the target is none).
  Result<void> curve(Target target, NurbsCurve curve);
  /// Another curve over the same u, by knots of its own, clamped or wrapped where it is shorter.
  /// Errors: those of curve(), duplicate_name (a second one for the target, or that of the
  /// curve).
  Result<void> attribute(Target target, NurbsCurve curve);
  /// Keeps [u_a, u_b] of the curve; without, all of it. Parts are given in order (GLU trims
  /// surfaces by loops; a curve by intervals). Errors: empty_domain (u_a >= u_b),
  /// knots_decrease (u_a is below the end of the part before).
  Result<void> keep(double u_a, double u_b);

  /// Hands over the values of each kept part, stretch by stretch. Errors: those of
  /// sample_parameters(); nothing is called then.
  Result<void> end(const SessionCalls& calls, int max_values = 1 << 20);
  /// Everything as enabled maps, each over its own domain. Errors: those of MapSet::define(),
  /// unsupported (keep() was called: maps have no gaps).
  Result<MapSet> end_as_maps();

 private:
  struct Bound {
    Target target;
    NurbsCurve curve;
  };
  struct Part {
    double u_a, u_b;
  };
  Result<void> check_open(const char* call) const;
  static Result<void> check_width(const char* call, Target target, const NurbsCurve& curve);
  Result<void> check_complete(const char* call) const;
  Result<std::vector<Stretch>> all_stretches(int max_values) const;
  void hand_over(const Stretch& stretch, const SessionCalls& calls) const;
  void close();

  Sampling sampling_;
  bool open_ = false;
  std::optional<Bound> curve_;
  std::vector<Bound> attributes_;
  std::vector<Part> parts_;
};

}  // namespace knotwave::curves
