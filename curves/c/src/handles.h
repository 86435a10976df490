// SPDX-License-Identifier: MIT
// What is behind the handles of the C interface, and the one way every call of it fails.
#pragma once
#include <initializer_list>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/base/index.h"
#include "knotwave/base/result.h"
#include "knotwave/curves.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

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

/// Makes *error, if it is wanted and there is memory for it, and gives its status back.
kw_status report(kw_error** error, Error fault) noexcept;
kw_status report(kw_error** error, kw_status status, std::string_view message) noexcept;

/// A pointer a call cannot do without, under the name the header gives it.
struct Needed {
  const char* name;
  const void* pointer;
  size_t count = 0;  ///< of the elements, for an array
};
/// An array is needed where its count is not 0.
inline Needed array(const char* name, const void* pointer, size_t count) {
  return {name, count == 0 ? name : pointer, count};
}
/// The same for a member of a spec; how many elements it may have is not asked here.
inline Needed member(const char* name, const void* pointer, size_t count) {
  return {name, count == 0 ? name : pointer};
}
/// What the caller gave, or nothing where its members cannot be read: NULL, or of another size.
template <class Spec>
const Spec& readable(const Spec* given) noexcept {
  static constexpr Spec kNothing{};
  return given != nullptr && given->struct_size == sizeof(Spec) ? *given : kNothing;
}
/// The first with more elements of 8 bytes than memory can have, or null.
const Needed* endless(std::initializer_list<Needed> needed) noexcept;
/// Something of a curve that is counted: more than `most` is too_many_points.
std::optional<Error> count_fault(const char* what, size_t count, size_t most);
inline constexpr size_t kMostKnots = KW_MAX_POINTS + KW_MAX_DEGREE + 1;
/// The first that is null, or null.
const char* missing(std::initializer_list<Needed> needed) noexcept;

inline std::span<const double> numbers(const double* first, size_t count) { return {first, count}; }
inline std::vector<double> copied(const double* first, size_t count) {
  return count == 0 ? std::vector<double>() : std::vector<double>(first, first + count);
}
inline std::string text_of(const char* text) { return text == nullptr ? "" : text; }

/// Answers of [any] functions: array and count.
inline const double* lent(std::span<const double> all, size_t* count) {
  if (count != nullptr) *count = all.size();
  return all.data();
}
inline const double* nothing_lent(size_t* count) { return lent({}, count); }

/// Runs the body of a call that may fail: nothing leaves it but a status and an error.
template <class Work>
kw_status run(std::initializer_list<Needed> needed, kw_error** error, Work&& work) noexcept {
  if (error != nullptr) *error = nullptr;
  if (const char* name = missing(needed)) {
    return report(error, KW_NULL_ARGUMENT, std::string_view(name));
  }
  try {
    if (const Needed* one = endless(needed)) {
      return report(error, KW_VALUE_OUT_OF_RANGE,
                    "'" + std::string(one->name) + "' cannot have " + std::to_string(one->count) +
                        " elements: no memory holds them");
    }
    return work();
  } catch (const std::bad_alloc&) {
    return KW_OUT_OF_MEMORY;
  } catch (const std::exception& fault) {
    return report(error, KW_INTERNAL, fault.what());
  } catch (...) {
    return report(error, KW_INTERNAL, "an exception of unknown type");
  }
}

/// Moves a good result through `keep`, or reports.
template <class T, class Keep>
kw_status give(Result<T> made, kw_error** error, Keep&& keep) {
  if (!made) return report(error, std::move(made).error());
  keep(std::move(*made));
  return KW_OK;
}

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
