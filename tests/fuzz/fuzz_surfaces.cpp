// SPDX-License-Identifier: MIT
// Any bytes as a surface, or curves that make one, and up to 4 operations on it; or as loops that
// trim the plane. Surfaces of more than 400 points are not gone on with.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "knotwave/base/index.h"
#include "knotwave/curves/surface_algorithms.h"
#include "knotwave/curves/surface_shapes.h"
#include "knotwave/curves/trim_region.h"

#include "fuzz_shapes.h"

namespace knotwave::fuzz {
namespace {

using curves::Direction;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::Side;
using enum ErrorCode;

using Made = std::optional<NurbsSurface>;
using Edit = Made (*)(const NurbsSurface&, ByteReader&);
constexpr int kMostPoints = 400, kMostOperations = 4;

double ulp_of(const NurbsSurface& surface) {
  return fuzz::ulp_of(largest_coordinate(surface.points()));
}

Direction direction_from(ByteReader& bytes) {
  return bytes.one_in(2) ? Direction::u : Direction::v;
}

double place(const NurbsSurface& surface, Direction direction, ByteReader& bytes) {
  return direction == Direction::u
             ? place_in(bytes, surface.knots_u(), surface.u_min(), surface.u_max())
             : place_in(bytes, surface.knots_v(), surface.v_min(), surface.v_max());
}

Made kept(const NurbsSurface& surface, const Result<NurbsSurface>& edited,
          std::initializer_list<ErrorCode> named) {
  if (!edited) {
    check_refusal(edited.error(), named);
    return std::nullopt;
  }
  check_surface(*edited);
  check_same(surface, *edited, 5 * ulp_of(surface));
  return *edited;
}

Made insert(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  const double at = place(surface, direction, bytes);
  const int times = 1 + bytes.below(3);
  const Made finer =
      kept(surface, insert_knot(surface, direction, at, times),
           {parameter_out_of_range, knot_multiplicity, too_many_points, value_out_of_range});
  if (!finer) return std::nullopt;
  const double tolerance = 64 * ulp_of(surface);
  const auto back = remove_knot(*finer, direction, at, times, tolerance);
  if (!back) {
    check_refusal(back.error(), {parameter_out_of_range});
    return finer;
  }
  check_surface(back->surface);
  FUZZ_CHECK_AT_MOST(back->max_error, tolerance);
  check_same(surface, back->surface, tolerance + 6 * ulp_of(surface));
  return finer;
}

Made refine_some(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  const double knots[] = {place(surface, direction, bytes), place(surface, direction, bytes)};
  return kept(surface, refine(surface, direction, knots),
              {parameter_out_of_range, knot_multiplicity, too_many_points, value_out_of_range});
}

Made elevate(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  return kept(surface, elevate_degree(surface, direction, bytes.below(3)),
              {degree_out_of_range, too_many_points});
}

Made smaller(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  const double size = largest_coordinate(surface.points());
  const double tolerance = size * std::ldexp(1.0, -bytes.below(50));
  const auto reduced = bytes.one_in(2)
                           ? reduce_degree(surface, direction, tolerance)
                           : remove_knot(surface, direction, place(surface, direction, bytes),
                                         1 + bytes.below(3), tolerance);
  if (!reduced) {
    check_refusal(reduced.error(),
                  {parameter_out_of_range, degree_out_of_range, error_bound_missed});
    return std::nullopt;
  }
  check_surface(reduced->surface);
  FUZZ_CHECK_AT_MOST(reduced->max_error, tolerance);
  check_same(surface, reduced->surface,
             reduced->max_error + ulp_of(surface) + ulp_of(reduced->surface));
  return reduced->surface;
}

Made part(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  const double a = place(surface, direction, bytes), b = place(surface, direction, bytes);
  if (!bytes.one_in(2)) {
    return kept(surface, sub_surface(surface, direction, a, b),
                {parameter_out_of_range, empty_domain, value_out_of_range});
  }
  const auto both = split(surface, direction, a);
  if (!both) {
    check_refusal(both.error(), {parameter_out_of_range, value_out_of_range});
    return std::nullopt;
  }
  check_surface(both->low);
  return kept(surface, both->high, {});
}

Made turned(const NurbsSurface& surface, ByteReader& bytes) {
  const Direction direction = direction_from(bytes);
  const auto result = bytes.one_in(3) ? transpose(surface)
                      : bytes.one_in(2)
                          ? reverse(surface, direction)
                          : reparametrize(surface, direction, bytes.number(), bytes.number());
  if (!result) {
    check_refusal(result.error(),
                  {unsupported, knot_multiplicity, empty_domain, not_finite, value_out_of_range});
    return std::nullopt;
  }
  check_surface(*result);
  return *result;
}

Made looked_at(const NurbsSurface& surface, ByteReader& bytes) {
  const double u = place(surface, Direction::u, bytes), v = place(surface, Direction::v, bytes);
  double value[curves::kMaxDim], other[curves::kMaxDim], all[16 * curves::kMaxDim];
  surface.evaluate(u, v, value);
  surface.derivatives(u, v, 3, all);
  const NurbsCurve along_u = surface.iso_curve_at_v(v), along_v = surface.iso_curve_at_u(u);
  check_curve(along_u);
  check_curve(along_v);
  for (int c = 0; c < surface.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(all[c] - value[c]), ulp_of(surface));
  }
  along_u.evaluate(u, other);
  for (int c = 0; c < surface.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(other[c] - value[c]), 5 * ulp_of(surface));
  }
  along_v.evaluate(v, other);
  for (int c = 0; c < surface.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(other[c] - value[c]), 5 * ulp_of(surface));
  }
  return std::nullopt;
}

constexpr Edit kEdits[] = {insert, refine_some, elevate, smaller, part, turned, looked_at};

Made made(const Result<NurbsSurface>& surface, std::initializer_list<ErrorCode> named) {
  if (!surface) {
    check_refusal(surface.error(), named);
    return std::nullopt;
  }
  check_surface(*surface);
  return *surface;
}

Made from_rows(ByteReader& bytes) {
  std::vector<NurbsCurve> rows;
  for (int i = bytes.below(4); i >= 0; --i) {
    if (const auto row = curve_from(bytes)) rows.push_back(*row);
  }
  return made(lofted(rows, 1 + bytes.below(3)),
              {dimension_mismatch, too_many_points, knot_multiplicity, too_few_points,
               degree_out_of_range, not_finite, knots_decrease, weight_not_positive,
               coordinate_out_of_range, unsupported, value_out_of_range});
}

Made between(ByteReader& bytes) {
  const auto first = curve_from(bytes), second = curve_from(bytes);
  if (!first || !second) return std::nullopt;
  return made(ruled(*first, *second), {dimension_mismatch, too_many_points, knot_multiplicity,
                                       unsupported, value_out_of_range});
}

Made around(ByteReader& bytes) {
  const auto profile = curve_from(bytes);
  if (!profile) return std::nullopt;
  return made(revolved(*profile, bytes.one_in(2) ? 1 : bytes.number()),
              {dimension_mismatch, value_out_of_range, not_finite, unsupported, weight_out_of_range,
               too_many_points});
}

Made inside(ByteReader& bytes) {
  const auto bottom = curve_from(bytes), top = curve_from(bytes), left = curve_from(bytes),
             right = curve_from(bytes);
  if (!bottom || !top || !left || !right) return std::nullopt;
  const double tolerance = bytes.one_in(2) ? 1e-9 : 1e7;
  return made(coons(*bottom, *top, *left, *right, tolerance),
              {not_closed, unsupported, weight_not_positive, value_out_of_range, dimension_mismatch,
               too_many_points, knot_multiplicity, coordinate_out_of_range, weight_out_of_range});
}

bool is_kept(std::span<const curves::Interval> kept, double u) {
  return std::ranges::any_of(kept, [u](auto& part) { return part.low <= u && u <= part.high; });
}

// What is kept at a line is what contains() says, wherever no border is near.
void check_place(const curves::TrimRegion& region, double u, double v) {
  const bool inside = region.contains(u, v);
  const auto kept = region.intervals_at_v(v);
  FUZZ_CHECK(std::ranges::is_sorted(kept, {}, &curves::Interval::low));
  const double du = 1e-6 * (1 + std::abs(u)), dv = 1e-6 * (1 + std::abs(v));
  for (const double y : {v - dv, v, v + dv}) {
    const auto beside = region.intervals_at_v(y);
    for (const double x : {u - du, u + du}) {
      if (is_kept(beside, x) != is_kept(kept, u)) return;
    }
  }
  FUZZ_CHECK(inside == is_kept(kept, u));
}

// Loops of curves, closed by a wide tolerance.
Made trimmed(ByteReader& bytes) {
  std::vector<curves::TrimLoop> loops;
  for (int i = bytes.below(3); i >= 0; --i) {
    curves::TrimLoop loop;
    for (int k = bytes.below(3); k >= 0; --k) {
      if (const auto curve = curve_from(bytes)) loop.push_back(*curve);
    }
    if (bytes.one_in(2)) {
      const double u = bytes.number(), v = bytes.number();
      const auto zone = curves::rectangle_loop(u, u + bytes.byte(), v, v + bytes.byte());
      if (zone) loop = *zone;
    }
    loops.push_back(std::move(loop));
  }
  const auto region = curves::TrimRegion::create(loops, bytes.one_in(4) ? 1e7 : 1e-9);
  if (!region) {
    check_refusal(region.error(),
                  {dimension_mismatch, not_closed, malformed, value_out_of_range, too_few_points});
    return std::nullopt;
  }
  for (int i = 0; i < 4; ++i) check_place(*region, bytes.number(), bytes.number());
  return std::nullopt;
}

Made surface_of(ByteReader& bytes) {
  switch (bytes.below(8)) {
    case 0:
      return from_rows(bytes);
    case 1:
      return between(bytes);
    case 2:
      return around(bytes);
    case 3:
      return inside(bytes);
    case 4:
      return trimmed(bytes);
    default:
      return surface_from(bytes);
  }
}

}  // namespace
}  // namespace knotwave::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace knotwave::fuzz;
  ByteReader bytes({data, size});
  Made surface = surface_of(bytes);
  for (int i = 0; surface && i < kMostOperations && !bytes.is_empty(); ++i) {
    const auto index = knotwave::base::index_of(bytes.byte());
    const Made result = kEdits[index % std::size(kEdits)](*surface, bytes);
    if (result && result->count_u() * result->count_v() <= kMostPoints) surface = *result;
  }
  return 0;
}
