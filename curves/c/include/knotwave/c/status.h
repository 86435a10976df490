// SPDX-License-Identifier: MIT
// How calls of the C interface fail, its version, and the memory it hands out. See
// knotwave/curves.h for the rules.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What is seen from outside the shared library. */
#if defined(_WIN32) && defined(KNOTWAVE_CURVES_C_BUILT_HERE)
#define KW_API __declspec(dllexport)
#elif defined(_WIN32)
#define KW_API __declspec(dllimport)
#else
#define KW_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
#define KW_BEGIN extern "C" {
#define KW_END }
#else
#define KW_BEGIN
#define KW_END
#endif

#define KW_VERSION_MAJOR 0
#define KW_VERSION_MINOR 1
#define KW_VERSION_PATCH 0
/// What this header was written for; a program may compare it with kw_abi_version().
#define KW_ABI_VERSION 1

KW_BEGIN

/// What went wrong; a name never changes its number.
typedef int32_t kw_status;
enum {
  KW_OK = 0,
  KW_OUT_OF_MEMORY = 1,  ///< no error object is made
  KW_NULL_ARGUMENT = 2,  ///< a pointer that is needed is NULL
  KW_INTERNAL = 3,       ///< a fault of the library: please report it
  // Curves.
  KW_DEGREE_OUT_OF_RANGE = 10,
  KW_TOO_FEW_POINTS = 11,
  KW_TOO_MANY_POINTS = 12,
  KW_DIMENSION_MISMATCH = 13,
  KW_KNOT_COUNT_MISMATCH = 14,
  KW_KNOTS_DECREASE = 15,
  KW_KNOT_MULTIPLICITY = 16,
  KW_EMPTY_DOMAIN = 17,
  KW_WEIGHT_COUNT_MISMATCH = 18,
  KW_WEIGHT_NOT_POSITIVE = 19,
  KW_WEIGHT_OUT_OF_RANGE = 20,
  KW_COORDINATE_OUT_OF_RANGE = 21,
  KW_NOT_FINITE = 22,
  KW_PARAMETER_OUT_OF_RANGE = 23,
  KW_NOT_A_FUNCTION = 24,
  KW_NOT_SCALAR = 25,
  KW_NOT_CLOSED = 26,
  KW_ERROR_BOUND_MISSED = 27,
  KW_CONTROL_CONFLICT = 28,
  // Files.
  KW_FILE_NOT_FOUND = 40,
  KW_FILE_TOO_LARGE = 41,
  KW_IO_FAILED = 42,
  KW_DISK_FULL = 43,
  KW_SYNTAX = 44,
  KW_UNKNOWN_KEY = 45,
  KW_MISSING_KEY = 46,
  KW_WRONG_TYPE = 47,
  KW_VALUE_OUT_OF_RANGE = 48,
  KW_UNKNOWN_NAME = 49,
  KW_DUPLICATE_NAME = 50,
  KW_CYCLIC_REFERENCE = 51,
  KW_UNSUPPORTED_VERSION = 52,
  KW_UNSUPPORTED_FORMAT = 53,
  KW_MALFORMED = 54,
  KW_UNSUPPORTED = 55
};

/// The status as a word, such as "knots_decrease"; "unknown" for any other number. [any]
KW_API const char* kw_status_name(kw_status status);

/// Version of the library that is running: 10000 major + 100 minor + patch. [any]
KW_API int32_t kw_version(void);
/// KW_ABI_VERSION of the library that is running. [any]
KW_API int32_t kw_abi_version(void);

typedef struct kw_error kw_error;

KW_API kw_status kw_error_status(const kw_error* error);
/// One sentence with the names, indexes and numbers at fault. Borrowed.
KW_API const char* kw_error_message(const kw_error* error);
/// The same with its place in front, fit for a terminal: `file.toml:12:8: error: ...`. Borrowed.
KW_API const char* kw_error_text(const kw_error* error);
/// The file at fault, or "". Borrowed.
KW_API const char* kw_error_source(const kw_error* error);
/// From 1; 0 if unknown.
KW_API int32_t kw_error_line(const kw_error* error);
KW_API int32_t kw_error_column(const kw_error* error);
/// NULL is allowed, here and in every other _free.
KW_API void kw_error_free(kw_error* error);

/// Numbers the library made. Rows follow each other where a function gives several a place.
typedef struct kw_doubles {
  double* numbers;
  size_t count;
} kw_doubles;
/// Frees the numbers and makes it empty.
KW_API void kw_doubles_free(kw_doubles* doubles);

/// Frees a text that came through an argument `char** out`.
KW_API void kw_text_free(char* text);

KW_END
