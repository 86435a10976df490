// SPDX-License-Identifier: MIT
#include "knotwave/base/result.h"

#include <memory>
#include <set>

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

TEST(Result, HoldsAValueOrAnError) {
  const Result<int> value = 3;
  ASSERT_TRUE(value);
  EXPECT_EQ(*value, 3);
  const Result<int> error = fail(ErrorCode::syntax, "no");
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::syntax);
}

TEST(Result, MovesWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> value = std::make_unique<int>(7);
  const std::unique_ptr<int> taken = std::move(value).value();
  EXPECT_EQ(*taken, 7);
}

TEST(Result, OfVoidIsSuccessUnlessGivenAnError) {
  EXPECT_TRUE(Result<void>());
  const Result<void> error = fail(ErrorCode::io_failed, "no");
  EXPECT_FALSE(error);
  EXPECT_EQ(error.error().message, "no");
}

TEST(Result, OfTheSameTypeAsItsErrorTextIsNotConfused) {
  const Result<std::string> text = std::string("error");
  EXPECT_TRUE(text);
}

TEST(Error, TextLeavesOutWhatIsUnknown) {
  Error error = fail(ErrorCode::knots_decrease, "knot 5 (0.4) is below knot 4 (0.5)");
  EXPECT_EQ(error.to_string(), "error: knot 5 (0.4) is below knot 4 (0.5)");
  error.source = "file.toml";
  EXPECT_EQ(error.to_string(), "file.toml: error: knot 5 (0.4) is below knot 4 (0.5)");
  error.line = 12;
  EXPECT_EQ(error.to_string(), "file.toml:12: error: knot 5 (0.4) is below knot 4 (0.5)");
  error.column = 8;
  EXPECT_EQ(error.to_string(), "file.toml:12:8: error: knot 5 (0.4) is below knot 4 (0.5)");
}

TEST(Error, OfABinaryFileNamesTheByte) {
  Error error = fail(ErrorCode::malformed, "no header");
  error.offset = 12;
  EXPECT_EQ(error.to_string(), "byte 12: error: no header");
  error.source = "file.mid";
  EXPECT_EQ(error.to_string(), "file.mid: byte 12: error: no header");
}

TEST(Error, TextHoldsNoControlCharacters) {
  Error error = fail(ErrorCode::unknown_key, "unknown key '\x1b[2Ja\n'");
  error.source = "x\ty";
  EXPECT_EQ(error.to_string(), "x\\x09y: error: unknown key '\\x1b[2Ja\\x0a'");
}

TEST(Error, LongWordsAndMessagesLoseTheirMiddle) {
  const std::string key(900'000, 'k');
  const std::string text =
      fail(ErrorCode::unknown_key, "curve: unknown key '" + key + "'").to_string();
  EXPECT_EQ(text, "error: curve: unknown key '" + std::string(52, 'k') + "..." +
                      std::string(23, 'k') + "'");
  std::string names;
  for (int i = 0; i < 1000; ++i) names += ", curve" + std::to_string(i);
  EXPECT_LT(fail(ErrorCode::unknown_name, names).to_string().size(), 2100u);
  const std::string path = "'/" + std::string(60, 'a') + "/" + std::string(60, 'b') + "'";
  EXPECT_EQ(fail(ErrorCode::io_failed, path).to_string(), "error: " + path) << "a path is kept";
  std::string umlauts;
  for (int i = 0; i < 100; ++i) umlauts += "\xc3\xa4";
  EXPECT_EQ(fail(ErrorCode::io_failed, "x" + umlauts).to_string().size(), 7u + 53 + 3 + 24);
}

TEST(ErrorCode, EveryCodeHasItsOwnName) {
  std::set<std::string> names;
  const int count = static_cast<int>(ErrorCode::unsupported) + 1;
  for (int i = 0; i < count; ++i) names.insert(to_string(static_cast<ErrorCode>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(count));
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_STREQ(to_string(ErrorCode::knots_decrease), "knots_decrease");
}

#ifdef KNOTWAVE_ASSERTS
TEST(ResultDeathTest, ReadingTheWrongSideIsAProgrammingError) {
  const Result<int> error = fail(ErrorCode::syntax, "no");
  EXPECT_DEATH(static_cast<void>(*error), "assertion failed");
  const Result<int> value = 3;
  EXPECT_DEATH(static_cast<void>(value.error()), "assertion failed");
}
#endif

}  // namespace
}  // namespace knotwave::base
