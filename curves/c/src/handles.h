// SPDX-License-Identifier: MIT
// What is behind the handles of the C interface, and the calls that make one.
#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/base/index.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

#include "calls.h"

struct kw_curve {
  knotwave::curves::NurbsCurve curve;
};
struct kw_surface {
  knotwave::curves::NurbsSurface surface;
};
struct kw_program {
  knotwave::curves::CurveProgram program;
};
// Handles that were lent out stay where they are while the set grows.
struct kw_curve_set {
  std::vector<std::unique_ptr<kw_curve>> curves;
  std::vector<std::unique_ptr<kw_surface>> surfaces;
};
struct kw_bezier {
  int degree = 0;
  int dim = 0;
  std::vector<double> ends, points, weights;
};

namespace knotwave::c {

using base::index_of;

/// Something of a curve that is counted: more than `most` is too_many_points.
std::optional<Error> count_fault(const char* what, size_t count, size_t most);
inline constexpr size_t kMostKnots = KW_MAX_POINTS + KW_MAX_DEGREE + 1;

/// A call that makes one curve: `work` returns Result<NurbsCurve>.
template <class Work>
kw_status make_curve(std::initializer_list<Needed> needed, kw_curve** out, kw_error** error,
                     Work&& work) noexcept {
  if (out != nullptr) *out = nullptr;
  return run(needed, error, [&]() -> kw_status {
    if (out == nullptr) return report(error, KW_NULL_ARGUMENT, "out");
    return give(work(), error,
                [&](curves::NurbsCurve&& curve) { *out = new kw_curve{std::move(curve)}; });
  });
}

/// The same for a surface.
template <class Work>
kw_status make_surface(std::initializer_list<Needed> needed, kw_surface** out, kw_error** error,
                       Work&& work) noexcept {
  if (out != nullptr) *out = nullptr;
  return run(needed, error, [&]() -> kw_status {
    if (out == nullptr) return report(error, KW_NULL_ARGUMENT, "out");
    return give(work(), error,
                [&](curves::NurbsSurface&& surface) { *out = new kw_surface{std::move(surface)}; });
  });
}

/// A call that makes one curve by results that say more of it: `tell` gets them once *out is made.
template <class Work, class Tell>
kw_status make_curve(std::initializer_list<Needed> needed, kw_curve** out, kw_error** error,
                     Work&& work, Tell&& tell) noexcept {
  return make_curve(needed, out, error, [&]() -> Result<curves::NurbsCurve> {
    auto made = work();
    if (!made) return std::move(made).error();
    tell(*made);
    return std::move(made->curve);
  });
}

/// For two outputs at one place: the first would be lost.
Error one_place_for_two();

/// A call that makes two curves or none.
struct TwoCurves {
  curves::NurbsCurve first;
  curves::NurbsCurve second;
};
template <class Work>
kw_status make_two_curves(std::initializer_list<Needed> needed, kw_curve** out_first,
                          kw_curve** out_second, kw_error** error, Work&& work) noexcept {
  if (out_first != nullptr) *out_first = nullptr;
  if (out_second != nullptr) *out_second = nullptr;
  return run(needed, error, [&]() -> kw_status {
    if (out_first == nullptr || out_second == nullptr) {
      return report(error, KW_NULL_ARGUMENT, out_first == nullptr ? "first out" : "second out");
    }
    if (out_first == out_second) return report(error, one_place_for_two());
    return give(work(), error, [&](TwoCurves&& both) {
      auto first = std::make_unique<kw_curve>(kw_curve{std::move(both.first)});
      *out_second = new kw_curve{std::move(both.second)};
      *out_first = first.release();
    });
  });
}

std::unique_ptr<kw_curve_set> handle_of(curves::CurveSet&& set);

/// A call that makes a set: `work` returns Result<CurveSet>.
template <class Work>
kw_status make_curve_set(std::initializer_list<Needed> needed, kw_curve_set** out, kw_error** error,
                         Work&& work) noexcept {
  if (out != nullptr) *out = nullptr;
  return run(needed, error, [&]() -> kw_status {
    if (out == nullptr) return report(error, KW_NULL_ARGUMENT, "out");
    return give(work(), error,
                [&](curves::CurveSet&& set) { *out = handle_of(std::move(set)).release(); });
  });
}

/// A text of the caller's own.
char* new_text(std::string_view text);
/// Numbers of the caller's own.
kw_doubles new_doubles(std::span<const double> numbers);

/// The first handle that is NULL, such as "curves[2]"; empty if none is.
std::string missing_among(const char* name, const kw_curve* const* handles, size_t count);
/// Copies of all; none is NULL.
std::vector<curves::NurbsCurve> curves_of(const kw_curve* const* handles, size_t count);
/// What compile options need: their controls, if any are announced.
inline Needed needed_controls(const kw_compile_options* options) noexcept {
  const kw_compile_options& given = readable(options);
  return member("options->controls", given.controls, given.controls_count);
}
/// Defaults for NULL.
Result<curves::CompileOptions> compile_options_of(const kw_compile_options* options);

/// Empty if the curve has that coordinate.
std::optional<Error> coordinate_fault(const curves::NurbsCurve& curve, int32_t coordinate);
/// For a number that is none of 0..count-1.
Error unknown_choice(const char* what, int32_t choice, int32_t count);

}  // namespace knotwave::c
