// SPDX-License-Identifier: MIT
// How set-up fails: a value or an Error. [control] The audio thread has no errors.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// Named after the mathematical or musical fault, never after the place that found it.
enum class ErrorCode {
  // curves
  degree_out_of_range,
  too_few_points,
  too_many_points,
  dimension_mismatch,
  knot_count_mismatch,
  knots_decrease,
  knot_multiplicity,
  empty_domain,
  weight_count_mismatch,
  weight_not_positive,
  weight_out_of_range,
  coordinate_out_of_range,
  not_finite,
  parameter_out_of_range,
  not_a_function,  ///< a 2-D curve whose x (time) goes back
  not_scalar,      ///< the role needs one coordinate
  not_closed,
  error_bound_missed,  ///< compile could not reach the asked error within its piece limit
  control_conflict,    ///< two controllers move the same control point in ways that multiply
  // files
  file_not_found,
  file_too_large,
  io_failed,
  disk_full,
  syntax,
  unknown_key,
  missing_key,
  wrong_type,
  value_out_of_range,
  unknown_name,
  duplicate_name,
  cyclic_reference,
  unsupported_version,
  unsupported_format,
  malformed,
  // programs
  usage,
  interrupted,
  unsupported,
};

/// The code's name as written above. [any]
const char* to_string(ErrorCode code) noexcept;

/// What went wrong, in one sentence a user can act on, and where.
struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string message;
  std::string source;     ///< file name, or empty
  int line = 0;           ///< from 1; 0 = unknown
  int column = 0;         ///< from 1; 0 = unknown
  long long offset = -1;  ///< byte offset in a binary file; -1 = unknown

  /// `file.toml:12:8: error: message`, leaving out what is unknown; a byte offset reads
  /// `file.mid: byte 12: error: message`. Control bytes read \x1b, long words are cut. [control]
  std::string to_string() const;
};

/// A value or an Error. The member names are those of std::expected, which clang 14 cannot compile.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT: implicit
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit

  bool has_value() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  T& value() & { return checked(); }
  const T& value() const& { return const_cast<Result*>(this)->checked(); }
  T&& value() && { return std::move(checked()); }
  T& operator*() & { return checked(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(checked()); }
  T* operator->() { return &checked(); }
  const T* operator->() const { return &value(); }

  const Error& error() const& {
    KNOTWAVE_ASSERT(!has_value());
    return *std::get_if<1>(&state_);
  }
  Error&& error() && {
    KNOTWAVE_ASSERT(!has_value());
    return std::move(*std::get_if<1>(&state_));
  }

 private:
  T& checked() {
    KNOTWAVE_ASSERT(has_value());
    return *std::get_if<0>(&state_);
  }
  std::variant<T, Error> state_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: implicit
  bool has_value() const noexcept { return !error_; }
  explicit operator bool() const noexcept { return has_value(); }
  const Error& error() const& {
    KNOTWAVE_ASSERT(!has_value());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

/// The usual way to make one: `return fail(ErrorCode::knots_decrease, "knot 5 ...");`. [control]
inline Error fail(ErrorCode code, std::string message) {
  return Error{code, std::move(message), {}, 0, 0, -1};
}

}  // namespace knotwave::base

namespace knotwave {
using base::Error;
using base::ErrorCode;
using base::fail;
using base::Result;
}  // namespace knotwave
