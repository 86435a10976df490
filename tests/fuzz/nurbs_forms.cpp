// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/fit.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/svg_path.h"

#include "fuzz_shapes.h"
#include "nurbs_operations.h"

namespace knotwave::fuzz {
namespace {

using curves::CompileOptions;
using curves::CurveProgram;
using curves::NurbsCurve;
using curves::Side;
using enum ErrorCode;

constexpr std::initializer_list<ErrorCode> kCompileErrors = {
    not_a_function,     not_scalar,   error_bound_missed, control_conflict,
    value_out_of_range, empty_domain, unsupported};

// -100 dB in 64 pieces at most: what is worked on is small.
CompileOptions options_for(const NurbsCurve& curve) {
  CompileOptions options;
  options.max_error = 1e-5 * (1e-3 + largest_coordinate(curve.points()));
  options.max_pieces = 64;
  return options;
}

void check_controls_of(const CurveProgram& program, ByteReader& bytes) {
  if (program.control_count() == 0) return;
  const double moved = bytes.number();
  const double y = program.at_u(program.u_min() + bytes.part(), 0, {&moved, 1});
  FUZZ_CHECK(program.low() <= y && y <= program.high());
}

// Values in the hull, slopes numbers, blocks of any size the same bits; `nan` counts as the start.
void check_program(const CurveProgram& program, ByteReader& bytes) {
  const double width = program.u_max() - program.u_min();
  const curves::GridRun run{program.u_min() - width / 8, width / 32, 0};
  double whole[40], parts[40];
  for (int c = 0; c < program.dim(); ++c) {
    curves::CurveCursor cursor, other;
    program.render(run, whole, cursor, c);
    const int cut = bytes.below(39) + 1;
    const curves::GridRun rest{run.origin, run.step, cut};
    program.render(run, std::span(parts).first(std::size_t(cut)), other, c);
    program.render(rest, std::span(parts).subspan(std::size_t(cut)), other, c);
    for (int i = 0; i < 40; ++i) {
      FUZZ_CHECK(program.low(c) <= whole[i] && whole[i] <= program.high(c));
      FUZZ_CHECK(whole[i] == parts[i] && whole[i] == program.at_u(run.at(i), c));
    }
    FUZZ_CHECK(program.at_u(NAN, c) == program.at_u(program.u_min(), c));
    FUZZ_CHECK(!std::isnan(program.slope_at_u(program.u_min() + bytes.part() * width, c)));
  }
}

void check_near(const NurbsCurve& curve, const CurveProgram& program, ByteReader& bytes) {
  double want[curves::kMaxDim];
  for (int i = 0; i < 6; ++i) {
    const double u = curve.u_min() + bytes.part() * (curve.u_max() - curve.u_min());
    curve.evaluate(u, want);
    for (int c = 0; c < curve.dim(); ++c) {
      FUZZ_CHECK_AT_MOST(std::abs(program.at_u(u, c) - want[c]),
                         program.max_error() + ulp_of(curve));
    }
  }
}

void check_fast(const NurbsCurve& curve, const CurveProgram& program) {
  const curves::FastProgram fast(program);
  const curves::MapGrid grid{program.u_min(), program.u_max(), 24};
  float out[25];
  fast.evaluate_grid(grid, 0, out);
  double want[curves::kMaxDim];
  for (int i = 0; i < 25; ++i) {
    curve.evaluate(grid.at(i), want);
    FUZZ_CHECK_AT_MOST(std::abs(double(out[i]) - want[0]), fast.max_error() + ulp_of(curve));
  }
}

Outcome parametric(const NurbsCurve& curve, ByteReader& bytes) {
  const auto program = bytes.one_in(4) ? compile_polynomial(curve, options_for(curve))
                                       : compile_parametric(curve, options_for(curve));
  if (!program) {
    check_refusal(program.error(), kCompileErrors);
    return std::nullopt;
  }
  FUZZ_CHECK_AT_MOST(program->max_error(), options_for(curve).max_error);
  check_program(*program, bytes);
  check_near(curve, *program, bytes);
  if (!curve.is_periodic() && curve.jumps().empty()) check_fast(curve, *program);
  return std::nullopt;
}

curves::ControlRange control_from(const NurbsCurve& curve, ByteReader& bytes) {
  using Kind = curves::ControlRange::Kind;
  constexpr Kind kKinds[] = {Kind::weight, Kind::coordinate, Kind::knot};
  curves::ControlRange control;
  control.kind = kKinds[bytes.below(3)];
  control.point = bytes.below(curve.point_count() + curve.degree() + 1);
  control.low = bytes.number();
  control.high = bytes.number();
  return control;
}

Outcome function(const NurbsCurve& curve, ByteReader& bytes) {
  CompileOptions options = options_for(curve);
  if (bytes.one_in(4)) options.controls.push_back(control_from(curve, bytes));
  const auto program = compile_function(curve, options);
  if (!program) {
    check_refusal(program.error(), kCompileErrors);
    return std::nullopt;
  }
  FUZZ_CHECK_AT_MOST(program->max_error(), options.max_error);
  check_program(*program, bytes);
  check_controls_of(*program, bytes);
  if (curve.dim() == 1) check_near(curve, *program, bytes);
  return std::nullopt;
}

Outcome starts(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place_in(bytes, curve.knots(), curve.u_min(), curve.u_max());
  const double y = bytes.number(), slope = bytes.number();
  const auto join = compile_join(curve, u, options_for(curve));
  if (!join) {
    check_refusal(join.error(),
                  {not_a_function, not_scalar, error_bound_missed, control_conflict,
                   value_out_of_range, empty_domain, unsupported, parameter_out_of_range});
    return std::nullopt;
  }
  check_program(join->basis, bytes);
  FUZZ_CHECK(join->u_join <= join->u_basis_end);
  const auto deltas = join->join(y, slope);
  if (std::isfinite(y)) FUZZ_CHECK(!std::isnan(deltas.dp0) && !std::isnan(deltas.dp1));
  const double end = join->basis.u_max();
  if (join->u_basis_end < end) FUZZ_CHECK(join->basis.at_u(end, 0) == 0);
  return std::nullopt;
}

Outcome moving(const NurbsCurve& curve, ByteReader& bytes) {
  const auto moved = curves::MovingCurve::create(curve);
  if (!moved) {
    check_refusal(moved.error(),
                  {dimension_mismatch, degree_out_of_range, unsupported, weight_out_of_range});
    return std::nullopt;
  }
  std::vector<double> points;
  double low = curves::kMaxCoordinate, high = -curves::kMaxCoordinate;
  for (int i = 0; i < 2 * moved->point_count(); ++i) {
    points.push_back(bytes.number());
    double y = std::isnan(points.back()) ? 0 : points.back();
    if (std::abs(y) < 0x1p-800) y = 0;
    if (i % 2 == 0) continue;
    low = std::min(low, std::clamp(y, -curves::kMaxCoordinate, curves::kMaxCoordinate));
    high = std::max(high, std::clamp(y, -curves::kMaxCoordinate, curves::kMaxCoordinate));
  }
  for (int i = 0; i < 3; ++i) {
    const double time = bytes.number(), y = moved->at(time, points);
    FUZZ_CHECK(low <= y && y <= high);
    std::vector<const double*> rows;
    for (const double& x : points) rows.push_back(&x);
    double out = 0;
    moved->render({&time, 1}, rows, {&out, 1});
    FUZZ_CHECK(out == y);
  }
  return std::nullopt;
}

Outcome path(const NurbsCurve& curve, ByteReader&) {
  const double allowed = 1e-3 * (1e-3 + largest_coordinate(curve.points()));
  const auto drawn = svg_path_from_curve(curve, allowed);
  if (!drawn) {
    check_refusal(drawn.error(), {dimension_mismatch, value_out_of_range, error_bound_missed});
    return std::nullopt;
  }
  FUZZ_CHECK_AT_MOST(drawn->max_error, allowed);
  const auto read = curves::curves_from_svg_path(drawn->d);
  if (!read) {
    check_refusal(read.error(), {too_few_points, coordinate_out_of_range});
    return std::nullopt;
  }
  for (const NurbsCurve& piece : *read) check_curve(piece);
  return std::nullopt;
}

// Through values of the curve, and near them.
Outcome fits(const NurbsCurve& curve, ByteReader& bytes) {
  const int count = 2 + bytes.below(12), dim = curve.dim();
  std::vector<double> parameters, values;
  for (int i = 0; i < count; ++i) {
    double out[curves::kMaxDim];
    parameters.push_back(curve.u_min() + (curve.u_max() - curve.u_min()) * i / (count - 1));
    curve.evaluate(parameters.back(), out);
    values.insert(values.end(), out, out + dim);
  }
  const int degree = 1 + bytes.below(7);
  const auto through = curves::interpolate_at(parameters, values, dim, degree);
  if (through) {
    check_curve(*through);
    for (int i = 0; i < count; ++i) {
      double out[curves::kMaxDim];
      through->evaluate(parameters[std::size_t(i)], out);
      for (int c = 0; c < dim; ++c) {
        FUZZ_CHECK_AT_MOST(std::abs(out[c] - values[std::size_t(i * dim + c)]),
                           2 * ulp_of(*through));
      }
    }
  }
  const auto smooth =
      curves::approximate(parameters, values, dim, degree, degree + 1 + bytes.below(4));
  if (smooth) check_curve(smooth->curve);
  if (dim != 1) return std::nullopt;
  const double tolerance = (1e-6 + largest_coordinate(values)) * std::exp2(-30 * bytes.part());
  const auto small = curves::reduce_data(parameters, values, tolerance, degree);
  if (!small) return std::nullopt;
  check_curve(small->curve);
  FUZZ_CHECK_AT_MOST(small->max_error, tolerance);
  for (int i = 0; i < count; ++i) {
    double y = 0;
    small->curve.evaluate(parameters[std::size_t(i)], {&y, 1});
    FUZZ_CHECK_AT_MOST(std::abs(y - values[std::size_t(i)]),
                       small->max_error + ulp_of(small->curve));
  }
  return small->curve;
}

constexpr Operation kForms[] = {parametric, function, starts, moving, path, fits};

}  // namespace

std::span<const Operation> forms() { return kForms; }

}  // namespace knotwave::fuzz
