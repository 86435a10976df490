// SPDX-License-Identifier: MIT
#include "command_line/output.h"

#include <span>

#include <fcntl.h>

#include "knotwave/base/file.h"

#include "command_line/exit_codes.h"
#include "command_line/messages.h"

namespace knotwave::command_line {

namespace {
bool input_closed = false;
}  // namespace

void guard_standard_streams() {
  for (const int stream : {0, 1, 2}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    if (stream == 0) input_closed = true;
    ::open("/dev/null", O_RDONLY);  // takes the lowest number that is free: those below are not
  }
}

bool is_standard_input_closed() { return input_closed; }

int print(std::string_view program, std::string_view text) {
  const auto written = base::write_to_standard_output(std::as_bytes(std::span(text)));
  return written ? kExitOk : say_error(program, written.error());
}

}  // namespace knotwave::command_line
