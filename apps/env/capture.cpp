// SPDX-License-Identifier: MIT
#include "capture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "knotwave/base/document.h"
#include "knotwave/base/file.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/curves/fit.h"
#include "knotwave/curves/plot_traces.h"
#include "knotwave/io/midi_file.h"

#include "status.h"

namespace knotwave::env {
namespace {

using base::number_text;
using curves::NurbsCurve;

constexpr std::size_t kMostData = std::size_t{1} << 18;
constexpr int kDegree = 3;
constexpr int kPlotColumns = 4000;

double value_at(const NurbsCurve& curve, double time) {
  double value = 0;
  curve.evaluate(time, std::span(&value, 1));
  return value;
}

/// As the file is called, where that is a name.
std::string name_of(const CaptureOptions& options, const std::string& output) {
  std::string stem = std::filesystem::path(output).stem().string();
  if (curves::is_valid_name(stem)) return stem;
  return curves::is_valid_name(options.word) ? options.word : "captured";
}

std::string amount(double number, const std::string& unit) {
  return number_text(std::round(number * 1e6) / 1e6) + (unit.empty() ? "" : " " + unit);
}

/// Of the bound and what is left of it, digits that tell one from the other.
std::string rounded_up(double number) { return fixed(std::ceil(number * 1e4) / 1e4, 4); }

double tolerance_of(const CaptureOptions& options, const Recording& recording) {
  return options.tolerance > 0 ? options.tolerance : recording.usual_tolerance;
}

Result<curves::FittedCurve> fit_of_degree(const Recording& recording, double tolerance,
                                          int degree) {
  return curves::reduce_data(recording.line.times, recording.line.values,
                             tolerance * recording.unit, degree);
}

/// Of degree 3; where that takes many points, as jumps and corners do, straight lines if these take
/// fewer.
Result<curves::FittedCurve> fit(const Recording& recording, double tolerance) {
  auto smooth = fit_of_degree(recording, tolerance, kDegree);
  const bool is_too_many = !smooth && smooth.error().code == ErrorCode::too_many_points;
  if (!is_too_many && !smooth) return smooth;
  const std::size_t many = recording.line.times.size() / 2;
  if (smooth && static_cast<std::size_t>(smooth->curve.point_count()) <= many) return smooth;
  auto lines = fit_of_degree(recording, tolerance, 1);
  if (!lines) return smooth;
  if (smooth && smooth->curve.point_count() <= lines->curve.point_count()) return smooth;
  return lines;
}

/// The next number of three digits that is no smaller.
double three_digits_up(double value) {
  double times = 1, by = 1;
  while (value * times < 100) times *= 10;
  while (value / by >= 1000) by *= 10;
  return std::ceil(value * times / by) / times * by;
}

/// A tolerance with which `--points` are enough, where the one before, 0.3 % and less below, is
/// not: doubled until one is found, then halfway by ratio. 0: none.
double tolerance_for(const CaptureOptions& options, const Recording& recording) {
  constexpr int kMostDoublings = 20, kHalvings = 8;
  const auto is_enough = [&](double tolerance) {
    const auto wider = fit(recording, tolerance);
    return wider && wider->curve.point_count() <= options.points;
  };
  double low = tolerance_of(options, recording), high = 2 * low;
  for (int i = 0; !is_enough(high); ++i) {
    if (i == kMostDoublings) return 0;
    low = high;
    high *= 2;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (is_enough(middle) ? high : low) = middle;
  }
  // More tolerance can take more points, so the rounded one is tried as well.
  const double rounded = three_digits_up(high);
  return is_enough(rounded) ? rounded : high;
}

/// What is said where more points are needed than may be.
Error too_many(const CaptureOptions& options, const Recording& recording, int needed) {
  std::string message = "within " + amount(tolerance_of(options, recording), recording.unit_name) +
                        " it takes " + std::to_string(needed) + " points, --points allows " +
                        std::to_string(options.points);
  const double tolerance = tolerance_for(options, recording);
  if (tolerance > 0) message += "; --tolerance " + number_text(tolerance) + " would do";
  return fail(ErrorCode::too_many_points, message);
}

double seen_of(const Recording& recording, const NurbsCurve& curve) {
  double largest = 0;
  for (std::size_t i = 0; i < recording.line.times.size(); ++i) {
    const double value = value_at(curve, recording.line.times[i]);
    largest = std::max(largest, std::abs(value - recording.line.values[i]));
  }
  return largest;
}

int steps_off(const Recording& recording, const NurbsCurve& curve) {
  int most = 0;
  for (const engine::TimedStep& told : recording.steps) {
    const double value = value_at(curve, told.time) * recording.last_step;
    const double step = std::clamp(std::floor(value + 0.5), 0.0, double(recording.last_step));
    most = std::max(most, std::abs(static_cast<int>(step) - told.step));
  }
  return most;
}

/// What the file says of itself, and how it is used.
std::string comment(const CaptureOptions& options, const Recording& recording,
                    const Capture& capture, const std::string& output) {
  const NurbsCurve& curve = capture.curve;
  const std::string file =
      output.empty() ? "FILE.toml" : std::filesystem::path(output).filename().string();
  const std::string length = number_text(curve.u_max());
  const auto range = curves::value_range(curve, 0);
  return "# " + recording.what + ", " + recording.scale + "; values " + fixed(range.low.value, 4) +
         " to " + fixed(range.high.value, 4) + ".\n# " + std::to_string(recording.count) +
         " values over " + length + (options.beats ? " beats" : " seconds") + " in " +
         std::to_string(curve.point_count()) + " points, nowhere more than " +
         rounded_up(capture.proved) + (recording.unit_name.empty() ? "" : " ") +
         recording.unit_name +
         " from what was recorded (asked for: " + amount(capture.tolerance, recording.unit_name) +
         ").\n#\n# In an envelope patch or a patch of sound:\n#   [curves." + curve.name() +
         "]\n#   curve_file = \"" + io::printable(file, 255) + "#" + curve.name() +
         "\"\n#   [envelopes." + curve.name() + "]\n#   curve = \"" + curve.name() + "\"\n#   " +
         (options.beats ? "beats = " : "seconds = ") + length + "\n\n";
}

std::string report(const CaptureOptions& options, const Recording& recording,
                   const Capture& capture, const std::string& output) {
  const std::string unit = recording.unit_name.empty() ? "" : " " + recording.unit_name;
  std::string line =
      (output.empty() ? "" : io::printable(output, 4096) + ": ") + recording.what + ", " +
      std::to_string(recording.count) + " values in " + fixed(capture.curve.u_max(), 3) +
      (options.beats ? " beats" : " s") + " -> " + std::to_string(capture.curve.point_count()) +
      " points of degree " + std::to_string(capture.curve.degree()) + "; within " +
      amount(capture.tolerance, "") + unit + " asked, " + rounded_up(capture.proved) +
      " proved everywhere, " + rounded_up(capture.seen) + " seen at the data";
  if (!recording.steps.empty()) {
    line += "; sent again at most " + std::to_string(capture.steps_off) + " off";
  }
  return line;
}

/// Where a line must be steps to be seen as recorded.
std::vector<std::pair<double, double>> told_of(const Recording& recording) {
  std::vector<std::pair<double, double>> told;
  for (const engine::TimedStep& step : recording.steps) {
    told.emplace_back(step.time, double(step.step) / recording.last_step);
  }
  if (!told.empty()) return told;
  for (std::size_t i = 0; i < recording.line.times.size(); ++i) {
    told.emplace_back(recording.line.times[i], recording.line.values[i]);
  }
  return told;
}

Result<Recording> record(const EnvOptions& options, const std::atomic<int>& signals) {
  if (options.capture.from.empty()) return record_midi_inputs(options, signals);
  return options.capture.is_sound ? record_sound_file(options) : record_midi_file(options);
}

}  // namespace

Result<Capture> reduce(const CaptureOptions& options, const std::string& output,
                       const Recording& recording) {
  if (recording.line.times.size() > kMostData) {
    return fail(ErrorCode::file_too_large,
                std::to_string(recording.line.times.size()) + " data, a curve is fitted to " +
                    std::to_string(kMostData) + " at most: record a shorter time" +
                    (options.is_sound ? " or a longer --hop" : ""));
  }
  const double tolerance = tolerance_of(options, recording);
  auto fitted = fit(recording, tolerance);
  if (!fitted) {
    Error error = std::move(fitted).error();
    if (error.code == ErrorCode::too_many_points) {
      error.message = "within " + amount(tolerance, recording.unit_name) + " it takes more than " +
                      std::to_string(curves::kMaxPoints) +
                      " points, more than a curve may have; --tolerance allows more";
    }
    return error;
  }
  if (options.points > 0 && fitted->curve.point_count() > options.points) {
    return too_many(options, recording, fitted->curve.point_count());
  }
  curves::CurveSpec spec = fitted->curve.spec();
  spec.name = name_of(options, output);
  auto named = NurbsCurve::create(std::move(spec));
  if (!named) return named.error();
  Capture capture{std::move(*named), tolerance, fitted->max_error / recording.unit, 0, 0, {}, {}};
  capture.seen = seen_of(recording, capture.curve) / recording.unit;
  capture.steps_off = steps_off(recording, capture.curve);
  capture.text =
      comment(options, recording, capture, output) + curves::write_curves({{capture.curve}, {}});
  capture.report = report(options, recording, capture, output);
  return capture;
}

std::string plot_of(const CaptureOptions& options, const Recording& recording,
                    const NurbsCurve& curve) {
  curves::PlotPanel panel;
  panel.title = recording.what;
  panel.y_name = "value";
  curves::PlotTrace& drawn = panel.traces.emplace_back();
  drawn.name = "curve of " + std::to_string(curve.point_count()) + " points";
  for (int i = 0; i <= kPlotColumns; ++i) {
    const double time = curve.u_max() * i / kPlotColumns;
    drawn.points.emplace_back(time, value_at(curve, time));
  }
  panel.traces.push_back({"recorded", told_of(recording), !recording.steps.empty()});
  curves::PlotOptions plot;
  plot.width_px = 1200;
  plot.height_px = 360;
  return curves::plot_svg({panel}, options.beats ? "beats" : "seconds", plot);
}

Result<std::string> run_capture(const EnvOptions& options, const std::atomic<int>& signals) {
  const auto told = [&options](Error error) {
    if (error.source.empty()) error.source = options.capture.from;
    return error;
  };
  const auto recording = record(options, signals);
  if (!recording) return told(recording.error());
  const auto capture = reduce(options.capture, options.output, *recording);
  if (!capture) return told(capture.error());
  if (!options.plot.empty()) {
    const std::string svg = plot_of(options.capture, *recording, capture->curve);
    if (const auto written = base::write_file(options.plot, svg); !written) return written.error();
  }
  if (options.output.empty()) {
    std::fprintf(stderr, "%s\n", capture->report.c_str());
    return capture->text;
  }
  const auto written = base::write_file(options.output, capture->text);
  if (!written) return written.error();
  return capture->report + "\n";
}

}  // namespace knotwave::env
