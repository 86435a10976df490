// SPDX-License-Identifier: MIT
#include "knotwave/base/utf8.h"

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

TEST(Utf8, TheFirstCodePointIsReadWithItsSize) {
  const struct {
    std::string_view text;
    std::uint32_t code;
    std::size_t size;
  } cases[] = {{"a", 'a', 1},
               {"\x7f", 0x7F, 1},
               {"\xC3\xBCx", 0xFC, 2},
               {"\xE2\x82\xAC", 0x20AC, 3},
               {"\xEF\xBF\xBD", 0xFFFD, 3},
               {"\xF0\x9F\x8E\xB5", 0x1F3B5, 4},
               {"\xF4\x8F\xBF\xBF", 0x10FFFF, 4}};
  for (const auto& c : cases) {
    EXPECT_EQ(first_code_point(c.text).code, c.code);
    EXPECT_EQ(first_code_point(c.text).size, c.size);
  }
}

TEST(Utf8, WhatIsNoUtf8HasNoSize) {
  for (const char* bytes :
       {"\x80", "\xBF", "\xC0\xAF", "\xC1\xBF", "\xE0\x80\xAF", "\xE2\x82", "\xED\xA0\x80",
        "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF", "\xC3x"}) {
    EXPECT_EQ(first_code_point(bytes).size, 0u) << bytes;
  }
}

TEST(Utf8, ControlsAreThoseATerminalObeys) {
  for (const std::uint32_t code : {0x00u, 0x1Bu, 0x7Fu, 0x9Bu, 0x200Fu, 0x202Eu, 0x2069u}) {
    EXPECT_TRUE(is_control(code)) << code;
  }
  for (const std::uint32_t code : {0x20u, 0x7Eu, 0xA0u, 0xFCu, 0x200Du, 0x2070u}) {
    EXPECT_FALSE(is_control(code)) << code;
  }
}

}  // namespace
}  // namespace knotwave::base
