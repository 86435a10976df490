// SPDX-License-Identifier: MIT
// What our programs print when something is wrong.
#pragma once
#include <string>
#include <string_view>

#include "knotwave/base/result.h"

namespace knotwave::command_line {

/// `PROGRAM: MESSAGE` and where help is, on standard error. Returns kExitUsage.
int say_usage(std::string_view program, const std::string& message);

/// The error on standard error, behind the program's name if it names no file. Returns its exit
/// code.
int say_error(std::string_view program, const Error& error);

}  // namespace knotwave::command_line
