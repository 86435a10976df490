// SPDX-License-Identifier: MIT
#include "command_line/output.h"

#include <span>

#include "knotwave/base/file.h"

#include "command_line/exit_codes.h"
#include "command_line/messages.h"

namespace knotwave::command_line {

int print(std::string_view program, std::string_view text) {
  const auto written = base::write_to_standard_output(std::as_bytes(std::span(text)));
  return written ? kExitOk : say_error(program, written.error());
}

}  // namespace knotwave::command_line
