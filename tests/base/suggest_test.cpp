// SPDX-License-Identifier: MIT
#include "knotwave/base/suggest.h"

#include <array>

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

constexpr std::array<std::string_view, 5> kKeys = {"degree", "points", "weights", "knots",
                                                   "periodic"};

TEST(Suggest, OneEditOfAnyKindFindsTheWord) {
  EXPECT_EQ(nearest_word("wieghts", kKeys), "weights");   // swap
  EXPECT_EQ(nearest_word("weight", kKeys), "weights");    // missing
  EXPECT_EQ(nearest_word("weightss", kKeys), "weights");  // too many
  EXPECT_EQ(nearest_word("wejghts", kKeys), "weights");   // replaced
  EXPECT_EQ(nearest_word("knots", kKeys), "knots");
}

TEST(Suggest, AnEarlierWordWinsATie) {
  constexpr std::array<std::string_view, 2> kTie = {"pans", "pats"};
  EXPECT_EQ(nearest_word("pas", kTie), "pans");
}

TEST(Suggest, CaseDoesNotCount) {
  EXPECT_EQ(nearest_word("WEIGHTS", kKeys), "weights");
  EXPECT_EQ(nearest_word("Knot", kKeys), "knots");
}

TEST(Suggest, TheOnlyWordThatBeginsSoIsMeant) {
  constexpr std::array<std::string_view, 3> kLong = {"release_at", "release_velocity",
                                                     "sustain_at"};
  EXPECT_EQ(nearest_word("sus", kLong), "sustain_at");
  EXPECT_EQ(nearest_word("su", kLong), "") << "two letters say too little";
  EXPECT_EQ(nearest_word("rel", kLong), "") << "two words begin so";
}

TEST(Suggest, AWordThatBeginsWithAKnownOneMeansTheLongestSuch) {
  constexpr std::array<std::string_view, 5> kWords = {"mod", "saw", "key", "key_octaves", "cc"};
  EXPECT_EQ(nearest_word("modwheel", kWords), "mod");
  EXPECT_EQ(nearest_word("Sawtooth", kWords), "saw");
  EXPECT_EQ(nearest_word("key_octaves_high", kWords), "key_octaves");
  EXPECT_EQ(nearest_word("ccontrol", kWords), "") << "two letters say too little";
}

TEST(Suggest, WhatOthersCallItIsMeantWhereItIsKnown) {
  constexpr std::array<std::string_view, 3> kWords = {"bend", "square", "pitched"};
  constexpr std::array<Synonym, 3> kSynonyms = {
      {{"pitchbend", "bend"}, {"sqr", "square"}, {"wheel", "mod"}}};
  EXPECT_EQ(suggestion("sqr", kWords, kSynonyms), "; did you mean 'square'?");
  for (const char* word : {"pitchbend", "pitch_bend", "Pitch-Bend", "pitch bend"}) {
    EXPECT_EQ(suggestion(word, kWords, kSynonyms), "; did you mean 'bend'?") << word;
  }
  EXPECT_EQ(suggestion("wheel", kWords, kSynonyms), "") << "there is no mod here";
  EXPECT_EQ(suggestion("benf", kWords, kSynonyms), "; did you mean 'bend'?");
  EXPECT_EQ(suggestion(std::string(100000, 'w'), kWords, kSynonyms), "");
}

TEST(Suggest, WhatIsTooFarIsNotSuggested) {
  EXPECT_EQ(nearest_word("sustain", kKeys), "");
  EXPECT_EQ(nearest_word("", kKeys), "");
  EXPECT_EQ(nearest_word("zz", kKeys), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'w'), kKeys), "");
  EXPECT_EQ(nearest_word("knots", {}), "");
}

TEST(Suggest, AWordThatDiffersInMoreThanAThirdIsAnother) {
  constexpr std::array<std::string_view, 4> kCommands = {"check", "info", "eval", "plot"};
  for (const char* word : {"split", "part", "fit", "elevate", "morph", "join"}) {
    EXPECT_EQ(nearest_word(word, kCommands), "") << word;
  }
  EXPECT_EQ(nearest_word("plto", kCommands), "plot");
  constexpr std::array<std::string_view, 1> kLong = {"polyphony"};
  EXPECT_EQ(nearest_word("polyfony", kLong), "polyphony") << "two of nine letters";
}

TEST(Suggest, SeveralWordsThatBeginSoAreAllNamed) {
  constexpr std::array<std::string_view, 5> kCurves = {"decay60", "decay60_light", "bell-low",
                                                       "bell-high", "bell-mid"};
  EXPECT_EQ(suggestion("deca", kCurves), "; did you mean 'decay60' or 'decay60_light'?");
  EXPECT_EQ(suggestion("bell", kCurves), "; did you mean 'bell-low', 'bell-high' or 'bell-mid'?");
  constexpr std::array<std::string_view, 4> kMany = {"wave-a", "wave-b", "wave-c", "wave-d"};
  EXPECT_EQ(suggestion("wav", kMany), "") << "four are a list";
}

TEST(Suggest, TextIsReadyToAppend) {
  EXPECT_EQ(suggestion("knot", kKeys), "; did you mean 'knots'?");
  EXPECT_EQ(suggestion("sustain", kKeys), "");
}

}  // namespace
}  // namespace knotwave::base
