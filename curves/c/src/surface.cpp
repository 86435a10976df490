// SPDX-License-Identifier: MIT
// Surfaces made, asked and evaluated from C.
#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::NurbsSurface;

namespace {

constexpr int32_t kMaxOrder = curves::kMaxDegree;

Result<NurbsSurface> surface_of(const kw_surface_spec& spec) {
  if (spec.struct_size != sizeof(kw_surface_spec)) {
    return fail(ErrorCode::unsupported_version, "begin the spec with KW_SURFACE_SPEC_INIT");
  }
  constexpr size_t kMostPoints = KW_MAX_POINTS;
  for (const auto& fault :
       {count_fault("the spec's points_count", spec.points_count, kMostPoints * KW_MAX_DIM),
        count_fault("the spec's weights_count", spec.weights_count, kMostPoints),
        count_fault("the spec's knots_u_count", spec.knots_u_count, kMostKnots),
        count_fault("the spec's knots_v_count", spec.knots_v_count, kMostKnots)}) {
    if (fault) return *fault;
  }
  curves::SurfaceSpec made;
  made.name = text_of(spec.name);
  made.degree_u = spec.degree_u;
  made.degree_v = spec.degree_v;
  made.dim = spec.dim;
  made.count_u = spec.count_u;
  made.count_v = spec.count_v;
  made.points = copied(spec.points, spec.points_count);
  made.weights = copied(spec.weights, spec.weights_count);
  made.knots_u = copied(spec.knots_u, spec.knots_u_count);
  made.knots_v = copied(spec.knots_v, spec.knots_v_count);
  made.periodic_u = spec.periodic_u;
  return NurbsSurface::create(std::move(made));
}

}  // namespace

kw_status kw_surface_create(const kw_surface_spec* spec, kw_surface** out, kw_error** error) {
  const kw_surface_spec& given = readable(spec);
  const std::initializer_list<Needed> needed = {
      {"spec", spec},
      member("spec->points", given.points, given.points_count),
      member("spec->weights", given.weights, given.weights_count),
      member("spec->knots_u", given.knots_u, given.knots_u_count),
      member("spec->knots_v", given.knots_v, given.knots_v_count)};
  return make_surface(needed, out, error, [&] { return surface_of(*spec); });
}
kw_status kw_surface_copy(const kw_surface* surface, kw_surface** out, kw_error** error) {
  return make_surface({{"surface", surface}}, out, error,
                      [&]() -> Result<NurbsSurface> { return surface->surface; });
}
void kw_surface_free(kw_surface* surface) { delete surface; }

bool kw_surface_equal(const kw_surface* first, const kw_surface* second) {
  return first != nullptr && second != nullptr && first->surface == second->surface;
}

const char* kw_surface_name(const kw_surface* surface) {
  return surface ? surface->surface.name().c_str() : nullptr;
}
int32_t kw_surface_degree_u(const kw_surface* surface) {
  return surface ? surface->surface.degree_u() : 0;
}
int32_t kw_surface_degree_v(const kw_surface* surface) {
  return surface ? surface->surface.degree_v() : 0;
}
int32_t kw_surface_dim(const kw_surface* surface) { return surface ? surface->surface.dim() : 0; }
bool kw_surface_is_rational(const kw_surface* surface) {
  return surface && surface->surface.is_rational();
}
bool kw_surface_is_periodic_u(const kw_surface* surface) {
  return surface && surface->surface.is_periodic_u();
}
int32_t kw_surface_count_u(const kw_surface* surface) {
  return surface ? surface->surface.count_u() : 0;
}
int32_t kw_surface_count_v(const kw_surface* surface) {
  return surface ? surface->surface.count_v() : 0;
}
double kw_surface_u_min(const kw_surface* surface) {
  return surface ? surface->surface.u_min() : 0;
}
double kw_surface_u_max(const kw_surface* surface) {
  return surface ? surface->surface.u_max() : 0;
}
double kw_surface_v_min(const kw_surface* surface) {
  return surface ? surface->surface.v_min() : 0;
}
double kw_surface_v_max(const kw_surface* surface) {
  return surface ? surface->surface.v_max() : 0;
}
const double* kw_surface_points(const kw_surface* surface, size_t* count) {
  return surface ? lent(surface->surface.points(), count) : nothing_lent(count);
}
const double* kw_surface_weights(const kw_surface* surface, size_t* count) {
  return surface ? lent(surface->surface.weights(), count) : nothing_lent(count);
}
const double* kw_surface_knots_u(const kw_surface* surface, size_t* count) {
  return surface ? lent(surface->surface.knots_u(), count) : nothing_lent(count);
}
const double* kw_surface_knots_v(const kw_surface* surface, size_t* count) {
  return surface ? lent(surface->surface.knots_v(), count) : nothing_lent(count);
}

kw_status kw_surface_evaluate(const kw_surface* surface, double u, double v, double* out,
                              size_t out_count) {
  return kw_surface_evaluate_grid(surface, &u, 1, &v, 1, out, out_count);
}

kw_status kw_surface_evaluate_grid(const kw_surface* surface, const double* u, size_t u_count,
                                   const double* v, size_t v_count, double* out, size_t out_count) {
  if (surface == nullptr || (u == nullptr && u_count > 0) || (v == nullptr && v_count > 0)) {
    return KW_NULL_ARGUMENT;
  }
  const size_t dim = index_of(surface->surface.dim());
  const size_t wanted = u_count * v_count;
  if (u_count != 0 && wanted / u_count != v_count) return KW_DIMENSION_MISMATCH;
  if (out_count % dim != 0 || out_count / dim != wanted) return KW_DIMENSION_MISMATCH;
  if (out == nullptr && wanted > 0) return KW_NULL_ARGUMENT;
  for (size_t j = 0; j < v_count; ++j) {
    for (size_t i = 0; i < u_count; ++i) {
      surface->surface.evaluate(u[i], v[j], {out + (j * u_count + i) * dim, dim});
    }
  }
  return KW_OK;
}

kw_status kw_surface_derivatives(const kw_surface* surface, double u, double v, int32_t order,
                                 double* out, size_t out_count) {
  if (surface == nullptr || out == nullptr) return KW_NULL_ARGUMENT;
  if (order < 0 || order > kMaxOrder) return KW_VALUE_OUT_OF_RANGE;
  const size_t side = index_of(order) + 1;
  if (out_count != side * side * index_of(surface->surface.dim())) return KW_DIMENSION_MISMATCH;
  surface->surface.derivatives(u, v, order, {out, out_count});
  return KW_OK;
}

kw_status kw_surface_iso_curve_at_v(const kw_surface* surface, double v, kw_curve** out,
                                    kw_error** error) {
  return make_curve({{"surface", surface}}, out, error, [&]() -> Result<curves::NurbsCurve> {
    return surface->surface.iso_curve_at_v(v);
  });
}

kw_status kw_surface_iso_curve_at_u(const kw_surface* surface, double u, kw_curve** out,
                                    kw_error** error) {
  return make_curve({{"surface", surface}}, out, error, [&]() -> Result<curves::NurbsCurve> {
    return surface->surface.iso_curve_at_u(u);
  });
}
