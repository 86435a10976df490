// SPDX-License-Identifier: MIT
// Curves made, asked and evaluated from C.

#include "knotwave/curves/calculus.h"
#include "knotwave/curves/extrapolate.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::NurbsCurve;

namespace {

constexpr int32_t kMaxOrder = 1000;

bool is_side(kw_side side) { return side == KW_SIDE_RIGHT || side == KW_SIDE_LEFT; }

curves::Side side_of(kw_side side) {
  return side == KW_SIDE_LEFT ? curves::Side::left : curves::Side::right;
}

/// What every evaluation asks for: a curve, a side, and room for `rows` points.
kw_status check(const kw_curve* curve, kw_side side, size_t rows, const double* out,
                size_t out_count) {
  if (curve == nullptr) return KW_NULL_ARGUMENT;
  if (!is_side(side)) return KW_VALUE_OUT_OF_RANGE;
  const size_t dim = index_of(curve->curve.dim());
  if (out_count % dim != 0 || out_count / dim != rows) return KW_DIMENSION_MISMATCH;
  return out == nullptr && rows > 0 ? KW_NULL_ARGUMENT : KW_OK;
}

bool is_extrapolation(kw_extrapolation mode) {
  return mode >= KW_EXTRAPOLATE_HOLD && mode <= KW_EXTRAPOLATE_MIRROR;
}

curves::Extrapolation extrapolation_of(kw_extrapolation mode) {
  switch (mode) {
    case KW_EXTRAPOLATE_LINEAR:
      return curves::Extrapolation::linear;
    case KW_EXTRAPOLATE_PERIODIC:
      return curves::Extrapolation::periodic;
    case KW_EXTRAPOLATE_MIRROR:
      return curves::Extrapolation::mirror;
    default:
      return curves::Extrapolation::hold;
  }
}

}  // namespace

kw_status kw_curve_create(const kw_curve_spec* spec, kw_curve** out, kw_error** error) {
  const kw_curve_spec& given = readable(spec);
  const std::initializer_list<Needed> needed = {
      {"spec", spec},
      member("spec->points", given.points, given.points_count),
      member("spec->weights", given.weights, given.weights_count),
      member("spec->knots", given.knots, given.knots_count),
      member("spec->jumps", given.jumps, given.jumps_count)};
  return make_curve(needed, out, error, [&]() -> Result<NurbsCurve> {
    if (spec->struct_size != sizeof(kw_curve_spec)) {
      return fail(ErrorCode::unsupported_version, "begin the spec with KW_CURVE_SPEC_INIT");
    }
    constexpr size_t kMostPoints = KW_MAX_POINTS;
    for (const auto& fault :
         {count_fault("the spec's points_count", spec->points_count, kMostPoints * KW_MAX_DIM),
          count_fault("the spec's weights_count", spec->weights_count, kMostPoints),
          count_fault("the spec's knots_count", spec->knots_count, kMostKnots),
          count_fault("the spec's jumps_count", spec->jumps_count, kMostKnots)}) {
      if (fault) return *fault;
    }
    curves::CurveSpec made;
    made.name = text_of(spec->name);
    made.degree = spec->degree;
    made.dim = spec->dim;
    made.points = copied(spec->points, spec->points_count);
    made.weights = copied(spec->weights, spec->weights_count);
    made.knots = copied(spec->knots, spec->knots_count);
    made.periodic = spec->periodic;
    made.jumps = copied(spec->jumps, spec->jumps_count);
    return NurbsCurve::create(std::move(made));
  });
}

kw_status kw_curve_copy(const kw_curve* curve, kw_curve** out, kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&]() -> Result<NurbsCurve> { return curve->curve; });
}

kw_status kw_curve_renamed(const kw_curve* curve, const char* name, kw_curve** out,
                           kw_error** error) {
  return make_curve({{"curve", curve}, {"name", name}}, out, error, [&] {
    curves::CurveSpec spec = curve->curve.spec();
    spec.name = name;
    return NurbsCurve::create(std::move(spec));
  });
}

void kw_curve_free(kw_curve* curve) { delete curve; }

bool kw_curve_equal(const kw_curve* first, const kw_curve* second) {
  return first != nullptr && second != nullptr && first->curve == second->curve;
}

const char* kw_curve_name(const kw_curve* curve) {
  return curve ? curve->curve.name().c_str() : nullptr;
}
int32_t kw_curve_degree(const kw_curve* curve) { return curve ? curve->curve.degree() : 0; }
int32_t kw_curve_dim(const kw_curve* curve) { return curve ? curve->curve.dim() : 0; }
bool kw_curve_is_rational(const kw_curve* curve) { return curve && curve->curve.is_rational(); }
bool kw_curve_is_periodic(const kw_curve* curve) { return curve && curve->curve.is_periodic(); }
bool kw_curve_is_clamped(const kw_curve* curve) { return curve && curve->curve.is_clamped(); }
double kw_curve_u_min(const kw_curve* curve) { return curve ? curve->curve.u_min() : 0; }
double kw_curve_u_max(const kw_curve* curve) { return curve ? curve->curve.u_max() : 0; }
size_t kw_curve_point_count(const kw_curve* curve) {
  return curve ? index_of(curve->curve.point_count()) : 0;
}
const double* kw_curve_points(const kw_curve* curve, size_t* count) {
  return curve ? lent(curve->curve.points(), count) : nothing_lent(count);
}
const double* kw_curve_weights(const kw_curve* curve, size_t* count) {
  return curve ? lent(curve->curve.weights(), count) : nothing_lent(count);
}
const double* kw_curve_knots(const kw_curve* curve, size_t* count) {
  return curve ? lent(curve->curve.knots(), count) : nothing_lent(count);
}
const double* kw_curve_jumps(const kw_curve* curve, size_t* count) {
  return curve ? lent(curve->curve.jumps(), count) : nothing_lent(count);
}

kw_status kw_curve_evaluate(const kw_curve* curve, double u, kw_side side, double* out,
                            size_t out_count) {
  return kw_curve_evaluate_many(curve, &u, 1, side, out, out_count);
}

kw_status kw_curve_evaluate_many(const kw_curve* curve, const double* u, size_t u_count,
                                 kw_side side, double* out, size_t out_count) {
  const kw_status good = check(curve, side, u_count, out, out_count);
  if (good != KW_OK) return good;
  if (u == nullptr && u_count > 0) return KW_NULL_ARGUMENT;
  const size_t dim = index_of(curve->curve.dim());
  for (size_t i = 0; i < u_count; ++i) {
    curve->curve.evaluate(u[i], side_of(side), {out + i * dim, dim});
  }
  return KW_OK;
}

kw_status kw_curve_derivatives(const kw_curve* curve, double u, int32_t order, kw_side side,
                               double* out, size_t out_count) {
  if (order < 0 || order > kMaxOrder) return KW_VALUE_OUT_OF_RANGE;
  const kw_status good = check(curve, side, index_of(order) + 1, out, out_count);
  if (good == KW_OK) curve->curve.derivatives(u, order, side_of(side), {out, out_count});
  return good;
}

kw_status kw_curve_evaluate_extrapolated(const kw_curve* curve, double u, kw_extrapolation before,
                                         kw_extrapolation after, double* out, size_t out_count) {
  const kw_status good = check(curve, KW_SIDE_RIGHT, 1, out, out_count);
  if (good != KW_OK) return good;
  if (!is_extrapolation(before) || !is_extrapolation(after)) return KW_VALUE_OUT_OF_RANGE;
  curves::evaluate_extrapolated(curve->curve, u, extrapolation_of(before), extrapolation_of(after),
                                {out, out_count});
  return KW_OK;
}

kw_status kw_curve_curvature(const kw_curve* curve, double u, kw_side side, double* out) {
  if (curve == nullptr || out == nullptr) return KW_NULL_ARGUMENT;
  if (!is_side(side)) return KW_VALUE_OUT_OF_RANGE;
  *out = curves::curvature(curve->curve, u, side_of(side));
  return KW_OK;
}
