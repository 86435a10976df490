// SPDX-License-Identifier: MIT
// Commands that leave the curve as it is: split, insert-knot, elevate, iso.
#include <type_traits>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/surface_algorithms.h"

#include "curve_input.h"
#include "curve_output.h"

namespace knotwave::curve_app {
namespace {

using base::number_text;
using curves::CurveSet;
using curves::NurbsCurve;
using curves::NurbsSurface;

void add(CurveSet& set, NurbsCurve curve) { set.curves.push_back(std::move(curve)); }
void add(CurveSet& set, NurbsSurface surface) { set.surfaces.push_back(std::move(surface)); }

/// What an edit is called: as asked, else as before.
template <class Shape>
std::string name_of(const Shape& shape, const CurveOptions& options) {
  return options.name.empty() ? shape.name() : options.name;
}

Result<void> check_direction(const Item& item, const CurveOptions& options) {
  const bool is_surface = std::holds_alternative<NurbsSurface>(item);
  if (is_surface == options.direction.has_value()) return {};
  return fail(ErrorCode::usage, is_surface ? "a surface takes --direction u or --direction v"
                                           : "--direction is for surfaces, this is a curve");
}

/// Reads the shape and gives what `edit` makes of it, under the name asked for.
template <class Edit>
Result<Made> edited(const CurveOptions& options, const Edit& edit) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  if (const auto fits = check_direction(*item, options); !fits) return fits.error();
  const auto done = std::visit(
      [&](const auto& shape) -> Result<Made> {
        const auto result = edit(shape);
        if (!result) return result.error();
        const auto named = renamed(*result, name_of(shape, options));
        if (!named) return named.error();
        CurveSet set;
        add(set, *named);
        return made_of(set);
      },
      *item);
  return done ? done : told_of(options.files.front(), done.error());
}

template <class Shape>
Result<Made> both(const Shape& first, const std::string& first_name, const Shape& second,
                  const std::string& second_name) {
  const auto left = renamed(first, first_name), right = renamed(second, second_name);
  if (!left) return left.error();
  if (!right) return right.error();
  CurveSet set;
  add(set, *left);
  add(set, *right);
  return made_of(set);
}

Result<Made> parts_of(const NurbsCurve& curve, const CurveOptions& options) {
  const auto pair = split(curve, options.knots.front());
  if (!pair) return pair.error();
  const std::string name = name_of(curve, options);
  return both(pair->left, name + "_left", pair->right, name + "_right");
}

Result<Made> parts_of(const NurbsSurface& surface, const CurveOptions& options) {
  const auto pair = split(surface, *options.direction, options.knots.front());
  if (!pair) return pair.error();
  const std::string name = name_of(surface, options);
  return both(pair->low, name + "_low", pair->high, name + "_high");
}

/// The iso curve at one place of the list.
Result<NurbsCurve> iso_curve(const NurbsSurface& surface, bool is_at_u, double at,
                             const std::string& name) {
  const double low = is_at_u ? surface.u_min() : surface.v_min();
  const double high = is_at_u ? surface.u_max() : surface.v_max();
  if (!(at >= low && at <= high)) {
    return fail(ErrorCode::parameter_out_of_range, std::string(is_at_u ? "u" : "v") + " = " +
                                                       number_text(at) + " is outside " +
                                                       number_text(low) + ".." + number_text(high));
  }
  return renamed(is_at_u ? surface.iso_curve_at_u(at) : surface.iso_curve_at_v(at), name);
}

}  // namespace

Result<Made> split_in_two(const CurveOptions& options) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  if (const auto fits = check_direction(*item, options); !fits) return fits.error();
  const auto done =
      std::visit([&options](const auto& shape) { return parts_of(shape, options); }, *item);
  return done ? done : told_of(options.files.front(), done.error());
}

Result<Made> with_knots(const CurveOptions& options) {
  std::vector<double> knots;
  for (const double knot : options.knots) {
    knots.insert(knots.end(), std::size_t(options.times), knot);
  }
  return edited(options, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, NurbsCurve>) {
      return refine(shape, knots);
    } else {
      return refine(shape, *options.direction, knots);
    }
  });
}

Result<Made> elevated(const CurveOptions& options) {
  return edited(options, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, NurbsCurve>) {
      return elevate_degree(shape, options.times);
    } else {
      return elevate_degree(shape, *options.direction, options.times);
    }
  });
}

Result<Made> iso_curves(const CurveOptions& options) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  const auto* surface = std::get_if<NurbsSurface>(&*item);
  if (surface == nullptr) return fail(ErrorCode::usage, "iso is for surfaces, this is a curve");
  const bool is_at_u = options.iso_v.empty();
  const std::vector<double>& places = is_at_u ? options.iso_u : options.iso_v;
  const std::string name = name_of(*surface, options);
  CurveSet set;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string own = places.size() == 1 ? name : name + "_" + std::to_string(i + 1);
    const auto curve = iso_curve(*surface, is_at_u, places[i], own);
    if (!curve) return told_of(options.files.front(), curve.error());
    add(set, *curve);
  }
  const auto done = made_of(set);
  return done ? done : told_of(options.files.front(), done.error());
}

}  // namespace knotwave::curve_app
