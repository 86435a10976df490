// SPDX-License-Identifier: MIT
// What every call of the C interface does with its arguments, and the one way it fails.
#pragma once
#include <exception>
#include <initializer_list>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/curves.h"

namespace knotwave::c {

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

}  // namespace knotwave::c
