// SPDX-License-Identifier: MIT
// Owners of C handles, and a call that must succeed.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::c {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* handle) const {
    Free(handle);
  }
};
using Curve = std::unique_ptr<kw_curve, Freed<kw_curve_free>>;
using Surface = std::unique_ptr<kw_surface, Freed<kw_surface_free>>;
using Program = std::unique_ptr<kw_program, Freed<kw_program_free>>;
using Set = std::unique_ptr<kw_curve_set, Freed<kw_curve_set_free>>;
using Maps = std::unique_ptr<kw_map_set, Freed<kw_map_set_free>>;
using Bezier = std::unique_ptr<kw_bezier, Freed<kw_bezier_free>>;
using Fault = std::unique_ptr<kw_error, Freed<kw_error_free>>;
using Text = std::unique_ptr<char, Freed<kw_text_free>>;

/// made<Curve>(kw_curve_reverse, curve): the arguments, then `out` and `error`.
template <class Owner, class Call, class... Arguments>
Owner made(Call call, Arguments... arguments) {
  typename Owner::pointer out = nullptr;
  kw_error* error = nullptr;
  const kw_status status = call(arguments..., &out, &error);
  const Fault fault(error);
  EXPECT_EQ(status, KW_OK) << kw_error_text(error);
  EXPECT_EQ(error, nullptr);
  EXPECT_NE(out, nullptr);
  return Owner(out);
}

struct Failure {
  kw_status status;
  std::string message;
  std::string text;
};
/// The same for a call that must fail: nothing is made.
template <class Out, class Call, class... Arguments>
Failure refused(Call call, Arguments... arguments) {
  Out* const kSentinel = reinterpret_cast<Out*>(&call);
  Out* out = kSentinel;
  kw_error* error = nullptr;
  const kw_status status = call(arguments..., &out, &error);
  const Fault fault(error);
  EXPECT_NE(status, KW_OK);
  EXPECT_EQ(out, nullptr);
  EXPECT_EQ(kw_error_status(error), status);
  return {status, kw_error_message(error), kw_error_text(error)};
}

inline Curve curve_of(const curves::CurveSpec& spec) {
  kw_curve_spec from = KW_CURVE_SPEC_INIT;
  from.name = spec.name.c_str();
  from.degree = spec.degree;
  from.dim = spec.dim;
  from.points = spec.points.data();
  from.points_count = spec.points.size();
  from.weights = spec.weights.data();
  from.weights_count = spec.weights.size();
  from.knots = spec.knots.data();
  from.knots_count = spec.knots.size();
  from.jumps = spec.jumps.data();
  from.jumps_count = spec.jumps.size();
  from.periodic = spec.periodic;
  return made<Curve>(kw_curve_create, &from);
}

/// What C holds is what C++ made, to the bit.
inline void expect_same(const kw_curve* made, const Result<curves::NurbsCurve>& wanted) {
  ASSERT_TRUE(wanted) << wanted.error().to_string();
  const Curve copy = curve_of(wanted->spec());
  EXPECT_TRUE(kw_curve_equal(made, copy.get())) << wanted->name();
}

/// A rational cubic with a double knot.
inline curves::CurveSpec bell() {
  return {.name = "bell",
          .degree = 3,
          .points = {0, 0.25, 1, 0.5, -0.25, 0},
          .weights = {1, 1, 4, 1, 0.5, 1},
          .knots = {0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1}};
}
/// The same without weights.
inline curves::CurveSpec plain() {
  curves::CurveSpec spec = bell();
  spec.name = "plain";
  spec.weights.clear();
  return spec;
}

}  // namespace knotwave::c
