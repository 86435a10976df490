// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <string_view>

namespace knotwave::plugins {

/// As much of a text as there is room for, and its end.
inline void put(char* out, std::size_t room, std::string_view text) {
  if (room == 0) return;
  const std::size_t size = std::min(text.size(), room - 1);
  std::copy_n(text.data(), size, out);
  out[size] = '\0';
}
template <std::size_t n>
void put(char (&out)[n], std::string_view text) {
  put(out, n, text);
}

}  // namespace knotwave::plugins
