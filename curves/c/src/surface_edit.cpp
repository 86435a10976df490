// SPDX-License-Identifier: MIT
// Surfaces edited, and made from curves, from C.
#include "knotwave/curves/surface_algorithms.h"
#include "knotwave/curves/surface_shapes.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::Direction;
using curves::NurbsSurface;

namespace {

/// `work` gets the direction, once it is one; `also` is needed besides the surface.
template <class Work>
kw_status edit(const kw_surface* surface, kw_direction direction, kw_surface** out,
               kw_error** error, Work&& work, Needed also = member("", nullptr, 0)) noexcept {
  return make_surface({{"surface", surface}, also}, out, error, [&]() -> Result<NurbsSurface> {
    if (direction != KW_DIRECTION_U && direction != KW_DIRECTION_V) {
      return unknown_choice("the direction", direction, 2);
    }
    return work(direction == KW_DIRECTION_U ? Direction::u : Direction::v);
  });
}

Result<NurbsSurface> told(Result<curves::ReducedSurface> made, int32_t* removed,
                          double* max_error) {
  if (!made) return std::move(made).error();
  if (removed != nullptr) *removed = made->removed;
  if (max_error != nullptr) *max_error = made->max_error;
  return std::move(made->surface);
}

}  // namespace

kw_status kw_surface_insert_knot(const kw_surface* surface, kw_direction direction, double at,
                                 int32_t times, kw_surface** out, kw_error** error) {
  return edit(surface, direction, out, error,
              [&](Direction along) { return insert_knot(surface->surface, along, at, times); });
}
kw_status kw_surface_refine(const kw_surface* surface, kw_direction direction, const double* knots,
                            size_t knots_count, kw_surface** out, kw_error** error) {
  return edit(
      surface, direction, out, error,
      [&](Direction along) -> Result<NurbsSurface> {
        auto fault = count_fault("knots_count", knots_count, kMostKnots);
        if (fault) return *std::move(fault);
        return refine(surface->surface, along, numbers(knots, knots_count));
      },
      member("knots", knots, knots_count));
}
kw_status kw_surface_elevate_degree(const kw_surface* surface, kw_direction direction,
                                    int32_t times, kw_surface** out, kw_error** error) {
  return edit(surface, direction, out, error,
              [&](Direction along) { return elevate_degree(surface->surface, along, times); });
}
kw_status kw_surface_part(const kw_surface* surface, kw_direction direction, double a, double b,
                          kw_surface** out, kw_error** error) {
  return edit(surface, direction, out, error,
              [&](Direction along) { return sub_surface(surface->surface, along, a, b); });
}
kw_status kw_surface_split(const kw_surface* surface, kw_direction direction, double at,
                           kw_surface** out_low, kw_surface** out_high, kw_error** error) {
  if (out_low != nullptr) *out_low = nullptr;
  std::unique_ptr<kw_surface> low;
  const kw_status status =
      edit(surface, direction, out_high, error,
           [&](Direction along) -> Result<NurbsSurface> {
             if (out_low == out_high) return one_place_for_two();
             auto parts = split(surface->surface, along, at);
             if (!parts) return std::move(parts).error();
             low = std::make_unique<kw_surface>(kw_surface{std::move(parts->low)});
             return std::move(parts->high);
           },
           {"out_low", out_low});
  if (status == KW_OK) *out_low = low.release();
  return status;
}

kw_status kw_surface_remove_knot(const kw_surface* surface, kw_direction direction, double at,
                                 int32_t times, double tolerance, kw_surface** out,
                                 int32_t* removed, double* max_error, kw_error** error) {
  return edit(surface, direction, out, error, [&](Direction along) {
    return told(remove_knot(surface->surface, along, at, times, tolerance), removed, max_error);
  });
}
kw_status kw_surface_reduce_degree(const kw_surface* surface, kw_direction direction,
                                   double tolerance, kw_surface** out, double* max_error,
                                   kw_error** error) {
  return edit(surface, direction, out, error, [&](Direction along) {
    return told(reduce_degree(surface->surface, along, tolerance), nullptr, max_error);
  });
}

kw_status kw_surface_reverse(const kw_surface* surface, kw_direction direction, kw_surface** out,
                             kw_error** error) {
  return edit(surface, direction, out, error,
              [&](Direction along) { return reverse(surface->surface, along); });
}
kw_status kw_surface_reparametrize(const kw_surface* surface, kw_direction direction, double a,
                                   double b, kw_surface** out, kw_error** error) {
  return edit(surface, direction, out, error,
              [&](Direction along) { return reparametrize(surface->surface, along, a, b); });
}
kw_status kw_surface_transpose(const kw_surface* surface, kw_surface** out, kw_error** error) {
  return make_surface({{"surface", surface}}, out, error,
                      [&] { return transpose(surface->surface); });
}

kw_status kw_surface_ruled(const kw_curve* first, const kw_curve* second, kw_surface** out,
                           kw_error** error) {
  return make_surface({{"first", first}, {"second", second}}, out, error,
                      [&] { return curves::ruled(first->curve, second->curve); });
}
kw_status kw_surface_lofted(const kw_curve* const* rows, size_t rows_count, int32_t degree_v,
                            const double* positions, size_t positions_count, kw_surface** out,
                            kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({array("rows", rows, rows_count),
              array("positions", positions, positions_count),
              {"out", out}},
             error, [&]() -> kw_status {
               const std::string absent = missing_among("rows", rows, rows_count);
               if (!absent.empty()) return report(error, KW_NULL_ARGUMENT, absent);
               return give(curves::lofted(curves_of(rows, rows_count), degree_v,
                                          numbers(positions, positions_count)),
                           error, [&](NurbsSurface&& surface) {
                             *out = new kw_surface{std::move(surface)};
                           });
             });
}
kw_status kw_surface_revolved(const kw_curve* profile, double length_cycles, kw_surface** out,
                              kw_error** error) {
  return make_surface({{"profile", profile}}, out, error,
                      [&] { return curves::revolved(profile->curve, length_cycles); });
}
kw_status kw_surface_bilinear(const double* corners, size_t corners_count, int32_t dim,
                              kw_surface** out, kw_error** error) {
  return make_surface({array("corners", corners, corners_count)}, out, error,
                      [&] { return curves::bilinear(numbers(corners, corners_count), dim); });
}
kw_status kw_surface_coons(const kw_curve* bottom, const kw_curve* top, const kw_curve* left,
                           const kw_curve* right, double tolerance, kw_surface** out,
                           kw_error** error) {
  return make_surface(
      {{"bottom", bottom}, {"top", top}, {"left", left}, {"right", right}}, out, error, [&] {
        return curves::coons(bottom->curve, top->curve, left->curve, right->curve, tolerance);
      });
}
