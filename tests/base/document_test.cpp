// SPDX-License-Identifier: MIT
#include "knotwave/base/document.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

std::string error_of(std::string_view text) {
  const Result<Node> parsed = parse_document(text, "file.toml");
  return parsed ? "accepted" : parsed.error().to_string();
}

std::string repeat(std::string_view text, std::size_t count) {
  std::string all;
  while (count-- > 0) all += text;
  return all;
}

Node parse(std::string_view text) {
  Result<Node> parsed = parse_document(text, "file.toml");
  EXPECT_TRUE(parsed) << parsed.error().to_string();
  return parsed ? std::move(*parsed) : Node{};
}

TEST(Document, MembersKeepTheOrderOfTheFile) {
  const Node root = parse("z = 1\na = 2\n[m.y]\nk = 'v'\n[m.b]\n[c]\n");
  ASSERT_EQ(root.members.size(), 4u);
  EXPECT_EQ(root.members[0].key, "z");
  EXPECT_EQ(root.members[1].key, "a");
  EXPECT_EQ(root.members[2].key, "m");
  EXPECT_EQ(root.members[3].key, "c");
  EXPECT_EQ(root.members[2].value.members[0].key, "y");
  EXPECT_EQ(root.members[2].value.members[1].key, "b");
}

TEST(Document, HasEveryKindOfValue) {
  const Node root = parse("s = 'x'\ni = -3\nr = 0.5\nb = true\na = [1, 2.5]\nt = { k = 1 }\n");
  EXPECT_EQ(root.find("s")->text, "x");
  EXPECT_EQ(root.find("i")->integer, -3);
  EXPECT_EQ(root.find("i")->number, -3.0);
  EXPECT_EQ(root.find("r")->kind, Node::Kind::real);
  EXPECT_EQ(root.find("r")->number, 0.5);
  EXPECT_TRUE(root.find("b")->boolean);
  EXPECT_EQ(root.find("a")->items[1].number, 2.5);
  EXPECT_EQ(root.find("t")->find("k")->integer, 1);
  EXPECT_EQ(root.find("none"), nullptr);
}

TEST(Document, KnowsWhereKeysAndValuesStand) {
  const Node root = parse("# comment\r\n\r\n  key = [ 1,\r\n    2 ]\r\n[table]\r\nx.y = 'é'\r\n");
  EXPECT_EQ(root.members[0].line, 3);
  EXPECT_EQ(root.members[0].column, 3);
  EXPECT_EQ(root.members[0].value.column, 9);
  EXPECT_EQ(root.members[0].value.items[1].line, 4);
  EXPECT_EQ(root.members[0].value.items[1].column, 5);
  EXPECT_EQ(root.members[1].value.line, 5);
  const Node& x = *root.find("table")->find("x");
  EXPECT_EQ(x.line, 6);
  EXPECT_EQ(x.members[0].value.column, 7);
}

TEST(Document, DottedKeysAndHeadersMakeTheSameTree) {
  const Node dotted = parse("a.b.c = 1\n");
  const Node headed = parse("[a.b]\nc = 1\n");
  EXPECT_EQ(dotted.find("a")->find("b")->find("c")->integer, 1);
  EXPECT_EQ(headed.find("a")->find("b")->find("c")->integer, 1);
}

TEST(Document, AByteOrderMarkIsAccepted) {
  EXPECT_EQ(parse("\xEF\xBB\xBF"
                  "a = 1")
                .find("a")
                ->integer,
            1);
  EXPECT_EQ(error_of("\xEF\xBB\xBF"
                     "a = nan"),
            "file.toml:1:5: error: a number must be finite; nan and inf are not allowed");
}

TEST(Document, EmptyTextIsAnEmptyTable) {
  EXPECT_TRUE(parse("").members.empty());
  EXPECT_EQ(parse("").line, 1);
}

struct Fault {
  const char* text;
  const char* error;
};

TEST(Document, FaultsAreNamedWithLineAndColumn) {
  constexpr std::string_view kNotFinite = "a number must be finite; nan and inf are not allowed";
  EXPECT_EQ(error_of("a = [1, -inf]"), "file.toml:1:9: error: " + std::string(kNotFinite));
  constexpr std::array kFaults = {
      Fault{"a = 1\nb = 1979-05-27", "2:5: error: dates and times have no meaning here"},
      Fault{"a = 07:32:00", "1:5: error: dates and times have no meaning here"},
      Fault{"[a]\nx=1\n[a]\n", "3:1: error: table header: cannot redefine existing table 'a'"},
      Fault{"a = 1\na = 3\n", "2:5: error: key-value pair: cannot redefine existing integer 'a'"},
      Fault{"a.b = 1\na = 2\n", "2:5: error: key-value pair: cannot redefine existing table 'a'"},
      Fault{"a = 1\r\nb = \r\n", "2:5: error: key-value pair: expected value, saw '\\r'"},
      Fault{"a = '\xff'", "1:5: error: encountered invalid utf-8 sequence"},
      Fault{"x = 1\na = '\xc0\x80'", "2:5: error: encountered invalid utf-8 sequence"},
      Fault{"a = 1e999", "1:10: error: floating-point: '1e999' is not representable in 64 bits"},
      Fault{"a = [1,,2]", "1:8: error: array: expected value or closing ']', saw comma"},
      Fault{"a = \"x", "1:7: error: string: encountered end-of-file"},
      Fault{"[a", "1:3: error: table header: encountered end-of-file"},
  };
  for (const Fault& fault : kFaults) {
    EXPECT_EQ(error_of(fault.text), "file.toml:" + std::string(fault.error)) << fault.text;
  }
}

TEST(Document, CodesTellSyntaxFromTypeFromSize) {
  const auto code_of = [](const std::string& text) {
    return parse_document(text, "").error().code;
  };
  EXPECT_EQ(code_of("a ="), ErrorCode::syntax);
  EXPECT_EQ(code_of("a = inf"), ErrorCode::syntax);
  EXPECT_EQ(code_of("a = 1979-05-27"), ErrorCode::wrong_type);
  EXPECT_EQ(code_of(repeat("#", kMaxDocumentBytes + 1)), ErrorCode::file_too_large);
  EXPECT_TRUE(parse_document(repeat("#", kMaxDocumentBytes), ""));
}

TEST(Document, NestingIsBoundedForBracketsBracesAndDots) {
  EXPECT_EQ(error_of("a=" + repeat("[", 32) + repeat("]", 32)), "accepted");
  EXPECT_EQ(error_of("a=" + repeat("[", 33) + repeat("]", 33)),
            "file.toml:1:35: error: nested deeper than 32 levels");
  EXPECT_EQ(error_of("a" + repeat(".a", 31) + "=1"), "accepted");
  EXPECT_NE(error_of("a" + repeat(".a", 32) + "=1"), "accepted");
  EXPECT_EQ(error_of("x = '[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[' # " + repeat("[", 99)),
            "accepted");
  EXPECT_EQ(error_of("x = \"\"\"\n\\\"" + repeat("[", 99) + "\"\"\"\"\"\n"), "accepted");
}

TEST(Document, AMebibyteOfNestingIsRefusedAtOnce) {
  const std::string deep = "nested deeper than 32 levels";
  for (const std::string& text :
       {repeat("[", kMaxDocumentBytes), "a=" + repeat("[", 1000000), "a=" + repeat("{a=", 340000),
        "a" + repeat(".a", 500000) + "=1", "[" + repeat("a.", 500000) + "a]",
        "\"a\"" + repeat(".'a'", 250000) + "=1",
        repeat("a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a={", 31) + "a=1" + repeat("}", 31)}) {
    const Result<Node> parsed = parse_document(text, "");
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.error().message, deep) << text.substr(0, 20);
  }
}

TEST(Document, MessagesQuoteAtMostALine) {
  EXPECT_LT(error_of("a = " + repeat("9", 500000)).size(), 300u);
  EXPECT_LT(error_of("a = 1\n" + repeat("k", 500000) + " = ?").size(), 300u);
}

TEST(TableReader, ReadsEveryKind) {
  const Node root = parse("n = 0.5\ni = 3\nb = true\ns = 'x'\nc = 'two'\nv = [1, 2.5]\nt = {}\n");
  TableReader reader(root, "file.toml", "patch");
  EXPECT_EQ(reader.number("n", 1, 0, 1), 0.5);
  EXPECT_EQ(reader.number("i", 0, 10), 3.0);
  EXPECT_EQ(reader.integer("i", 1, 1, 15), 3);
  EXPECT_TRUE(reader.boolean("b", false));
  EXPECT_EQ(reader.string("s"), "x");
  EXPECT_EQ(reader.choice("c", 0, {"one", "two"}), 1);
  EXPECT_EQ(reader.numbers("v"), (std::vector<double>{1, 2.5}));
  EXPECT_NE(reader.table("t"), nullptr);
  EXPECT_TRUE(reader.ok());
  EXPECT_TRUE(reader.finish());
}

TEST(TableReader, AbsentMembersGiveTheirFallback) {
  const Node root = parse("");
  TableReader reader(root, "file.toml", "patch");
  EXPECT_EQ(reader.number("n", 0.25, 0, 1), 0.25);
  EXPECT_EQ(reader.integer("i", 7, 1, 15), 7);
  EXPECT_TRUE(reader.boolean("b", true));
  EXPECT_EQ(reader.string("s", "y"), "y");
  EXPECT_EQ(reader.choice("c", 1, {"one", "two"}), 1);
  EXPECT_TRUE(reader.numbers("v").empty());
  EXPECT_EQ(reader.table("t"), nullptr);
  EXPECT_EQ(reader.array("a"), nullptr);
  EXPECT_TRUE(reader.finish());
}

/// The error of reading one member of `text` by `read`.
template <class Read>
std::string reading(const char* text, Read read) {
  const Node root = parse(text);
  TableReader reader(root, "file.toml", "curve 'bell'");
  read(reader);
  const Result<void> end = reader.finish();
  return end ? "accepted" : end.error().to_string();
}

TEST(TableReader, WrongMembersAreNamedWithTheirPlace) {
  const auto at = [](const char* rest) {
    return "file.toml:1:5: error: curve 'bell': " + std::string(rest);
  };
  EXPECT_EQ(reading("k = 'x'", [](TableReader& r) { r.number("k", 0, 0, 1); }),
            at("k must be a number, not a string"));
  EXPECT_EQ(reading("k = 1.5", [](TableReader& r) { r.number("k", 0, 0, 1); }),
            at("k is 1.5; it must be in 0 to 1"));
  EXPECT_EQ(reading("k = 2.0", [](TableReader& r) { r.integer("k", 0, 0, 9); }),
            at("k must be a whole number, not a decimal number"));
  EXPECT_EQ(reading("k = 16", [](TableReader& r) { r.integer("k", 1, 1, 15); }),
            at("k is 16; it must be in 1 to 15"));
  EXPECT_EQ(reading("k = 9223372036854775807", [](TableReader& r) { r.integer("k", 1, 1, 15); }),
            at("k is 9223372036854775807; it must be in 1 to 15"));
  EXPECT_EQ(reading("k = 1", [](TableReader& r) { r.boolean("k", true); }),
            at("k must be true or false, not a whole number"));
  EXPECT_EQ(reading("k = [1]", [](TableReader& r) { r.string("k"); }),
            at("k must be a string, not an array"));
  EXPECT_EQ(reading("k = 'tow'",
                    [](TableReader& r) {
                      r.choice("k", 0, {"one", "two"});
                    }),
            at("k is 'tow'; it must be one of one, two; did you mean 'two'?"));
  EXPECT_EQ(reading("k = 1", [](TableReader& r) { r.numbers("k"); }),
            at("k must be an array, not a whole number"));
  EXPECT_EQ(reading("k = 1", [](TableReader& r) { r.table("k"); }),
            at("k must be a table, not a whole number"));
  EXPECT_EQ(reading("k = [1, 'x']", [](TableReader& r) { r.numbers("k"); }),
            "file.toml:1:9: error: curve 'bell': k[1] must be a number, not a string");
}

TEST(TableReader, WhatIsRequiredAndMissingIsNamedAtItsTable) {
  const Node root = parse("\n[curve]\nx = 1\n");
  TableReader reader(*root.find("curve"), "file.toml", "curve 'bell'");
  EXPECT_EQ(reader.number("degree", 1, 15), 1);
  EXPECT_EQ(reader.finish().error().to_string(),
            "file.toml:2:1: error: curve 'bell': 'degree' is missing");
}

TEST(TableReader, UnknownKeysGetASuggestion) {
  const auto read = [](TableReader& r) {
    r.integer("degree", 1, 1, 15);
    r.numbers("weights");
  };
  EXPECT_EQ(reading("degree = 3\nwieghts = [1, 2]\n", read),
            "file.toml:2:1: error: curve 'bell': unknown key 'wieghts'; did you mean 'weights'?");
  EXPECT_EQ(reading("degree = 3\nsustain = 1\n", read),
            "file.toml:2:1: error: curve 'bell': unknown key 'sustain'");
}

TEST(TableReader, TheFirstErrorIsKeptAndReadingGoesOn) {
  const Node root = parse("a = 'x'\nb = 'y'\nc = 4\nunknown = 1\n");
  TableReader reader(root, "file.toml", "patch");
  EXPECT_EQ(reader.number("a", 7, 0, 1), 7);
  EXPECT_EQ(reader.number("b", 8, 0, 1), 8);
  EXPECT_EQ(reader.integer("c", 0, 0, 9), 4);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.finish().error().to_string(),
            "file.toml:1:5: error: patch: a must be a number, not a string");
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(number_text(1), "1");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(1e22), "1e+22");
  EXPECT_EQ(number_text(5e-324), "5e-324");
  EXPECT_EQ(number_text(-2.2250738585072014e-308), "-2.2250738585072014e-308");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace knotwave::base
