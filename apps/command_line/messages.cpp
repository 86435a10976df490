// SPDX-License-Identifier: MIT
#include "command_line/messages.h"

#include <cstdio>

#include "command_line/exit_codes.h"

namespace knotwave::command_line {

int say_usage(std::string_view program, const std::string& message) {
  const std::string name(program);
  std::fprintf(stderr, "%s: %s\nTry '%s --help'.\n", name.c_str(), message.c_str(), name.c_str());
  return kExitUsage;
}

int say_error(std::string_view program, const Error& error) {
  const std::string prefix = error.source.empty() ? std::string(program) + ": " : "";
  std::fprintf(stderr, "%s%s\n", prefix.c_str(), error.to_string().c_str());
  return exit_code_of(error.code);
}

}  // namespace knotwave::command_line
