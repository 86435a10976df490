// SPDX-License-Identifier: MIT
// What our programs end with.
#pragma once
#include "knotwave/base/result.h"

namespace knotwave::command_line {

inline constexpr int kExitOk = 0;
inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitTryAgain = 75;  ///< sysexits.h EX_TEMPFAIL: batch queues retry it
inline constexpr int kExitInterrupted = 130;

constexpr int exit_code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return kExitUsage;
    case ErrorCode::disk_full:
      return kExitTryAgain;
    case ErrorCode::interrupted:
      return kExitInterrupted;
    default:
      return kExitFailure;
  }
}

}  // namespace knotwave::command_line
