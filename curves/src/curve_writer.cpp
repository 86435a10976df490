// SPDX-License-Identifier: MIT
// Curves to text. What is written is what a person would write: knots only where they are not the
// uniform ones, weights only where they are not all 1.
#include "knotwave/base/document.h"
#include "knotwave/curves/curve_file.h"

namespace knotwave::curves {
namespace {

constexpr std::size_t kMaxColumns = 100;

// -0 would be read as the integer 0.
std::string number_text(double number) { return base::number_text(number + 0.0); }

// Words separated by commas between brackets, broken before column 100.
class ArrayText {
 public:
  explicit ArrayText(std::string start) : text_(std::move(start)), indent_(text_.size()) {}

  void add(const std::string& item) {
    if (!first_) text_ += ',';
    const std::size_t column = text_.size() - line_start_;
    if (!first_ && column + item.size() + 2 > kMaxColumns) {
      text_ += '\n';
      line_start_ = text_.size();
      text_.append(indent_, ' ');
    } else if (!first_) {
      text_ += ' ';
    }
    text_ += item;
    first_ = false;
  }
  std::string close(const char* end) { return text_ + end; }

 private:
  std::string text_;
  std::size_t indent_;
  std::size_t line_start_ = 0;
  bool first_ = true;
};

std::string array_text(const std::string& start, std::span<const double> numbers) {
  ArrayText array(start);
  for (const double number : numbers) array.add(number_text(number));
  return array.close("]");
}

// Points of one row: numbers, or arrays of coordinates.
std::string points_text(const std::string& start, std::span<const double> points, int dim) {
  if (dim == 1) return array_text(start, points);
  ArrayText array(start);
  const auto step = static_cast<std::size_t>(dim);
  for (std::size_t i = 0; i < points.size(); i += step) {
    std::string point;
    for (const double number : points.subspan(i, step)) {
      point += (point.empty() ? "[" : ", ") + number_text(number);
    }
    array.add(point + "]");
  }
  return array.close("]");
}

std::string rows_text(const std::string& key, std::span<const double> numbers, int count_u,
                      int dim) {
  std::string text = key + " = [\n";
  const auto row = static_cast<std::size_t>(count_u) * static_cast<std::size_t>(dim);
  for (std::size_t i = 0; i < numbers.size(); i += row) {
    text += points_text("  [", numbers.subspan(i, row), dim) + ",\n";
  }
  return text + "]\n";
}

std::string quoted_key(const std::string& name) {
  if (is_valid_name(name)) return name;
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

std::string knots_text(const std::string& key, const std::vector<double>& knots) {
  return knots.empty() ? "" : array_text(key + " = [", knots) + "\n";
}

std::string curve_text(const NurbsCurve& curve) {
  CurveSpec spec = curve.spec();
  CurveSpec uniform = spec;
  uniform.knots.clear();
  if (const auto same = NurbsCurve::create(uniform); same && *same == curve) spec.knots.clear();
  std::string text = "\n[curves." + quoted_key(spec.name) + "]\n";
  text += "degree = " + std::to_string(spec.degree) + "\n";
  text += points_text("points = [", spec.points, spec.dim) + "\n";
  if (!spec.weights.empty()) text += array_text("weights = [", spec.weights) + "\n";
  text += knots_text("knots", spec.knots);
  if (spec.periodic) text += "periodic = true\n";
  if (!spec.jumps.empty()) text += array_text("jumps = [", spec.jumps) + "\n";
  return text;
}

std::string surface_text(const NurbsSurface& surface) {
  SurfaceSpec spec = surface.spec();
  SurfaceSpec uniform = spec;
  uniform.knots_u.clear();
  if (const auto same = NurbsSurface::create(uniform); same && *same == surface) {
    spec.knots_u.clear();
  }
  uniform = spec;
  uniform.knots_v.clear();
  if (const auto same = NurbsSurface::create(uniform); same && *same == surface) {
    spec.knots_v.clear();
  }
  std::string text = "\n[surfaces." + quoted_key(spec.name) + "]\n";
  text += "degree_u = " + std::to_string(spec.degree_u) + "\n";
  text += "degree_v = " + std::to_string(spec.degree_v) + "\n";
  text += rows_text("points", spec.points, spec.count_u, spec.dim);
  if (!spec.weights.empty()) text += rows_text("weights", spec.weights, spec.count_u, 1);
  text += knots_text("knots_u", spec.knots_u) + knots_text("knots_v", spec.knots_v);
  if (spec.periodic_u) text += "periodic_u = true\n";
  return text;
}

}  // namespace

std::string write_curve_tables(const CurveSet& set) {
  std::string text;
  for (const NurbsCurve& curve : set.curves) text += curve_text(curve);
  for (const NurbsSurface& surface : set.surfaces) text += surface_text(surface);
  return text;
}

std::string write_curves(const CurveSet& set) {
  return "format = 1\nkind = \"curve\"\n" + write_curve_tables(set);
}

}  // namespace knotwave::curves
