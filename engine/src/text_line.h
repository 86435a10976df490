// SPDX-License-Identifier: MIT
// A text of a file that is shown as it is. [control]
#pragma once
#include <algorithm>
#include <string>

#include "knotwave/base/document.h"

namespace knotwave::engine {

/// The string at `key`, empty without. Control characters in it are a fault: a line end would make
/// lines that a program never said, an escape would paint the terminal.
inline std::string read_text_line(base::TableReader& reader, const char* key) {
  std::string text = reader.string(key, "");
  const auto found = std::find_if(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
  if (found == text.end()) return text;
  constexpr const char* kHex = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(*found);
  reader.fail_at(*reader.node(key), ErrorCode::malformed,
                 std::string(key) + " has a control character (U+00" + kHex[byte >> 4] +
                     kHex[byte & 15] + "); it is one line of text");
  return {};
}

}  // namespace knotwave::engine
