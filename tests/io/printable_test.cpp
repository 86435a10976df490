// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {
namespace {

TEST(Printable, PlainTextStays) { EXPECT_EQ(printable("Für Elise, 3/8"), "Für Elise, 3/8"); }

TEST(Printable, ControlCharactersAndEscapesAreReplaced) {
  EXPECT_EQ(printable("a\x1b[31mb\r\n\x7f"), "a?[31mb???");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "?31m")
      << "the 8-bit escape";
  EXPECT_EQ(printable("\xE2\x80\xAE"
                      "dim"),
            "?dim")
      << "right-to-left override";
}

TEST(Printable, BadUtf8IsReplacedByteByByte) {
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(printable("\xFF\xFE"), mark + mark);
  EXPECT_EQ(printable("\xC0\xAF"), mark + mark) << "overlong";
  EXPECT_EQ(printable("\xED\xA0\x80"), mark + mark + mark) << "surrogate";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), mark + mark + mark + mark) << "past U+10FFFF";
  EXPECT_EQ(printable("a\xE2\x82"), "a" + mark + mark) << "cut off";
}

TEST(Printable, LongTextIsCutAtCodePoints) {
  EXPECT_EQ(printable("äöü", 2), "äö…");
  EXPECT_EQ(printable("äöü", 3), "äöü");
}

}  // namespace
}  // namespace knotwave::io
