// SPDX-License-Identifier: MIT
// What every parser promises, checked in all builds.
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

namespace knotwave::fuzz {

/// An error says what and where; only a file that is too large has no line.
inline void check_error(const Error& error) {
  FUZZ_CHECK(!error.message.empty());
  FUZZ_CHECK(!error.source.empty());
  if (error.code == ErrorCode::file_too_large) return;
  FUZZ_CHECK(error.line >= 1);
  FUZZ_CHECK(error.column >= 1);
}

}  // namespace knotwave::fuzz
