// SPDX-License-Identifier: MIT
// Curves whose time stands still to a high order. Time is a polynomial with whole coefficients, so
// its control points are doubles exactly, it stands still exactly, and the oracle starts from there
// in quadruple precision.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/compile.h"

#include "curves/random_curves.h"
#include "curves/time_oracle.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {
using testing::Draws;
using testing::line;
using testing::made;

using Wide = __float128;
using Whole = __int128;
using Powers = std::vector<Whole>;  // of n, power 0 first

Powers product(const Powers& a, const Powers& b) {
  Powers c(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  }
  return c;
}

Powers power(const Powers& a, int exponent) {
  Powers result{1};
  for (int i = 0; i < exponent; ++i) result = product(result, a);
  return result;
}

/// a(from + s) by powers of s.
Powers shifted(Powers a, int from) {
  for (std::size_t start = 0; start + 1 < a.size(); ++start) {
    for (std::size_t k = a.size() - 1; k-- > start;) a[k] += a[k + 1] * from;
  }
  return a;
}

Whole common_multiple_to(int n) {
  Whole multiple = 1;
  for (int i = 2; i <= n; ++i) multiple = multiple / std::gcd(long(multiple % i), long(i)) * i;
  return multiple;
}

/// An antiderivative that is 0 at n = `from`, times a whole number.
Powers antiderivative(const Powers& a, int from) {
  const Whole multiple = common_multiple_to(static_cast<int>(a.size()));
  Powers sum{0};
  for (std::size_t k = 0; k < a.size(); ++k) sum.push_back(a[k] * multiple / Whole(k + 1));
  sum[0] = -shifted(sum, from)[0];
  return sum;
}

/// Elementary symmetric sums of `knots`: what the k-th power's blossom is, times C(p, k).
Powers symmetric_sums(std::span<const int> knots) {
  Powers sums{1};
  for (const int knot : knots) sums = product(sums, {1, knot});
  return sums;
}

/// Control points of a polynomial on a knot vector of whole numbers, times a whole number.
Powers control_points(const Powers& a, std::span<const int> knots, int degree) {
  Whole multiple = 1;
  Powers choose{1};
  for (int k = 0; k < degree; ++k) {
    choose.push_back(choose.back() * (degree - k) / (k + 1));
    multiple = multiple / std::gcd(long(multiple), long(choose.back())) * choose.back();
  }
  Powers points;
  for (std::size_t i = 0; i + std::size_t(degree) + 1 < knots.size(); ++i) {
    const Powers sums = symmetric_sums(knots.subspan(i + 1, std::size_t(degree)));
    Whole point = 0;
    for (std::size_t k = 0; k < a.size(); ++k) point += a[k] * sums[k] * (multiple / choose[k]);
    points.push_back(point);
  }
  return points;
}

double size_of(Whole x) { return std::abs(static_cast<double>(x)); }

/// Time stands still at n = flats[0], there it is `x0`; with weights at the others it need not.
struct Flat {
  NurbsCurve curve;
  Powers time;  // by n, 0 at flats[0], of the numerator
  std::vector<int> flats;
  double scale = 1;  // x = x0 + scale * time / weight
  double x0 = 0;
  int parts = 1;  // u = n, or n / parts
  bool is_unit = false;
};

/// de Boor in quadruple precision; row 2 is the weight alone.
Wide blended(const Flat& flat, Wide u, int row) {
  const NurbsCurve& curve = flat.curve;
  const int p = curve.degree();
  const auto knot = [&](int i) { return Wide(curve.knots()[std::size_t(i)]); };
  const int span = find_span(curve.knots(), p, static_cast<double>(u), Side::right);
  Wide d[kMaxDegree + 1];
  for (int j = 0; j <= p; ++j) {
    const auto i = std::size_t(span - p + j);
    d[j] = Wide(curve.weights()[i]);
    if (row < 2) d[j] *= Wide(curve.points()[2 * i + std::size_t(row)]);
  }
  for (int level = 1; level <= p; ++level) {
    for (int j = p; j >= level; --j) {
      const int i = span - p + j;
      const Wide low = knot(i), high = knot(i + p + 1 - level);
      d[j] = ((high - u) * d[j - 1] + (u - low) * d[j]) / (high - low);
    }
  }
  return d[p];
}

/// y at time x: from the flat place that is nearest in time, as nothing cancels there.
class Oracle {
 public:
  explicit Oracle(const Flat& flat) : flat_(flat) {
    for (const int n : flat.flats) {
      const Powers powers = shifted(flat.time, n);
      near_.emplace_back(powers.begin(), powers.end());
    }
  }

  double time_of(std::size_t k) const {
    return flat_.x0 + flat_.scale * static_cast<double>(near_[k][0]);
  }
  double error(double x, double y) const {
    const Wide u = parameter(x);
    const Wide apart = blended(flat_, u, 1) / blended(flat_, u, 2) - Wide(y);
    return static_cast<double>(apart < 0 ? -apart : apart);
  }

 private:
  Wide u_of(std::size_t k, Wide s) const {
    const Wide n = Wide(flat_.flats[k]) + s;
    return flat_.is_unit ? n / Wide(flat_.parts) : n;
  }
  Wide parameter(double x) const {
    std::size_t k = 0;
    for (std::size_t i = 1; i < near_.size(); ++i) {
      if (std::abs(x - time_of(i)) < std::abs(x - time_of(k))) k = i;
    }
    const bool is_plain = near_.size() > 1;  // without weights
    // Of a time near 0 nothing is left when it is told from elsewhere.
    const Wide origin = Wide(flat_.x0) + Wide(flat_.scale) * near_[k][0];
    const Wide gap = (Wide(x) - origin) / Wide(flat_.scale);
    const auto ahead = [&](Wide s) {
      Wide sum = 0;
      for (std::size_t j = near_[k].size(); j-- > 1;) sum = (sum + near_[k][j]) * s;
      return sum - gap * (is_plain ? Wide(1) : blended(flat_, u_of(k, s), 2));
    };
    if (gap == 0) return u_of(k, 0);
    // s runs away from the flat place.
    const Wide sign = gap > 0 ? 1 : -1;
    Wide high = gap > 0 ? flat_.parts - flat_.flats[k] : flat_.flats[k];
    const auto is_before = [&](Wide s) { return sign * ahead(sign * s) < 0; };
    for (int step = 0; step < 400 && !is_before(high / 2); ++step) high /= 2;
    Wide low = high / 2;
    for (int step = 0; step < 106; ++step) {
      const Wide middle = (low + high) / 2;
      (is_before(middle) ? low : high) = middle;
    }
    return u_of(k, sign * low);
  }

  const Flat& flat_;
  std::vector<std::vector<Wide>> near_;
};

/// What random_flat() draws. Nothing where a control point is no double.
struct Plan {
  int degree = 5;
  int parts = 2;
  std::vector<int> flats{1};
  Powers speed;  // of time, by n
  std::vector<int> inner;
  bool is_unit = false;
  double x0 = 0;  // in units of time
  std::vector<double> weights;
  std::vector<double> values;
};

std::optional<Flat> flat_of(const Plan& plan) {
  const Powers time = antiderivative(plan.speed, plan.flats[0]);
  if (static_cast<int>(time.size()) > plan.degree + 1) return {};
  std::vector<int> knots(std::size_t(plan.degree + 1), 0);
  knots.insert(knots.end(), plan.inner.begin(), plan.inner.end());
  knots.insert(knots.end(), std::size_t(plan.degree + 1), plan.parts);
  Powers points = control_points(time, knots, plan.degree);
  // The whole number they came out times of.
  Whole factor = 0, largest = 0;
  for (const Whole x : points) {
    if (size_of(x) > 0x1p62) return {};
    factor = std::gcd(long(factor), long(x));
    largest = std::max(largest, x < 0 ? -x : x);
  }
  const Whole per_unit = control_points(Powers{1}, knots, plan.degree)[0];
  for (const Whole c : time) {
    if (size_of(c) * size_of(per_unit) > 0x1p62) return {};
    factor = std::gcd(long(factor), long(c * per_unit));
  }
  Flat flat{line({0, 1}, 1), {}, plan.flats, 1, 0, plan.parts, plan.is_unit};
  flat.scale = std::ldexp(1, -std::ilogb(static_cast<double>(largest / factor)));
  flat.x0 = plan.x0 == 0 ? 0 : flat.scale * std::floor(plan.x0 * size_of(largest / factor));
  for (const Whole c : time) {
    flat.time.push_back(c * per_unit / factor);
  }
  CurveSpec spec;
  spec.name = "flat";
  spec.degree = plan.degree;
  spec.dim = 2;
  spec.weights = plan.weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = plan.weights.empty() ? 1 : plan.weights[i];
    const Wide x = Wide(flat.x0) + Wide(points[i] / factor) * Wide(flat.scale) / Wide(weight);
    spec.points.push_back(static_cast<double>(x));
    if (Wide(spec.points.back()) != x) return {};
    spec.points.push_back(plan.values[i]);
  }
  for (const int n : knots) spec.knots.push_back(plan.is_unit ? double(n) / plan.parts : n);
  flat.curve = made(std::move(spec));
  return flat;
}

/// (2 u - 1)^p, or (parts u - n)^p, with y = u.
Flat plain_flat(int degree, double x0, int parts = 2, int n = 1) {
  Plan plan{degree, parts, {n}, power({-n, 1}, degree - 1)};
  plan.is_unit = true;
  plan.x0 = x0;
  for (int i = 0; i <= degree; ++i) plan.values.push_back(double(i) / degree);
  auto flat = flat_of(plan);
  EXPECT_TRUE(flat);
  return *flat;
}

/// Looks at times ever nearer to each flat one, on both sides, the doubles beside it among them.
double worst_of(const Flat& flat, const CurveProgram& program, Draws& draw, int looks) {
  const Oracle oracle(flat);
  double worst = 0;
  const auto look = [&](double x) {
    if (!(x >= program.u_min() && x <= program.u_max())) return;
    worst = std::max(worst, oracle.error(x, program.at_u(x)));
  };
  for (std::size_t k = 0; k < flat.flats.size(); ++k) {
    double up = oracle.time_of(k), down = up;
    for (int i = 0; i < 6; ++i) {
      look(up);
      look(down);
      up = std::nextafter(up, 1e9);
      down = std::nextafter(down, -1e9);
    }
    const double deepest = up == 0 || std::abs(oracle.time_of(k)) < 1e-9 ? 300 : 17;
    for (int i = 0; i < looks; ++i) {
      const double gap = std::pow(10.0, -draw.between(0, deepest));
      look(oracle.time_of(k) + gap);
      look(oracle.time_of(k) - gap);
    }
  }
  for (int i = 0; i < looks; ++i) {
    const int piece = draw.whole(0, program.piece_count() - 1);
    const double a = program.breaks()[std::size_t(piece)];
    const double b = program.breaks()[std::size_t(piece) + 1];
    look(a);
    look(a + draw.unit() * (b - a));
    look(std::nextafter(b, a));
  }
  return worst;
}

void expect_within(const Flat& flat, double asked) {
  SCOPED_TRACE(::testing::Message()
               << "degree " << flat.curve.degree() << ", x0 " << flat.x0 << ", asked " << asked);
  const auto program = compile_function(flat.curve, {asked, 4096, {}});
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_LE(program->max_error(), asked);
  Draws draw(support::test_seed(), flat.curve.degree());
  EXPECT_LE(worst_of(flat, *program, draw, 30), program->max_error());
}

TEST(CompileFlatTime, OddPowersOfTimeMeetEveryBoundAtEveryDouble) {
  for (const int degree : {3, 5, 7, 15}) {
    for (const double asked : {1e-4, 1e-7, 1e-9, 1e-11}) {
      expect_within(plain_flat(degree, 1), asked);
    }
  }
}

// Doubles are dense there: 10^-300 is a time of its own.
TEST(CompileFlatTime, TimeThatStandsStillAtZeroMeetsEveryBound) {
  for (const int degree : {3, 5, 15}) {
    for (const double asked : {1e-4, 1e-7, 1e-11}) expect_within(plain_flat(degree, 0), asked);
  }
}

TEST(CompileFlatTime, ThePlaceNeedNotBeADouble) {
  for (const double x0 : {0.0, 0.5, 1.0}) {
    for (const int n : {1, 2}) {
      expect_within(plain_flat(5, x0, 3, n), 1e-7);
      expect_within(plain_flat(7, x0, 3, n), 1e-7);
    }
  }
}

TEST(CompileFlatTime, AtAnEndOrAKnotToo) {
  for (const double x0 : {0.0, 1.0}) {
    for (const int n : {0, 2}) expect_within(plain_flat(9, x0, 2, n), 1e-7);
    for (const int times : {1, 3, 5}) {
      Plan plan{5, 2, {1}, power({-1, 1}, 4)};
      plan.x0 = x0;
      plan.inner.assign(std::size_t(times), 1);
      for (int i = 0; i <= 5 + times; ++i) plan.values.push_back(i % 3);
      const auto flat = flat_of(plan);
      ASSERT_TRUE(flat);
      expect_within(*flat, 1e-7);
    }
  }
}

/// Time (2 u - 1)^p + x0 - slope (2 u - 1), its points rounded: it goes back in the middle.
NurbsCurve dipping_curve(int degree, double x0, double slope) {
  CurveSpec spec;
  spec.name = "dip";
  spec.degree = degree;
  spec.dim = 2;
  for (int i = 0; i <= degree; ++i) {
    const double side = (degree - i) % 2 == 0 ? 1 : -1;
    spec.points.push_back(side + x0 - slope * (2.0 * i / degree - 1));
    spec.points.push_back(double(i) / degree);
  }
  return made(std::move(spec));
}

/// How far y is from that of the nearest place on the two branches where time goes on.
double error_of_branches(const NurbsCurve& curve, double x, double y) {
  const auto time = [&](Wide t) { return test::segment_at(curve.points(), 0, t); };
  const auto nearest = [&](Wide low, Wide high) {
    if (time(low) > Wide(x) || time(high) < Wide(x)) return 1.0;
    for (int step = 0; step < 110; ++step) {
      const Wide middle = (low + high) / 2;
      (time(middle) < Wide(x) ? low : high) = middle;
    }
    return std::abs(static_cast<double>(test::segment_at(curve.points(), 1, low) - Wide(y)));
  };
  const auto turn = [&](Wide from, Wide to) {  // from the middle to where time goes back no more
    for (int step = 0; step < 110; ++step) {
      const Wide middle = (from + to) / 2, beside = (to - from) * Wide(1e-6);
      const bool is_back =
          from < to ? time(middle + beside) < time(middle) : time(middle) < time(middle + beside);
      (is_back ? from : to) = middle;
    }
    return from;
  };
  return std::min(nearest(0, turn(0.5, 0)), nearest(turn(0.5, 1), 1));
}

TEST(CompileFlatTime, TimeThatGoesBackWithinRoundingCountsAsStandingStill) {
  for (const int degree : {5, 7}) {
    for (const double x0 : {0.0, 0.3, 1.0}) {
      for (const int exponent : {-52, -44, -40}) {
        const NurbsCurve curve = dipping_curve(degree, x0, std::ldexp(1, exponent));
        const auto program = compile_function(curve);
        ASSERT_TRUE(program) << program.error().message;
        Draws draw(support::test_seed(), exponent);
        for (int i = 0; i < 40; ++i) {
          const double gap = std::pow(10.0, -draw.between(0, 18));
          for (const double x : {x0 + gap, x0 - gap}) {
            EXPECT_LE(error_of_branches(curve, x, program->at_u(x)), program->max_error() + 1e-12)
                << degree << ", " << x0 << ", 2^" << exponent << " at " << x - x0;
          }
        }
      }
    }
  }
}

TEST(CompileFlatTime, MeetsTheClosedForm) {
  const auto program = compile_function(plain_flat(5, 0).curve);
  ASSERT_TRUE(program);
  const double half = program->u_max();  // u = 1
  for (int i = 0; i <= 60; ++i) {
    const double w = std::pow(2.0, -i);
    const double x = half * w * w * w * w * w;
    EXPECT_NEAR(program->at_u(x), 0.5 + 0.5 * w, 1e-7);
    EXPECT_NEAR(program->at_u(-x), 0.5 - 0.5 * w, 1e-7);
  }
  EXPECT_EQ(program->at_u(0), 0.5);
}

TEST(CompileFlatTime, TakesThePiecesThatCompileMdPrints) {
  const auto pieces = [](int degree, double x0) {
    const auto program = compile_function(plain_flat(degree, x0).curve);
    return program ? program->piece_count() : 0;
  };
  EXPECT_EQ(pieces(5, 1), 107);
  EXPECT_EQ(pieces(15, 1), 107);
  EXPECT_EQ(pieces(15, 0), 651);
}

std::optional<Flat> random_flat(Draws& draw) {
  Plan plan;
  plan.degree = draw.whole(5, draw.chance(0.7) ? 9 : 15);
  plan.parts = draw.whole(1, plan.degree > 9 ? 3 : 6);
  plan.is_unit = draw.chance(0.3);
  plan.flats = {draw.whole(0, plan.parts)};
  int left = plan.degree - 1;
  const bool is_rational = draw.chance(0.3);
  // An even power inside, any at the ends.
  const auto still_at = [&](int n, int most) {
    const bool inside = n > 0 && n < plan.parts;
    int order = draw.whole(2, std::max(2, most));
    if (inside) order &= ~1;
    left -= order;
    // Towards the end time must not go back.
    return n == plan.parts ? power({n, -1}, order) : power({-n, 1}, order);
  };
  plan.speed = still_at(plan.flats[0], left);
  if (left >= 2 && !is_rational && draw.chance(0.4)) {
    const int n = draw.whole(0, plan.parts);
    if (n != plan.flats[0]) {
      plan.speed = product(plan.speed, still_at(n, left));
      plan.flats.push_back(n);
    }
  }
  if (left >= 2 && draw.chance(0.3)) {
    plan.speed = product(plan.speed, {draw.whole(1, 9), draw.whole(0, 2), draw.whole(0, 3)});
  }
  plan.x0 = draw.chance(0.5) ? 0 : draw.between(-2, 2);
  if (!plan.is_unit) {
    for (int n = 1; n < plan.parts; ++n) {
      if (draw.chance(0.3)) plan.inner.insert(plan.inner.end(), std::size_t(draw.whole(1, 3)), n);
    }
  }
  const std::size_t count = std::size_t(plan.degree) + 1 + plan.inner.size();
  for (std::size_t i = 0; i < count; ++i) {
    plan.values.push_back(draw.chance(0.3) ? draw.whole(-1, 1) : draw.between(-1, 1));
    if (is_rational) plan.weights.push_back(std::ldexp(1, draw.whole(-1, 1)));
  }
  return flat_of(plan);
}

struct Tally {
  int compiled = 0;
  int refused = 0;
  double worst = 0;
};

Tally tally_of_flats(int count) {
  const std::uint64_t seed = support::test_seed();
  Tally tally;
  for (int i = 0; tally.compiled + tally.refused < count && i < 20 * count; ++i) {
    Draws draw(seed + 107, i);
    const auto flat = random_flat(draw);
    if (!flat) continue;
    const double asked = draw.chance(0.4) ? 1e-7 : std::pow(10.0, -draw.between(2, 11));
    const auto program = compile_function(flat->curve, {asked, 4096, {}});
    if (!program) {
      // Weights may send time back.
      if (program.error().code == ErrorCode::not_a_function && flat->curve.is_rational()) continue;
      std::printf("curve %d: %s\n", i, program.error().message.c_str());
      EXPECT_EQ(program.error().code, ErrorCode::error_bound_missed);
      ++tally.refused;
      continue;
    }
    ++tally.compiled;
    const double worst = worst_of(*flat, *program, draw, 30);
    tally.worst = std::max(tally.worst, worst / program->max_error());
    EXPECT_LE(worst, program->max_error())
        << "curve " << i << " is " << worst / program->max_error() << " of the bound, degree "
        << flat->curve.degree() << ", asked " << asked;
  }
  std::printf("%d compiled, %d refused, at worst %.4f of the bound\n", tally.compiled,
              tally.refused, tally.worst);
  return tally;
}

TEST(CompileFlatTime, NoHostileCurveIsFartherThanTheProgramSays) {
  const Tally tally = tally_of_flats(support::test_count(25));
  EXPECT_EQ(tally.refused, 0);
  EXPECT_GT(tally.worst, 0.9) << "a bound that is never nearly reached is too wide";
}

TEST(CompileFlatTimeStress, NoHostileCurveIsFartherThanTheProgramSays) {
  EXPECT_EQ(tally_of_flats(support::test_count(2'000)).refused, 0);
}

}  // namespace
}  // namespace knotwave::curves
