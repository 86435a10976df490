// SPDX-License-Identifier: MIT
#include "fuzz_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "knotwave/base/index.h"

namespace knotwave::fuzz {
namespace {

using base::index_of;
using curves::CurveSpec;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::Side;
using curves::SurfaceSpec;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double step(ByteReader& bytes) {
  switch (bytes.below(6)) {
    case 0:
      return 0;
    case 1:
      return std::ldexp(1.0, -bytes.byte());
    case 2:
      return std::abs(bytes.number());
    default:
      return (1 + bytes.byte()) / 16.0;
  }
}

/// Non-decreasing where the bytes are kind: steps, and p + 1 equal ones at clamped ends.
std::vector<double> knots_from(ByteReader& bytes, int degree, int count, bool periodic) {
  const int kind = bytes.below(4);
  if (kind == 0) return {};
  const int total = periodic ? count + 1 : count + degree + 1;
  std::vector<double> knots;
  double u = bytes.number();
  for (int i = 0; i < total; ++i) {
    const bool clamped = kind != 1 && !periodic && (i <= degree || i > count);
    if (i > 0 && (!clamped || i == count)) u += step(bytes);
    knots.push_back(u);
  }
  if (bytes.one_in(32)) knots[index_of(bytes.below(total))] = bytes.number();
  return knots;
}

double weight(ByteReader& bytes) {
  return bytes.one_in(8) ? bytes.number() : std::pow(10, 12 * bytes.part() - 6);
}

void check_values(const NurbsCurve& curve, double u) {
  double low[curves::kMaxDim], high[curves::kMaxDim], out[curves::kMaxDim];
  const int dim = curve.dim();
  for (int c = 0; c < dim; ++c) low[c] = kInfinity, high[c] = -kInfinity;
  for (std::size_t i = 0; i < curve.points().size(); ++i) {
    const auto c = i % std::size_t(dim);
    low[c] = std::min(low[c], curve.points()[i]);
    high[c] = std::max(high[c], curve.points()[i]);
  }
  for (const Side side : {Side::left, Side::right}) {
    curve.evaluate(u, side, out);
    for (int c = 0; c < dim; ++c) FUZZ_CHECK(low[c] <= out[c] && out[c] <= high[c]);
  }
}

// In no more than `most` steps, the ends among them.
std::vector<double> spread(std::span<const double> all, std::size_t most) {
  std::vector<double> some;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / most);
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  if (!all.empty()) some.push_back(all.back());
  return some;
}

std::vector<double> places_of(std::span<const double> a, std::span<const double> b, double low,
                              double high) {
  std::vector<double> places = spread(a, 5);
  const std::vector<double> more = spread(b, 7);
  places.insert(places.end(), more.begin(), more.end());
  std::sort(places.begin(), places.end());
  for (std::size_t i = places.size(); i > 1; --i) {
    places.push_back(places[i - 2] + 0.375 * (places[i - 1] - places[i - 2]));
  }
  for (double& u : places) u = std::clamp(u, low, high);
  return places;
}

}  // namespace

double ulp_of(double x) {
  return std::max(std::nextafter(std::abs(x), kInfinity) - std::abs(x), 0x1p-1000);
}

double largest_coordinate(std::span<const double> points) {
  double largest = 0;
  for (const double x : points) largest = std::max(largest, std::abs(x));
  return largest;
}

double ulp_of(const NurbsCurve& curve) { return ulp_of(largest_coordinate(curve.points())); }

std::optional<NurbsCurve> curve_from(ByteReader& bytes) {
  CurveSpec spec;
  spec.name = "fuzz";
  spec.degree = bytes.one_in(64) ? bytes.byte() - 8 : 1 + bytes.below(curves::kMaxDegree);
  spec.dim = 1 + bytes.below(curves::kMaxDim);
  if (bytes.one_in(2)) spec.dim = 1;
  spec.periodic = bytes.one_in(4);
  const int count = std::clamp(spec.degree, 1, curves::kMaxDegree) + 1 + bytes.below(9);
  const bool weights = bytes.one_in(2);
  const bool all_jumps = bytes.one_in(4);
  spec.knots =
      knots_from(bytes, std::clamp(spec.degree, 1, curves::kMaxDegree), count, spec.periodic);
  for (int i = 0; i < count * spec.dim; ++i) spec.points.push_back(bytes.number());
  for (int i = 0; weights && i < count; ++i) spec.weights.push_back(weight(bytes));
  for (std::size_t i = 0; all_jumps && i + std::size_t(spec.degree) < spec.knots.size(); ++i) {
    const double knot = spec.knots[i];
    if (knot == spec.knots.front() || knot == spec.knots.back()) continue;
    if (knot == spec.knots[i + std::size_t(spec.degree)]) spec.jumps.push_back(knot);
  }
  auto curve = NurbsCurve::create(std::move(spec));
  if (!curve) {
    FUZZ_CHECK(curve.error().message.find("'fuzz'") != std::string::npos);
    return std::nullopt;
  }
  check_curve(*curve);
  return std::move(*curve);
}

std::optional<NurbsSurface> surface_from(ByteReader& bytes) {
  SurfaceSpec spec;
  spec.name = "fuzz";
  spec.degree_u = 1 + bytes.below(7);
  spec.degree_v = 1 + bytes.below(7);
  spec.dim = 1 + bytes.below(curves::kMaxDim);
  spec.periodic_u = bytes.one_in(4);
  spec.count_u = spec.degree_u + 1 + bytes.below(5);
  spec.count_v = spec.degree_v + 1 + bytes.below(5);
  const bool weights = bytes.one_in(2);
  spec.knots_u = knots_from(bytes, spec.degree_u, spec.count_u, spec.periodic_u);
  spec.knots_v = knots_from(bytes, spec.degree_v, spec.count_v, false);
  const int count = spec.count_u * spec.count_v;
  for (int i = 0; i < count * spec.dim; ++i) spec.points.push_back(bytes.number());
  for (int i = 0; weights && i < count; ++i) spec.weights.push_back(weight(bytes));
  auto surface = NurbsSurface::create(std::move(spec));
  if (!surface) {
    FUZZ_CHECK(surface.error().message.find("'fuzz'") != std::string::npos);
    return std::nullopt;
  }
  check_surface(*surface);
  return std::move(*surface);
}

double place_in(ByteReader& bytes, std::span<const double> knots, double low, double high) {
  const double knot = knots[index_of(bytes.byte()) % knots.size()];
  switch (bytes.below(4)) {
    case 0:
      return std::clamp(knot, low, high);
    case 1:
      return std::clamp(std::nextafter(knot, bytes.one_in(2) ? -kInfinity : kInfinity), low, high);
    default: {
      const double x = bytes.part();
      return std::clamp(low + x * (high - low), low, high);
    }
  }
}

void check_curve(const NurbsCurve& curve) {
  FUZZ_CHECK(curve.u_min() < curve.u_max());
  const auto again = NurbsCurve::create(curve.spec());
  if (!again) std::fprintf(stderr, "%s\n", again.error().message.c_str());
  FUZZ_CHECK(again);
  FUZZ_CHECK(*again == curve);
  const double width = curve.u_max() - curve.u_min();
  for (const double x : {-0.5, 0.0, 0.3125, 0.5, 0.875, 1.0, 1.5, double(NAN), kInfinity}) {
    check_values(curve, curve.u_min() + x * width);
  }
  check_values(curve, curve.knots()[curve.knots().size() / 2]);
}

void check_surface(const NurbsSurface& surface) {
  const auto again = NurbsSurface::create(surface.spec());
  if (!again) std::fprintf(stderr, "%s\n", again.error().message.c_str());
  FUZZ_CHECK(again);
  FUZZ_CHECK(*again == surface);
  const double largest = largest_coordinate(surface.points());
  const double width = surface.u_max() - surface.u_min();
  const double height = surface.v_max() - surface.v_min();
  for (const double x : {-0.5, 0.0, 0.375, 1.0, double(NAN)}) {
    for (const double y : {0.0, 0.625, 1.0, kInfinity}) {
      double out[curves::kMaxDim];
      surface.evaluate(surface.u_min() + x * width, surface.v_min() + y * height, out);
      for (int c = 0; c < surface.dim(); ++c) FUZZ_CHECK_AT_MOST(std::abs(out[c]), largest);
    }
  }
}

void check_refusal(const Error& error, std::initializer_list<ErrorCode> named) {
  const bool known = std::find(named.begin(), named.end(), error.code) != named.end();
  if (!known) std::fprintf(stderr, "%s\n", error.to_string().c_str());
  FUZZ_CHECK(known);
  FUZZ_CHECK(!error.message.empty());
}

void check_same(const NurbsCurve& curve, const NurbsCurve& edited, double low, double high,
                double tolerance) {
  FUZZ_CHECK(curve.dim() == edited.dim());
  double a[curves::kMaxDim], b[curves::kMaxDim];
  for (const double u : places_of(curve.knots(), edited.knots(), low, high)) {
    for (const Side side : {Side::left, Side::right}) {
      const bool beyond = (u == low && side == Side::left) || (u == high && side == Side::right);
      if (beyond) continue;
      curve.evaluate(u, side, a);
      edited.evaluate(u, side, b);
      for (int c = 0; c < curve.dim(); ++c) FUZZ_CHECK_AT_MOST(std::abs(a[c] - b[c]), tolerance);
    }
  }
}

void check_same(const NurbsSurface& surface, const NurbsSurface& edited, double tolerance) {
  FUZZ_CHECK(surface.dim() == edited.dim());
  const double u_low = std::max(surface.u_min(), edited.u_min());
  const double u_high = std::min(surface.u_max(), edited.u_max());
  const double v_low = std::max(surface.v_min(), edited.v_min());
  const double v_high = std::min(surface.v_max(), edited.v_max());
  double a[curves::kMaxDim], b[curves::kMaxDim];
  for (const double x : {0.0, 0.25, 0.625, 0.9375}) {
    for (const double y : {0.0, 0.375, 0.75, 1.0}) {
      const double u = u_low + x * (u_high - u_low), v = v_low + y * (v_high - v_low);
      surface.evaluate(u, v, a);
      edited.evaluate(u, v, b);
      for (int c = 0; c < surface.dim(); ++c) FUZZ_CHECK_AT_MOST(std::abs(a[c] - b[c]), tolerance);
    }
  }
}

}  // namespace knotwave::fuzz
