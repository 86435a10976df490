// SPDX-License-Identifier: MIT
#include <algorithm>

#include "knotwave/base/document.h"
#include "knotwave/curves/algorithms.h"

#include "command_line/json.h"
#include "curve_input.h"
#include "verbs.h"

namespace knotwave::curve_app {
namespace {

using base::number_text;
using command_line::json_number;
using curves::NurbsCurve;
using curves::NurbsSurface;

/// Facts in order: a word for the reader and the JSON key, the text, and the JSON value.
struct Fact {
  std::string word;
  std::string text;
  std::string json;
};
using Facts = std::vector<Fact>;

Fact number_fact(const std::string& word, double value) {
  return {word, number_text(value), json_number(value)};
}
Fact text_fact(const std::string& word, const std::string& text) {
  return {word, text, command_line::json_string(text)};
}
Fact claim_fact(const std::string& word, bool is) {
  return {word, is ? "yes" : "no", is ? "true" : "false"};
}
Fact range_fact(const std::string& word, double low, double high) {
  return {word, number_text(low) + " .. " + number_text(high),
          "[" + json_number(low) + ", " + json_number(high) + "]"};
}

/// "0 x4, 0.5, 1 x4": every knot of the file with how often it is there.
Fact knots_fact(const std::string& word, std::span<const double> knots) {
  std::string text, json;
  for (std::size_t i = 0; i < knots.size();) {
    const auto end = std::upper_bound(knots.begin(), knots.end(), knots[i]) - knots.begin();
    const auto times = static_cast<std::size_t>(end) - i;
    text += (text.empty() ? "" : ", ") + number_text(knots[i]);
    if (times > 1) text += " x" + std::to_string(times);
    i = static_cast<std::size_t>(end);
  }
  for (const double knot : knots) json += (json.empty() ? "" : ", ") + json_number(knot);
  return {word, text, "[" + json + "]"};
}

/// The smoothness the knots promise inside: degree less the highest multiplicity; -1 is a jump.
int continuity_of(const NurbsCurve& curve) {
  int most = 0;
  for (const double knot : curve.knots()) {
    const bool seam = curve.is_periodic() && knot == curve.u_min();
    if (!seam && !(knot > curve.u_min() && knot < curve.u_max())) continue;
    most = std::max(most,
                    static_cast<int>(std::count(curve.knots().begin(), curve.knots().end(), knot)));
  }
  return curve.degree() - most;
}

bool is_closed(const NurbsCurve& curve) {
  double start[curves::kMaxDim], end[curves::kMaxDim];
  curve.evaluate(curve.u_min(), curves::Side::right, start);
  curve.evaluate(curve.u_max(), curves::Side::left, end);
  return std::equal(start, start + curve.dim(), end);
}

Fact continuity_fact(const NurbsCurve& curve) {
  const int order = continuity_of(curve);
  if (order == curve.degree()) {
    return text_fact("smoothness",
                     curve.is_rational() ? "one rational piece" : "one polynomial piece");
  }
  return text_fact("smoothness", order < 0 ? "jumps" : "C" + std::to_string(order));
}

Facts facts_of(const NurbsCurve& curve) {
  const curves::CurveSpec spec = curve.spec();
  Facts facts = {text_fact("curve", curve.name()),
                 number_fact("degree", curve.degree()),
                 number_fact("coordinates", curve.dim()),
                 number_fact("points", static_cast<double>(spec.points.size()) / curve.dim()),
                 claim_fact("rational", curve.is_rational()),
                 claim_fact("periodic", curve.is_periodic()),
                 claim_fact("closed", curve.is_periodic() || is_closed(curve))};
  if (!spec.weights.empty()) {
    const auto [low, high] = std::minmax_element(spec.weights.begin(), spec.weights.end());
    facts.push_back(range_fact("weights", *low, *high));
  }
  facts.push_back(knots_fact("knots", spec.knots));
  if (!spec.jumps.empty()) facts.push_back(knots_fact("jumps", spec.jumps));
  facts.push_back(range_fact("domain", curve.u_min(), curve.u_max()));
  facts.push_back(number_fact("pieces", static_cast<double>(to_bezier(curve).size())));
  facts.push_back(continuity_fact(curve));
  for (int c = 0; c < curve.dim(); ++c) {
    const curves::HullRange hull = hull_range(curve, c);
    facts.push_back(range_fact("hull of x" + std::to_string(c), hull.low, hull.high));
  }
  if (curve.dim() == 2) facts.push_back(claim_fact("function of x", is_non_decreasing(curve, 0)));
  return facts;
}

Facts facts_of(const NurbsSurface& surface) {
  const curves::SurfaceSpec spec = surface.spec();
  Facts facts = {text_fact("surface", surface.name()),
                 number_fact("degree along u", surface.degree_u()),
                 number_fact("degree along v", surface.degree_v()),
                 number_fact("coordinates", surface.dim()),
                 number_fact("points in a row", spec.count_u),
                 number_fact("rows", spec.count_v),
                 claim_fact("rational", surface.is_rational()),
                 claim_fact("periodic in u", surface.is_periodic_u()),
                 knots_fact("knots along u", spec.knots_u),
                 knots_fact("knots along v", spec.knots_v),
                 range_fact("domain of u", surface.u_min(), surface.u_max()),
                 range_fact("domain of v", surface.v_min(), surface.v_max())};
  for (int c = 0; c < surface.dim(); ++c) {
    double low = spec.points[std::size_t(c)], high = low;
    for (std::size_t i = std::size_t(c); i < spec.points.size(); i += std::size_t(surface.dim())) {
      low = std::min(low, spec.points[i]);
      high = std::max(high, spec.points[i]);
    }
    facts.push_back(range_fact("hull of x" + std::to_string(c), low, high));
  }
  return facts;
}

std::string lines_of(const Facts& facts) {
  std::size_t width = 0;
  for (const Fact& fact : facts) width = std::max(width, fact.word.size());
  std::string text;
  for (const Fact& fact : facts) {
    text += fact.word + std::string(width + 2 - fact.word.size(), ' ') + fact.text + "\n";
  }
  return text;
}

std::string json_of(const Facts& facts) {
  std::string text;
  for (const Fact& fact : facts) {
    std::string key = fact.word;
    std::replace(key.begin(), key.end(), ' ', '_');
    text += (text.empty() ? "{" : ", ") + command_line::json_string(key) + ": " + fact.json;
  }
  return text + "}";
}

}  // namespace

Result<std::string> info_text(const CurveOptions& options) {
  const Reference reference = reference_of(options.files.front());
  std::vector<Facts> all;
  if (reference.name.empty()) {  // all there are
    const auto set = read_set(reference.path);
    if (!set) return set.error();
    for (const NurbsCurve& curve : set->curves) all.push_back(facts_of(curve));
    for (const NurbsSurface& surface : set->surfaces) all.push_back(facts_of(surface));
  } else {
    const auto item = read_item(options.files.front());
    if (!item) return item.error();
    all.push_back(std::visit([](const auto& shape) { return facts_of(shape); }, *item));
  }
  std::string text = options.json ? "[" : "";
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) text += options.json ? ",\n " : "\n";
    text += options.json ? json_of(all[i]) : lines_of(all[i]);
  }
  return options.json ? text + "]\n" : text;
}

}  // namespace knotwave::curve_app
