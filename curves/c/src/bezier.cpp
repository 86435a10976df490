// SPDX-License-Identifier: MIT
// Curves as Bézier segments and back, from C.
#include "knotwave/curves/bezier.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::BezierSegment;

namespace {

Error wrong_count(const char* what, size_t found, size_t wanted) {
  return fail(ErrorCode::dimension_mismatch,
              std::to_string(found) + " " + what + ", " + std::to_string(wanted) + " are needed");
}

/// Arrays of all segments as the C caller has them.
struct Rows {
  std::span<const double> ends, points, weights;
};

Result<std::vector<BezierSegment>> segments_of(int degree, int dim, const Rows& rows) {
  if (degree < 1 || degree > curves::kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "degree " + std::to_string(degree) +
                                                    " is not within 1.." +
                                                    std::to_string(curves::kMaxDegree));
  }
  if (dim < 1 || dim > curves::kMaxDim) {
    return fail(
        ErrorCode::dimension_mismatch,
        std::to_string(dim) + " coordinates are not within 1.." + std::to_string(curves::kMaxDim));
  }
  const size_t count = rows.ends.empty() ? 0 : rows.ends.size() - 1;
  const size_t row = index_of(degree) + 1, size = row * index_of(dim);
  if (rows.points.size() / size != count || rows.points.size() % size != 0) {
    return wrong_count("numbers of points", rows.points.size(), count * size);
  }
  if (!rows.weights.empty() && rows.weights.size() != count * row) {
    return wrong_count("weights", rows.weights.size(), count * row);
  }
  std::vector<BezierSegment> segments;
  for (size_t i = 0; i < count; ++i) {
    BezierSegment segment{rows.ends[i], rows.ends[i + 1], degree, dim, {}, {}};
    const auto points = rows.points.subspan(i * size, size);
    segment.points.assign(points.begin(), points.end());
    segment.weights.assign(row, 1.0);
    if (!rows.weights.empty()) {
      const auto weights = rows.weights.subspan(i * row, row);
      segment.weights.assign(weights.begin(), weights.end());
    }
    segments.push_back(std::move(segment));
  }
  return segments;
}

}  // namespace

kw_status kw_curve_to_bezier(const kw_curve* curve, kw_bezier** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"curve", curve}, {"out", out}}, error, [&]() -> kw_status {
    auto made = std::make_unique<kw_bezier>();
    made->degree = curve->curve.degree();
    made->dim = curve->curve.dim();
    made->ends.push_back(curve->curve.u_min());
    for (const BezierSegment& segment : curves::to_bezier(curve->curve)) {
      made->ends.push_back(segment.u1);
      made->points.insert(made->points.end(), segment.points.begin(), segment.points.end());
      made->weights.insert(made->weights.end(), segment.weights.begin(), segment.weights.end());
    }
    *out = made.release();
    return KW_OK;
  });
}
void kw_bezier_free(kw_bezier* bezier) { delete bezier; }

size_t kw_bezier_segment_count(const kw_bezier* bezier) {
  return bezier ? bezier->ends.size() - 1 : 0;
}
int32_t kw_bezier_degree(const kw_bezier* bezier) { return bezier ? bezier->degree : 0; }
int32_t kw_bezier_dim(const kw_bezier* bezier) { return bezier ? bezier->dim : 0; }
const double* kw_bezier_ends(const kw_bezier* bezier, size_t* count) {
  return bezier ? lent(bezier->ends, count) : nothing_lent(count);
}
const double* kw_bezier_points(const kw_bezier* bezier, size_t* count) {
  return bezier ? lent(bezier->points, count) : nothing_lent(count);
}
const double* kw_bezier_weights(const kw_bezier* bezier, size_t* count) {
  return bezier ? lent(bezier->weights, count) : nothing_lent(count);
}

kw_status kw_curve_from_bezier(int32_t degree, int32_t dim, const double* ends, size_t ends_count,
                               const double* points, size_t points_count, const double* weights,
                               size_t weights_count, double join_tolerance, kw_curve** out,
                               kw_error** error) {
  return make_curve({array("ends", ends, ends_count), array("points", points, points_count),
                     array("weights", weights, weights_count)},
                    out, error, [&]() -> Result<curves::NurbsCurve> {
                      const auto segments =
                          segments_of(degree, dim,
                                      {numbers(ends, ends_count), numbers(points, points_count),
                                       numbers(weights, weights_count)});
                      if (!segments) return segments.error();
                      return curves::from_bezier(*segments, join_tolerance);
                    });
}
