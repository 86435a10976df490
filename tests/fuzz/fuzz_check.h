// SPDX-License-Identifier: MIT
// What is promised, checked in all builds.
#pragma once
#include <cstdio>
#include <cstdlib>

#include "knotwave/base/result.h"

#define FUZZ_CHECK(claim)                                                      \
  do {                                                                         \
    if (!(claim)) {                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #claim); \
      std::abort();                                                            \
    }                                                                          \
  } while (false)

/// a <= b, and what they are if not.
#define FUZZ_CHECK_AT_MOST(a, b)                                                                \
  do {                                                                                          \
    const double fuzz_a = (a), fuzz_b = (b);                                                    \
    if (!(fuzz_a <= fuzz_b)) {                                                                  \
      std::fprintf(stderr, "%s:%d: not so: %s (%.17g) <= %s (%.17g)\n", __FILE__, __LINE__, #a, \
                   fuzz_a, #b, fuzz_b);                                                         \
      std::abort();                                                                             \
    }                                                                                           \
  } while (false)

namespace knotwave::fuzz {

/// What a parser says went wrong, and where; only a file that is too large has no line.
inline void check_error(const Error& error) {
  FUZZ_CHECK(!error.message.empty());
  FUZZ_CHECK(!error.source.empty());
  if (error.code == ErrorCode::file_too_large) return;
  FUZZ_CHECK(error.line >= 1);
  FUZZ_CHECK(error.column >= 1);
}

}  // namespace knotwave::fuzz
