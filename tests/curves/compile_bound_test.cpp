// SPDX-License-Identifier: MIT
// CurveProgram::max_error() is a bound: searched for a violation where curves are worst, weights a
// million to one apart, time and value that stand still at the ends.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"

#include "curves/random_curves.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {
using testing::Draws;
using testing::made;

using Wide = __float128;

/// One Bézier segment in quadruple precision: 113 bits of convex blends.
class Segment {
 public:
  explicit Segment(const NurbsCurve& curve) : curve_(curve) {}

  Wide value(int coordinate, Wide t) const {
    return blended(t, coordinate) / blended(t, curve_.dim());
  }
  /// Where a coordinate that never goes back is x; the last place where it stands still.
  Wide parameter(Wide x) const {
    Wide low = 0, high = 1;
    for (int step = 0; step < 400 && high - low > high * Wide(0x1p-110); ++step) {
      const Wide middle = (low + high) / 2;
      // The sign from what is left of the points by x: without the cancelling of a quotient.
      (ahead(x, middle) <= 0 ? low : high) = middle;
    }
    return (low + high) / 2;
  }

 private:
  Wide blended(Wide t, int row) const {
    Wide b[kMaxDegree + 1] = {};
    for (int i = 0; i <= curve_.degree(); ++i) {
      const Wide w = curve_.weights()[std::size_t(i)];
      const std::size_t at = std::size_t(i * curve_.dim() + row);
      b[i] = row == curve_.dim() ? w : w * curve_.points()[at];
    }
    return casteljau(b, t);
  }
  Wide ahead(Wide x, Wide t) const {
    Wide b[kMaxDegree + 1] = {};
    for (int i = 0; i <= curve_.degree(); ++i) {
      const auto k = std::size_t(i);
      b[i] = Wide(curve_.weights()[k]) * (Wide(curve_.points()[k * std::size_t(curve_.dim())]) - x);
    }
    return casteljau(b, t);
  }
  Wide casteljau(Wide* b, Wide t) const {
    for (int level = curve_.degree(); level > 0; --level) {
      for (int i = 0; i < level; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
    }
    return b[0];
  }

  const NurbsCurve& curve_;
};

double distance(Wide a, double b) {
  const Wide d = a - Wide(b);
  return static_cast<double>(d < 0 ? -d : d);
}

/// One segment on [0, 1] with weights up to `decades` of ten from 1.
struct Hostile {
  int degree;
  int dim = 1;
  double decades = 0;
};

double weight_of(Draws& draw, double decades) {
  const double power = draw.chance(0.5)   ? draw.between(-decades, decades)
                       : draw.chance(0.5) ? decades
                                          : -decades;
  return std::clamp(std::pow(10.0, power), kMinWeight, kMaxWeight);
}

NurbsCurve hostile_curve(Draws& draw, const Hostile& kind) {
  CurveSpec spec;
  spec.name = "hostile";
  spec.degree = kind.degree;
  spec.dim = kind.dim;
  const int n = kind.degree + 1;
  const double unit = kind.dim == 2 ? 1 : std::pow(10.0, draw.whole(-3, 6));
  // Time stands still at the start, at the end or nowhere.
  const int first = draw.chance(0.5) ? draw.whole(0, kind.degree) : 0;
  const int last = draw.chance(0.5) ? draw.whole(0, kind.degree - first) : 0;
  double x = draw.chance(0.5) ? 0 : draw.between(-1, 1);
  for (int i = 0; i < n; ++i) {
    if (i > first && i < n - last) x += draw.chance(0.2) ? 0 : draw.unit();
    if (kind.dim == 2) spec.points.push_back(x);
    const double y = draw.chance(0.4) ? draw.whole(-1, 1) : draw.between(-1, 1);
    spec.points.push_back(unit * y);
    if (kind.decades > 0) spec.weights.push_back(weight_of(draw, kind.decades));
  }
  if (kind.dim == 2 && spec.points[std::size_t(2 * kind.degree)] <= spec.points[0]) {
    spec.points[std::size_t(2 * kind.degree)] = spec.points[0] + 1;
  }
  return made(std::move(spec));
}

/// Places in (0, 1), ever nearer to both ends.
double near_an_end(Draws& draw) {
  const double gap = std::pow(2.0, -draw.between(0, 53));
  return draw.chance(0.5) ? gap : 1 - gap;
}

struct Found {
  double of_bound = 0;  ///< largest error over max_error()
  double error = 0;
  double u = 0;
};

/// Looks for the largest error: near both ends of the domain and of pieces, then around the
/// largest.
template <class Error>
Found search(Draws& draw, const CurveProgram& program, double start, double width,
             const Error& error_at) {
  Found found;
  const auto look = [&](double u) {
    if (!(u >= program.u_min() && u <= program.u_max())) return;
    const double error = error_at(u);
    if (!(error <= found.error)) found = {error / program.max_error(), error, u};
  };
  for (int k = 0; k < 60; ++k) {
    const double place = k < 45 ? near_an_end(draw) : draw.unit();
    look(start + place * width);
  }
  for (int k = 0; k < 30; ++k) {
    const int piece = draw.whole(0, program.piece_count() - 1);
    const double a = program.breaks()[std::size_t(piece)];
    const double b = program.breaks()[std::size_t(piece) + 1];
    const double t = k < 15 ? draw.unit() : near_an_end(draw);
    look(a + t * (b - a));
    if (k % 5 == 0) look(std::nextafter(b, a));
  }
  for (double step = 0.25; step > 1e-9; step *= 0.6) {
    const double u = found.u, reach = step * std::min(u - start, start + width - u);
    look(u - reach);
    look(u + reach);
  }
  return found;
}

struct Tally {
  int compiled = 0;
  int refused = 0;
  double worst = 0;
};

CompileOptions random_options(Draws& draw, double largest) {
  CompileOptions options;
  options.max_error = draw.chance(0.3) ? 1e-7 : std::pow(10.0, -draw.between(2, 11)) * largest;
  return options;
}

void judge(const Found& found, const CurveProgram& program, int index, Tally& tally) {
  tally.worst = std::max(tally.worst, found.of_bound);
  EXPECT_LE(found.error, program.max_error())
      << "curve " << index << " is " << found.of_bound << " of the bound at " << found.u;
}

void count_refused(const Error& error, Tally& tally) {
  EXPECT_EQ(error.code, ErrorCode::error_bound_missed) << error.message;
  ++tally.refused;
}

/// Programs of one coordinate by u: exact where the degree allows, and the polynomial form.
Tally tally_of_parameters(int count) {
  const std::uint64_t seed = support::test_seed();
  Tally tally;
  for (int i = 0; i < count; ++i) {
    Draws draw(seed + 101, i);
    Hostile kind{draw.whole(1, 15)};
    kind.decades = draw.chance(0.2) ? 0 : draw.between(0, 6);
    const NurbsCurve curve = hostile_curve(draw, kind);
    const double largest =
        *std::max_element(curve.points().begin(), curve.points().end(),
                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    const CompileOptions options = random_options(draw, std::max(std::abs(largest), 1e-3));
    const auto program =
        i % 2 == 0 ? compile_function(curve, options) : compile_polynomial(curve, options);
    if (!program) {
      count_refused(program.error(), tally);
      continue;
    }
    ++tally.compiled;
    EXPECT_LE(program->max_error(), options.max_error);
    const Segment segment(curve);
    const auto error = [&](double u) { return distance(segment.value(0, u), program->at_u(u)); };
    judge(search(draw, *program, 0, 1, error), *program, i, tally);
  }
  return tally;
}

Tally tally_of_times(int count) {
  const std::uint64_t seed = support::test_seed();
  Tally tally;
  for (int i = 0; i < count; ++i) {
    Draws draw(seed + 103, i);
    Hostile kind{draw.chance(0.7) ? draw.whole(2, 7) : draw.whole(8, 15), 2};
    kind.decades = draw.chance(0.5) ? 0 : draw.between(0, 6);
    const NurbsCurve curve = hostile_curve(draw, kind);
    CompileOptions options = random_options(draw, 1);
    const auto program = compile_function(curve, options);
    if (!program) {
      if (program.error().code != ErrorCode::empty_domain) count_refused(program.error(), tally);
      continue;
    }
    ++tally.compiled;
    EXPECT_LE(program->max_error(), options.max_error);
    const Segment segment(curve);
    const auto error = [&](double x) {
      return distance(segment.value(1, segment.parameter(x)), program->at_u(x));
    };
    // By time, and by the curve's own parameter: what is far out in one is near in the other.
    const double width = program->u_max() - program->u_min();
    Found found = search(draw, *program, program->u_min(), width, error);
    for (int k = 0; k < 40; ++k) {
      const double x = static_cast<double>(segment.value(0, near_an_end(draw)));
      if (!(x > program->u_min() && x < program->u_max())) continue;
      const double apart = error(x);
      if (apart > found.error) found = {apart / program->max_error(), apart, x};
    }
    judge(found, *program, i, tally);
  }
  return tally;
}

void print(const char* what, const Tally& tally) {
  std::printf("%s: %d compiled, %d refused, at worst %.4f of the bound\n", what, tally.compiled,
              tally.refused, tally.worst);
}

/// A program is within what it says at parameters ever nearer to 0 or to 1.
void expect_bound_near_an_end(const Result<CurveProgram>& program, const NurbsCurve& curve,
                              bool at_start) {
  ASSERT_TRUE(program) << program.error().message;
  double worst = 0;
  for (int k = 0; k <= 20'000; ++k) {
    const double gap = std::pow(10.0, -16.0 * k / 20'000);
    const double u = at_start ? gap : 1 - gap;
    double y;
    curve.evaluate(u, {&y, 1});
    worst = std::max(worst, std::abs(program->at_u(u) - y));
  }
  EXPECT_LE(worst, program->max_error());
  EXPECT_LE(program->max_error(), 1e-3);
}

// A sum of powers that cancels 12 digits at u = 1: one piece would be 1.4e-3 off.
TEST(CompileBound, ExactSpansAreCutWhereTheirWeightsCancel) {
  const NurbsCurve curve = testing::rational(
      {-1.0, 1.0, 0.0, 0.37311962607173466, 0.0, -1.0, -1.0},
      {1000000.0, 279243.9887895889, 370.0439350600971, 1e-06, 133259.1728986281, 1000000.0, 1e-06},
      6);
  for (const auto& program : {compile_parametric(curve), compile_function(curve)}) {
    expect_bound_near_an_end(program, curve, false);
    EXPECT_GT(program->piece_count(), 1);
    EXPECT_LE(program->max_error(), 1e-7);
  }
  const double u = 0.9999999999998368;
  const FastProgram fast(*compile_parametric(curve));
  float y;
  CurveCursor cursor;
  fast.render(GridRun{u, 0, 0}, {&y, 1}, cursor);
  EXPECT_LE(distance(Segment(curve).value(0, u), y), fast.max_error());
}

TEST(CompileBound, ABumpBeforeTheFirstLookIsSeenByThePolynomialForm) {
  std::vector<double> points(16), weights(16, 1e6);
  points[1] = 1;
  weights[0] = 1e-6;
  weights[1] = 2.5e-3;
  const NurbsCurve tall = testing::rational(points, weights, 15);
  expect_bound_near_an_end(compile_polynomial(tall), tall, true);
  const NurbsCurve low = testing::rational({0, 1, 0}, {1e-6, 1, 1e6}, 2);
  expect_bound_near_an_end(compile_polynomial(low, {1e-3, 4096, {}}), low, true);
}

// x(u) = u^15 and a bump at u = 1/15, a time of 2e-18, with weights that bring it nearer still.
TEST(CompileBound, ABumpBeforeTheFirstLookIsSeenInTime) {
  for (const auto& [asked, weight] : {std::pair{1e-7, 10.0}, {1e-7, 100.0}, {1e-3, 1.0}}) {
    CurveSpec spec;
    spec.name = "bump";
    spec.degree = 15;
    spec.dim = 2;
    for (int i = 0; i < 16; ++i) {
      spec.points.insert(spec.points.end(), {i == 15 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0});
      spec.weights.push_back(i < 2 ? 1 : weight);
    }
    const NurbsCurve curve = made(std::move(spec));
    const auto program = compile_function(curve, {asked, 4096, {}});
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_LE(program->max_error(), asked);
    const Segment segment(curve);
    for (int k = 1; k < 200; ++k) {
      const double x = static_cast<double>(segment.value(0, k / 200.0));
      EXPECT_LE(distance(segment.value(1, segment.parameter(x)), program->at_u(x)),
                program->max_error())
          << weight << " at " << x;
    }
  }
}

// More than one look in six found: 4 % had been added to what was seen.
TEST(CompileBound, ArchesOfLooseFitsAreNotHigherThanTheProgramSays) {
  CurveSpec spec;
  spec.name = "loose";
  spec.degree = 3;
  spec.points = {0.908372929156867, 0.1346774598538918, 0.939712774875828, -0.6531503562813428};
  spec.weights = {0.8760009784810251, 0.0011226982819831752, 0.02533956331930297,
                  181.70296310706144};
  const NurbsCurve curve = made(std::move(spec));
  const auto program = compile_polynomial(curve, {0.22006635453578796, 4096, {}});
  ASSERT_TRUE(program) << program.error().message;
  double worst = 0;
  for (int k = 0; k <= 100'000; ++k) {
    double y;
    curve.evaluate(k / 1e5, {&y, 1});
    worst = std::max(worst, std::abs(program->at_u(k / 1e5) - y));
  }
  EXPECT_LE(worst, program->max_error());
  EXPECT_GE(worst, 0.95 * program->max_error());
}

// Powers of u cancel 20 digits at u = 1, where time stands still to order 4.
TEST(CompileBound, AnEndWhoseWeightsCancelIsCutInTimeToo) {
  const double x = 0.53871647947010903, low = 1.9364128238831503e-06, high = 516418.80680931878;
  CurveSpec spec;
  spec.name = "hostile";
  spec.degree = 13;
  spec.dim = 2;
  spec.points = {0, 0.6, 0, 0.6, 0, 0.6,  0, 1,    0, 0.24,  0, -0.24, 0, -0.57,
                 0, 1,   0, 0.2, 0, -0.5, x, 0.83, x, -0.18, x, -0.07, x, 0};
  spec.weights = {low, 1787, high, 2.4, high, 0.0025, high, 191411, low, low, low, high, low, low};
  const NurbsCurve curve = made(std::move(spec));
  const auto program = compile_function(curve);
  ASSERT_TRUE(program) << program.error().message;
  const Segment segment(curve);
  for (double now = x, k = 0; k < 40; now = std::nextafter(now, 0), ++k) {
    EXPECT_LE(distance(segment.value(1, segment.parameter(now)), program->at_u(now)),
              program->max_error());
  }
}

TEST(CompileBound, OneWeightForAllPointsIsNone) {
  const std::vector<double> points{1, -2, 3, 5, 0.5};
  for (const int degree : {1, 2, 3, 4}) {
    const auto plain = compile_parametric(testing::line(points, degree));
    const auto same = compile_parametric(testing::rational(points, {3, 3, 3, 3, 3}, degree));
    ASSERT_TRUE(plain && same);
    for (double u = 0; u <= 1; u += 0.01) EXPECT_EQ(same->at_u(u), plain->at_u(u)) << degree;
    EXPECT_EQ(same->piece_count(), plain->piece_count());
  }
}

TEST(CompileBound, NoHostileCurveOfOneCoordinateIsFartherThanTheProgramSays) {
  const Tally tally = tally_of_parameters(support::test_count(400));
  print("by u", tally);
  EXPECT_GT(tally.compiled, 9 * tally.refused);
  EXPECT_GT(tally.worst, 0.9) << "a bound that is never nearly reached is too wide";
}

TEST(CompileBound, NoHostileCurveInTimeIsFartherThanTheProgramSays) {
  const Tally tally = tally_of_times(support::test_count(30));
  print("by time", tally);
  EXPECT_EQ(tally.refused, 0);
  EXPECT_GT(tally.worst, 0.9) << "a bound that is never nearly reached is too wide";
}

TEST(CompileBoundStress, NoHostileCurveIsFartherThanTheProgramSays) {
  print("by u", tally_of_parameters(support::test_count(20'000)));
  const Tally times = tally_of_times(support::test_count(5'000));
  print("by time", times);
  EXPECT_EQ(times.refused, 0);
}

}  // namespace
}  // namespace knotwave::curves
