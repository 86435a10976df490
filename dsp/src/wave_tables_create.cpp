// SPDX-License-Identifier: MIT
// Curves, surfaces and sampled cycles to rows of harmonics.
#include <algorithm>
#include <cmath>
#include <string>

#include "knotwave/dsp/fft.h"
#include "knotwave/dsp/wave_tables.h"

#include "wave_table_builder.h"

namespace knotwave::dsp {
namespace {

using Complex = std::complex<double>;
using curves::NurbsCurve;
using curves::NurbsSurface;

/// Rational spans become polynomials within this, re the largest coordinate: far below the fit
/// along v and the rounding of float tables.
constexpr double kSpanError = 1e-9;

double largest(std::span<const double> numbers) {
  double found = 0;
  for (const double number : numbers) found = std::max(found, std::abs(number));
  return found;
}

Result<void> check_channels(const std::string& name, int dim) {
  if (dim <= 2) return {};
  return fail(ErrorCode::not_scalar, "'" + name + "' has " + std::to_string(dim) +
                                         " coordinates; a waveform has 1, or 2 for left and right");
}

/// One curve as a row; its compile error goes to `builder`.
Result<RowHarmonics> row_of(const NurbsCurve& curve, WaveTableBuilder& builder) {
  curves::CompileOptions options;
  const double size = largest(curve.points());
  const double peak = size > 0 ? size : 1.0;
  options.max_error = kSpanError * peak;
  const auto program = curves::compile_polynomial(curve, options);
  if (!program) return program.error();
  builder.note_fit_error(program->max_error() / peak);
  RowHarmonics row;
  for (int channel = 0; channel < curve.dim(); ++channel) {
    row.push_back(fourier_coefficients(*program, channel, builder.max_harmonic()));
  }
  return row;
}

Result<void> add_curve(const Result<NurbsCurve>& curve, WaveTableBuilder& builder) {
  if (!curve) return curve.error();
  auto row = row_of(*curve, builder);
  if (!row) return row.error();
  builder.add_row(std::move(*row));
  return {};
}

/// Row v of the control points as a curve of its own.
Result<NurbsCurve> control_row(const curves::SurfaceSpec& surface, int v) {
  curves::CurveSpec row;
  row.name = surface.name;
  row.degree = surface.degree_u;
  row.dim = surface.dim;
  row.knots = surface.knots_u;
  row.periodic = surface.periodic_u;
  const auto length = static_cast<std::ptrdiff_t>(surface.count_u) * surface.dim;
  row.points.assign(surface.points.begin() + v * length, surface.points.begin() + (v + 1) * length);
  return NurbsCurve::create(std::move(row));
}

Result<void> add_fitted_rows(const NurbsSurface& surface, double max_error,
                             WaveTableBuilder& builder) {
  const double low = surface.v_min();
  const double length = surface.v_max() - low;
  std::vector<double> breaks;
  for (const double knot : surface.knots_v()) {
    const double position = std::clamp((knot - low) / length, 0.0, 1.0);
    if (breaks.empty() || position > breaks.back()) breaks.push_back(position);
  }
  const RowAt row_at = [&](double position) {
    return row_of(surface.iso_curve_at_v(low + length * position), builder);
  };
  return fit_rows(row_at, breaks, max_error, builder);
}

Result<void> check_control(const NurbsCurve& curve, const curves::ControlRange& control) {
  if (control.kind == curves::ControlRange::Kind::knot) {
    return curves::check_controls(curve, {control});
  }
  const auto points = static_cast<int>(curve.spec().points.size()) / curve.dim();
  if (control.point < 0 || control.point >= points) {
    return fail(ErrorCode::value_out_of_range, "'" + curve.name() + "' has points 0.." +
                                                   std::to_string(points - 1) + ", not " +
                                                   std::to_string(control.point));
  }
  const bool moves_coordinate = control.kind == curves::ControlRange::Kind::coordinate;
  if (moves_coordinate && (control.coordinate < 0 || control.coordinate >= curve.dim())) {
    return fail(ErrorCode::value_out_of_range, "'" + curve.name() + "' has coordinates 0.." +
                                                   std::to_string(curve.dim() - 1) + ", not " +
                                                   std::to_string(control.coordinate));
  }
  return {};
}

}  // namespace

Result<WaveTables> WaveTables::create(const NurbsCurve& curve, const WaveTableOptions& options) {
  if (auto checked = check_channels(curve.name(), curve.dim()); !checked) return checked.error();
  auto builder = WaveTableBuilder::create(curve.dim(), options);
  if (!builder) return builder.error();
  auto row = row_of(curve, *builder);
  if (!row) return row.error();
  builder->add_row(std::move(*row));
  builder->blend_linearly();
  return builder->finish();
}

Result<WaveTables> WaveTables::create(const NurbsSurface& surface,
                                      const WaveTableOptions& options) {
  if (auto checked = check_channels(surface.name(), surface.dim()); !checked)
    return checked.error();
  auto builder = WaveTableBuilder::create(surface.dim(), options);
  if (!builder) return builder.error();
  if (surface.is_rational() || surface.degree_v() >= kMaxBlended) {
    const auto fitted = add_fitted_rows(surface, options.max_fit_error, *builder);
    if (!fitted) return fitted.error();
    return builder->finish();
  }
  const curves::SurfaceSpec spec = surface.spec();
  for (int v = 0; v < spec.count_v; ++v) {
    const auto added = add_curve(control_row(spec, v), *builder);
    if (!added) return added.error();
  }
  builder->blend_by_basis(surface.knots_v(), surface.degree_v());
  return builder->finish();
}

Result<WaveTables> WaveTables::create(const NurbsCurve& curve, const curves::ControlRange& control,
                                      const WaveTableOptions& options) {
  if (auto checked = check_channels(curve.name(), curve.dim()); !checked) return checked.error();
  if (auto checked = check_control(curve, control); !checked) return checked.error();
  auto builder = WaveTableBuilder::create(curve.dim(), options);
  if (!builder) return builder.error();
  if (control.kind == curves::ControlRange::Kind::coordinate) {  // linear: two rows are exact
    for (const double value : {control.low, control.high}) {
      const auto added = add_curve(curves::curve_with(curve, {control}, {value}), *builder);
      if (!added) return added.error();
    }
    builder->blend_linearly();
    return builder->finish();
  }
  const RowAt row_at = [&](double position) -> Result<RowHarmonics> {
    const double value =
        position == 1 ? control.high : control.low + (control.high - control.low) * position;
    const auto moved = curves::curve_with(curve, {control}, {value});
    if (!moved) return moved.error();
    return row_of(*moved, *builder);
  };
  const double ends[] = {0, 1};
  const auto fitted = fit_rows(row_at, ends, options.max_fit_error, *builder);
  if (!fitted) return fitted.error();
  return builder->finish();
}

Result<WaveTables> WaveTables::create_from_cycles(std::span<const float> samples, int frame,
                                                  int rows, const WaveTableOptions& options) {
  if (frame < 2 || rows < 1) {
    return fail(ErrorCode::too_few_points, "a waveform needs cycles of 2 samples or more, not " +
                                               std::to_string(rows) + " of " +
                                               std::to_string(frame));
  }
  if (rows > kMaxRows) {
    return fail(ErrorCode::too_many_points, std::to_string(rows) + " cycles are more than the " +
                                                std::to_string(kMaxRows) + " there can be");
  }
  const auto length = static_cast<std::size_t>(frame);
  if (samples.size() != length * static_cast<std::size_t>(rows)) {
    return fail(ErrorCode::dimension_mismatch, std::to_string(rows) + " cycles of " +
                                                   std::to_string(frame) + " are not " +
                                                   std::to_string(samples.size()) + " samples");
  }
  const auto broken = std::find_if(samples.begin(), samples.end(),
                                   [](float sample) { return !std::isfinite(sample); });
  if (broken != samples.end()) {
    return fail(ErrorCode::not_finite,
                "sample " + std::to_string(broken - samples.begin()) + " is not a finite number");
  }
  auto builder = WaveTableBuilder::create(1, options);
  if (!builder) return builder.error();
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
    const auto cycle = samples.subspan(row * length, length);
    const std::vector<double> exact(cycle.begin(), cycle.end());
    builder->add_row({harmonics_of_cycle(exact, builder->max_harmonic())});
  }
  builder->blend_linearly();
  return builder->finish();
}

Result<WaveTables> WaveTables::create_from_harmonics(std::span<const Complex> harmonics,
                                                     const WaveTableOptions& options) {
  if (harmonics.empty()) {
    return fail(ErrorCode::too_few_points, "a waveform needs one harmonic or more");
  }
  for (std::size_t n = 0; n < harmonics.size(); ++n) {
    if (!std::isfinite(harmonics[n].real()) || !std::isfinite(harmonics[n].imag())) {
      return fail(ErrorCode::not_finite, "harmonic " + std::to_string(n) + " is not finite");
    }
  }
  auto builder = WaveTableBuilder::create(1, options);
  if (!builder) return builder.error();
  builder->add_row({std::vector<Complex>(harmonics.begin(), harmonics.end())});
  builder->blend_linearly();
  return builder->finish();
}

}  // namespace knotwave::dsp
