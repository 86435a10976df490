// SPDX-License-Identifier: MIT
// Commands whose result is another curve, and which say how far it is from the old one: simplify,
// morph.
#include <algorithm>

#include "knotwave/curves/combine.h"
#include "knotwave/curves/reduce.h"

#include "curve_input.h"
#include "curve_output.h"

namespace knotwave::curve_app {
namespace {

using curves::NurbsCurve;

Result<NurbsCurve> read_one_curve(const std::string& word, const std::string& command) {
  const auto item = read_item(word);
  if (!item) return item.error();
  if (const auto* curve = std::get_if<NurbsCurve>(&*item)) return *curve;
  return fail(ErrorCode::usage, command + " is for curves, '" + word + "' is a surface");
}

/// Degrees first, then knots. What the steps cost adds up, and the sum stays within the tolerance.
Result<curves::ReducedCurve> reduced(const NurbsCurve& curve, int degree, double tolerance) {
  curves::ReducedCurve all{curve, 0, 0};
  while (degree > 0 && all.curve.degree() > degree) {
    const auto lower = reduce_degree(all.curve, tolerance - all.max_error);
    if (!lower) return lower.error();
    all = {lower->curve, 0, all.max_error + lower->max_error};
  }
  const auto fewer = remove_knots(all.curve, std::max(tolerance - all.max_error, 0.0));
  if (!fewer) return fewer.error();
  return curves::ReducedCurve{fewer->curve, fewer->removed, all.max_error + fewer->max_error};
}

}  // namespace

Result<Made> simplified(const CurveOptions& options) {
  const auto curve = read_one_curve(options.files.front(), "simplify");
  if (!curve) return curve.error();
  const auto told = [&options](const Error& error) {
    return told_of(options.files.front(), error);
  };
  if (options.degree > curve->degree()) {
    return fail(ErrorCode::usage, "--degree " + std::to_string(options.degree) +
                                      " is above the degree of the curve, " +
                                      std::to_string(curve->degree()) + "; elevate raises it");
  }
  const double largest = largest_value(*curve);
  const auto less = reduced(*curve, options.degree, tolerance_of(options, largest));
  if (!less) return told(less.error());
  const auto named = renamed(less->curve, options.name.empty() ? curve->name() : options.name);
  if (!named) return told(named.error());
  const auto before = curve->spec().points.size() / std::size_t(curve->dim());
  return made_of({{*named}, {}}, std::to_string(before) +
                                     " points before; nowhere farther off than " +
                                     error_text(less->max_error, largest));
}

Result<Made> morphed(const CurveOptions& options) {
  const auto first = read_one_curve(options.files[0], "morph");
  if (!first) return first.error();
  const auto second = read_one_curve(options.files[1], "morph");
  if (!second) return second.error();
  const auto between = morph(*first, *second, options.amount);
  if (!between) return between.error();
  const auto named = renamed(*between, options.name.empty() ? first->name() : options.name);
  if (!named) return named.error();
  return made_of({{*named}, {}});
}

}  // namespace knotwave::curve_app
