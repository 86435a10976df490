// SPDX-License-Identifier: MIT
// Errors, texts and numbers as C holds them.
#include <cstdint>
#include <cstring>

#include "handles.h"

struct kw_error {
  kw_status status = KW_OK;
  std::string message, text, source;
  int32_t line = 0, column = 0;
};

static_assert(KNOTWAVE_VERSION_NUMBER ==
                  10000 * KW_VERSION_MAJOR + 100 * KW_VERSION_MINOR + KW_VERSION_PATCH,
              "knotwave/c/status.h states another version than CMakeLists.txt");

namespace knotwave::c {
namespace {

// Numbers are fixed in the header; the order of ErrorCode is not.
struct Pair {
  base::ErrorCode code;
  kw_status status;
};
constexpr Pair kPairs[] = {
    {ErrorCode::degree_out_of_range, KW_DEGREE_OUT_OF_RANGE},
    {ErrorCode::too_few_points, KW_TOO_FEW_POINTS},
    {ErrorCode::too_many_points, KW_TOO_MANY_POINTS},
    {ErrorCode::dimension_mismatch, KW_DIMENSION_MISMATCH},
    {ErrorCode::knot_count_mismatch, KW_KNOT_COUNT_MISMATCH},
    {ErrorCode::knots_decrease, KW_KNOTS_DECREASE},
    {ErrorCode::knot_multiplicity, KW_KNOT_MULTIPLICITY},
    {ErrorCode::empty_domain, KW_EMPTY_DOMAIN},
    {ErrorCode::weight_count_mismatch, KW_WEIGHT_COUNT_MISMATCH},
    {ErrorCode::weight_not_positive, KW_WEIGHT_NOT_POSITIVE},
    {ErrorCode::weight_out_of_range, KW_WEIGHT_OUT_OF_RANGE},
    {ErrorCode::coordinate_out_of_range, KW_COORDINATE_OUT_OF_RANGE},
    {ErrorCode::not_finite, KW_NOT_FINITE},
    {ErrorCode::parameter_out_of_range, KW_PARAMETER_OUT_OF_RANGE},
    {ErrorCode::not_a_function, KW_NOT_A_FUNCTION},
    {ErrorCode::not_scalar, KW_NOT_SCALAR},
    {ErrorCode::not_closed, KW_NOT_CLOSED},
    {ErrorCode::error_bound_missed, KW_ERROR_BOUND_MISSED},
    {ErrorCode::control_conflict, KW_CONTROL_CONFLICT},
    {ErrorCode::file_not_found, KW_FILE_NOT_FOUND},
    {ErrorCode::file_too_large, KW_FILE_TOO_LARGE},
    {ErrorCode::io_failed, KW_IO_FAILED},
    {ErrorCode::disk_full, KW_DISK_FULL},
    {ErrorCode::syntax, KW_SYNTAX},
    {ErrorCode::unknown_key, KW_UNKNOWN_KEY},
    {ErrorCode::missing_key, KW_MISSING_KEY},
    {ErrorCode::wrong_type, KW_WRONG_TYPE},
    {ErrorCode::value_out_of_range, KW_VALUE_OUT_OF_RANGE},
    {ErrorCode::unknown_name, KW_UNKNOWN_NAME},
    {ErrorCode::duplicate_name, KW_DUPLICATE_NAME},
    {ErrorCode::cyclic_reference, KW_CYCLIC_REFERENCE},
    {ErrorCode::unsupported_version, KW_UNSUPPORTED_VERSION},
    {ErrorCode::unsupported_format, KW_UNSUPPORTED_FORMAT},
    {ErrorCode::malformed, KW_MALFORMED},
    {ErrorCode::unsupported, KW_UNSUPPORTED},
};

kw_status status_of(ErrorCode code) noexcept {
  for (const Pair& pair : kPairs) {
    if (pair.code == code) return pair.status;
  }
  return KW_INTERNAL;
}

}  // namespace

kw_status report(kw_error** error, Error fault) noexcept {
  const kw_status status = status_of(fault.code);
  if (error == nullptr) return status;
  try {
    std::string text = fault.to_string();
    *error = new kw_error{
        status, std::move(fault.message), std::move(text), fault.source, fault.line, fault.column};
  } catch (...) {
    *error = nullptr;
    return KW_OUT_OF_MEMORY;
  }
  return status;
}

kw_status report(kw_error** error, kw_status status, std::string_view message) noexcept {
  if (error == nullptr) return status;
  try {
    std::string sentence(message);
    if (status == KW_NULL_ARGUMENT) sentence = "argument '" + sentence + "' is NULL";
    std::string text = "error: " + sentence;
    *error = new kw_error{status, std::move(sentence), std::move(text), {}, 0, 0};
  } catch (...) {
    *error = nullptr;
    return KW_OUT_OF_MEMORY;
  }
  return status;
}

const char* missing(std::initializer_list<Needed> needed) noexcept {
  for (const Needed& one : needed) {
    if (one.pointer == nullptr) return one.name;
  }
  return nullptr;
}

const Needed* endless(std::initializer_list<Needed> needed) noexcept {
  constexpr size_t kMost = PTRDIFF_MAX / sizeof(double);
  for (const Needed& one : needed) {
    if (one.count > kMost) return &one;
  }
  return nullptr;
}

std::optional<Error> count_fault(const char* what, size_t count, size_t most) {
  if (count <= most) return std::nullopt;
  return fail(ErrorCode::too_many_points, std::string(what) + " is " + std::to_string(count) +
                                              ", at most " + std::to_string(most) +
                                              " are possible");
}

Error one_place_for_two() {
  return fail(ErrorCode::malformed, "both outputs are one place: give each its own");
}

char* new_text(std::string_view text) {
  char* copy = new char[text.size() + 1];
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

kw_doubles new_doubles(std::span<const double> numbers) {
  if (numbers.empty()) return {nullptr, 0};
  double* copy = new double[numbers.size()];
  std::memcpy(copy, numbers.data(), numbers.size_bytes());
  return {copy, numbers.size()};
}

std::string missing_among(const char* name, const kw_curve* const* handles, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    if (handles[i] == nullptr) return std::string(name) + "[" + std::to_string(i) + "]";
  }
  return {};
}

std::vector<curves::NurbsCurve> curves_of(const kw_curve* const* handles, size_t count) {
  std::vector<curves::NurbsCurve> curves;
  for (size_t i = 0; i < count; ++i) curves.push_back(handles[i]->curve);
  return curves;
}

std::optional<Error> coordinate_fault(const curves::NurbsCurve& curve, int32_t coordinate) {
  if (coordinate >= 0 && coordinate < curve.dim()) return std::nullopt;
  return fail(ErrorCode::dimension_mismatch, "curve '" + curve.name() + "' has no coordinate " +
                                                 std::to_string(coordinate) + ", only 0 to " +
                                                 std::to_string(curve.dim() - 1));
}

Error unknown_choice(const char* what, int32_t choice, int32_t count) {
  return fail(ErrorCode::value_out_of_range, std::string(what) + " is " + std::to_string(choice) +
                                                 ", no number of 0 to " +
                                                 std::to_string(count - 1));
}

}  // namespace knotwave::c

using namespace knotwave;
using namespace knotwave::c;

const char* kw_status_name(kw_status status) {
  switch (status) {
    case KW_OK:
      return "ok";
    case KW_OUT_OF_MEMORY:
      return "out_of_memory";
    case KW_NULL_ARGUMENT:
      return "null_argument";
    case KW_INTERNAL:
      return "internal";
    default:
      break;
  }
  for (const auto& pair : kPairs) {
    if (pair.status == status) return base::to_string(pair.code);
  }
  return "unknown";
}

int32_t kw_version(void) { return KNOTWAVE_VERSION_NUMBER; }
int32_t kw_abi_version(void) { return KW_ABI_VERSION; }

kw_status kw_error_status(const kw_error* error) { return error ? error->status : KW_OK; }
const char* kw_error_message(const kw_error* error) { return error ? error->message.c_str() : ""; }
const char* kw_error_text(const kw_error* error) { return error ? error->text.c_str() : ""; }
const char* kw_error_source(const kw_error* error) { return error ? error->source.c_str() : ""; }
int32_t kw_error_line(const kw_error* error) { return error ? error->line : 0; }
int32_t kw_error_column(const kw_error* error) { return error ? error->column : 0; }
void kw_error_free(kw_error* error) { delete error; }

void kw_doubles_free(kw_doubles* doubles) {
  if (doubles == nullptr) return;
  delete[] doubles->numbers;
  *doubles = {nullptr, 0};
}

void kw_text_free(char* text) { delete[] text; }
