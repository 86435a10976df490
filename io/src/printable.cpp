// SPDX-License-Identifier: MIT
#include "knotwave/base/utf8.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::io {
namespace {

constexpr std::string_view kEllipsis = "\xE2\x80\xA6";

}  // namespace

std::string printable(std::string_view text, std::size_t max_chars) {
  std::string out;
  for (std::size_t chars = 0; !text.empty(); ++chars) {
    if (chars == max_chars) return out.append(kEllipsis);
    const auto [code, size] = base::first_code_point(text);
    if (size == 0) {
      out.append(base::kReplacementCharacter);
    } else if (base::is_control(code)) {
      out.push_back('?');
    } else {
      out.append(text.substr(0, size));
    }
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return out;
}

}  // namespace knotwave::io
