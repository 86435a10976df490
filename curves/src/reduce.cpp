// SPDX-License-Identifier: MIT
#include "knotwave/curves/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "curve_distance.h"
#include "knot_removal.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

Result<void> check_tolerance(const NurbsCurve& curve, double tolerance) {
  if (tolerance >= 0 && std::isfinite(tolerance)) return {};
  return fail(ErrorCode::value_out_of_range, "curve '" + curve.name() + "': a tolerance of " +
                                                 number_text(tolerance) +
                                                 " is not a number from 0 up");
}

bool within_limits(const HomogeneousPoint& point, int dim) {
  double x[kMaxDim];
  point.project(std::span(x).first(index_of(dim)));
  const auto good = [](double value) { return std::abs(value) <= kMaxCoordinate; };
  return std::all_of(x, x + dim, good) && point.w.hi >= kMinWeight && point.w.hi <= kMaxWeight;
}

HomogeneousPoint rounded(const HomogeneousPoint& point, int dim) {
  double x[kMaxDim];
  point.project(std::span(x).first(index_of(dim)));
  return HomogeneousPoint(std::span<const double>(x, index_of(dim)), point.w.hi);
}

// A curve on its way to fewer knots, measured against the one it was.
class Reduction {
 public:
  explicit Reduction(const NurbsCurve& curve)
      : now_(curve), rounded_(now_), pieces_(bezier_pieces(now_)), errors_(pieces_.size(), 0.0) {}

  // A removal not yet carried out.
  struct Step {
    HomogeneousCurve exact, rounded;
    std::vector<std::pair<std::size_t, double>> errors;  // piece, bound
    double error = 0;                                    // the largest of them
    int times = 0;
  };
  std::optional<Step> step(double u, int times, double tolerance) const;

  void take(Step step) {
    now_ = std::move(step.exact);
    rounded_ = std::move(step.rounded);
    for (const auto& [piece, error] : step.errors) errors_[piece] = error;
    removed_ += step.times;
  }

  double error() const { return *std::max_element(errors_.begin(), errors_.end()); }
  int removed() const { return removed_; }
  const HomogeneousCurve& curve() const { return now_; }
  Result<ReducedCurve> finish(const NurbsCurve& before) const;

 private:
  // False if a point would pass the limits.
  bool round_points(Step& step, KnotRun run) const;

  HomogeneousCurve now_, rounded_;
  std::vector<BezierPiece> pieces_;  // of the curve as given
  std::vector<double> errors_;       // a bound for each
  int removed_ = 0;
};

bool overlap(const BezierPiece& piece, Knot from, Knot to) {
  return piece.left < to && from < piece.right;
}

std::optional<Reduction::Step> Reduction::step(double u, int times, double tolerance) const {
  const KnotRun run = run_of(now_, u);
  if (run.spare < times) return std::nullopt;
  Step step{now_, {}, {}, 0, times};
  if (!remove_knots_of(step.exact, run, times)) return std::nullopt;
  if (!round_points(step, run)) return std::nullopt;
  // Points first + 1 .. last - 1 change (a jump's two ends are first + 1 and last - 1), and nothing
  // outside of the knots that carry them.
  const int p = now_.degree, first = run.last - p - times, last = run.last - run.times + times;
  const int end = std::max(last, run.last - p + 1) + p, knots = static_cast<int>(now_.knots.size());
  const Knot from = now_.knots[index_of(std::min(first + 1, run.last - p - 1))];
  const Knot to = now_.knots[index_of(std::min(end, knots - 1))];
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    bool touched = overlap(pieces_[i], from, to);
    for (const int period : {-1, 1}) {
      if (!now_.domain.periodic) break;
      touched = touched || overlap(pieces_[i], Knot{from.period + period, from.at},
                                   Knot{to.period + period, to.at});
    }
    if (!touched) continue;
    const BezierPiece part = piece_between(step.rounded, pieces_[i].left, pieces_[i].right);
    const double error = distance_bound(pieces_[i], part, now_.dim, tolerance);
    if (!(error <= tolerance)) return std::nullopt;
    step.errors.emplace_back(i, error);
    step.error = std::max(step.error, error);
  }
  return step;
}

bool Reduction::round_points(Step& step, KnotRun run) const {
  step.rounded = step.exact;
  const int first = run.last - now_.degree - step.times;
  for (int i = 0; i < static_cast<int>(step.exact.points.size()); ++i) {
    HomogeneousPoint& point = step.rounded.points[index_of(i)];
    const bool kept = !now_.domain.periodic && (i < first || i > run.last - step.times);
    if (kept) {
      point = rounded_.points[index_of(i <= first ? i : i + step.times)];
      continue;
    }
    if (!within_limits(point, now_.dim)) return false;
    point = rounded(point, now_.dim);
  }
  return true;
}

Result<ReducedCurve> Reduction::finish(const NurbsCurve& before) const {
  if (removed_ == 0) return ReducedCurve{before, 0, 0};
  CurveSpec spec = before.spec();
  spec.jumps.clear();
  for (const double jump : before.jumps()) {
    if (now_.multiplicity({0, jump}) > now_.degree) spec.jumps.push_back(jump);
  }
  now_.write_to(spec);
  auto curve = NurbsCurve::create(std::move(spec));
  if (!curve) return curve.error();
  return ReducedCurve{std::move(*curve), removed_, error()};
}

}  // namespace

Result<ReducedCurve> remove_knot(const NurbsCurve& curve, double u, int times, double tolerance) {
  if (auto good = check_tolerance(curve, tolerance); !good) return good.error();
  const std::string what = "curve '" + curve.name() + "': ";
  if (times < 0) {
    return fail(ErrorCode::value_out_of_range,
                what + "a knot cannot be removed " + std::to_string(times) + " times");
  }
  Reduction reduction(curve);
  if (run_of(reduction.curve(), u).spare == 0) {
    return fail(ErrorCode::parameter_out_of_range,
                what + "u = " + number_text(u) + " is no knot between " +
                    number_text(curve.u_min()) + " and " + number_text(curve.u_max()));
  }
  // As many at once as can be: one after another each would start from the noise of the one before.
  int at_once = times;
  while (at_once > 0) {
    at_once = std::min({at_once, times - reduction.removed(), run_of(reduction.curve(), u).spare});
    if (at_once == 0) break;
    auto step = reduction.step(u, at_once, tolerance);
    if (step) {
      reduction.take(std::move(*step));
    } else {
      --at_once;
    }
  }
  return reduction.finish(curve);
}

Result<ReducedCurve> remove_knots(const NurbsCurve& curve, double tolerance) {
  if (auto good = check_tolerance(curve, tolerance); !good) return good.error();
  Reduction reduction(curve);
  // What a removal cost when last looked at; others nearby may have made it dearer since.
  struct Candidate {
    double u = 0;
    double cost = 0;
    int seen_at = -1;  // removals done when it was looked at
  };
  std::vector<Candidate> candidates;
  const std::vector<double> knots = curve.spec().knots;
  for (const double u : knots) {
    if (!candidates.empty() && candidates.back().u == u) continue;
    if (u == curve.u_max() && curve.is_periodic()) continue;  // the seam, named by its start
    if (run_of(reduction.curve(), u).spare > 0) candidates.push_back({u, 0, -1});
  }
  while (!candidates.empty()) {
    const auto cheapest =
        std::min_element(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    auto step = reduction.step(cheapest->u, 1, tolerance);
    if (!step) {
      candidates.erase(cheapest);
      continue;
    }
    const bool still_cheapest =
        std::all_of(candidates.begin(), candidates.end(),
                    [&](const Candidate& c) { return step->error <= c.cost || &c == &*cheapest; });
    cheapest->cost = step->error;
    const bool just_seen = cheapest->seen_at == reduction.removed();
    cheapest->seen_at = reduction.removed();
    if (still_cheapest || just_seen) reduction.take(std::move(*step));
  }
  return reduction.finish(curve);
}

}  // namespace knotwave::curves
