// SPDX-License-Identifier: MIT
#include "knotwave/base/document.h"

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

std::string error_of(std::string_view text) {
  const Result<Node> parsed = parse_document(text, "file.toml");
  return parsed ? "accepted" : parsed.error().to_string();
}

TEST(Document, MembersKeepTheOrderOfTheFile) {
  const Result<Node> parsed = parse_document("z = 1\na = 2\n[m.y]\nk = 'v'\n[m.b]\n", "");
  ASSERT_TRUE(parsed) << parsed.error().to_string();
  ASSERT_EQ(parsed->members.size(), 3u);
  EXPECT_EQ(parsed->members[0].key, "z");
  EXPECT_EQ(parsed->members[1].key, "a");
  EXPECT_EQ(parsed->members[2].key, "m");
  EXPECT_EQ(parsed->members[2].value.members[0].key, "y");
}

TEST(Document, ErrorsSayWhere) {
  EXPECT_EQ(error_of("a = nan"),
            "file.toml:1:5: error: a number must be finite; nan and inf are not allowed");
  EXPECT_EQ(error_of("a = 1\nb = 1979-05-27"),
            "file.toml:2:5: error: dates and times have no meaning here");
}

TEST(TableReader, ReportsTheFirstUnknownKeyWithASuggestion) {
  const Result<Node> parsed = parse_document("degree = 3\nwieghts = [1, 2]\n", "file.toml");
  ASSERT_TRUE(parsed);
  TableReader reader(*parsed, "file.toml", "curve 'bell'");
  EXPECT_EQ(reader.integer("degree", 1, 1, 15), 3);
  EXPECT_TRUE(reader.numbers("weights").empty());
  EXPECT_EQ(reader.finish().error().to_string(),
            "file.toml:2:1: error: curve 'bell': unknown key 'wieghts'; did you mean 'weights'?");
}

}  // namespace
}  // namespace knotwave::base
