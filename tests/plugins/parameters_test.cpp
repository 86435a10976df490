// SPDX-License-Identifier: MIT
#include "knotwave/plugins/parameters.h"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/engine/map_slots.h"
#include "knotwave/plugins/instrument.h"

#include "support/program.h"

namespace knotwave::plugins {
namespace {

std::string as_lines() {
  std::string lines;
  for (const Parameter& parameter : Instrument::table().all()) {
    lines += parameter.symbol + " | " + parameter.name + " | " + parameter.group + " | " +
             parameter_text(parameter, parameter.low) + " to " +
             parameter_text(parameter, parameter.high) + " | " + std::to_string(parameter.id) +
             "\n";
  }
  return lines;
}

// Sessions of hosts name parameters by their place, symbol and id: lines are added, none changes.
TEST(Parameters, AreThoseOfTheList) {
  const auto kept = base::read_file(KNOTWAVE_SOURCE_DIR "/tests/plugins/parameters.txt", 1 << 20);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(as_lines(), *kept);
}

TEST(Parameters, AreOnThePageAsItIsMade) {
  for (const auto& [file, verb] : {std::pair{"docs/plugin-parameters.md", ""},
                                   std::pair{"docs/pictures/plugins.svg", "picture"}}) {
    const auto kept = base::read_file(std::string(KNOTWAVE_SOURCE_DIR "/") + file, 1 << 20);
    ASSERT_TRUE(kept) << kept.error().message;
    std::vector<std::string> command{KNOTWAVE_BIN_DIR "/../tools/parameter_page"};
    if (*verb != '\0') command.push_back(verb);
    const auto made = support::run_program(command);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, *kept) << "make it anew: build/ci/tools/parameter_page " << verb << " > "
                               << file;
  }
}

TEST(Parameters, HaveIdsSymbolsAndSlotsOfTheirOwn) {
  std::set<std::uint32_t> ids;
  std::set<std::string> symbols;
  std::set<int> slots;
  for (const Parameter& parameter : Instrument::table().all()) {
    ids.insert(parameter.id);
    symbols.insert(parameter.symbol);
    slots.insert(parameter.slot);
    EXPECT_EQ(parameter.symbol.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
              std::string::npos);
    EXPECT_LE(parameter.low, parameter.initial);
    EXPECT_GE(parameter.high, parameter.initial);
  }
  EXPECT_EQ(ids.size(), Instrument::table().size());
  EXPECT_EQ(symbols.size(), Instrument::table().size());
  EXPECT_EQ(slots.size(), Instrument::table().size());
  EXPECT_LE(Instrument::table().size(), ParameterValues::kMost);
}

TEST(Parameters, CoverEverySlotButThoseThatNobodyReads) {
  EXPECT_EQ(Instrument::table().size(), static_cast<std::size_t>(engine::kSlotCount) - 3);
}

TEST(Parameters, AreWrittenShortAndReadBack) {
  const Parameter& amp = Instrument::table()[Instrument::table().of_word("amp")];
  EXPECT_EQ(parameter_text(amp, -6.25), "-6.25 dB");
  EXPECT_EQ(parameter_text(amp, -0.0001), "0 dB");
  EXPECT_EQ(parameter_text(amp, 999), "12 dB");
  EXPECT_EQ(parameter_text(amp, std::nan("")), "0 dB");
  EXPECT_EQ(parameter_text(Instrument::table()[Instrument::table().of_word("pan")], 1), "1");
  EXPECT_EQ(*parameter_value(amp, " +3.5 dB "), 3.5);
  EXPECT_EQ(*parameter_value(amp, "-6"), -6);
  EXPECT_EQ(*parameter_value(amp, "1e9"), 12);
  for (const char* text : {"", "dB", "3 semitones", "3,5", "nan", "--3"}) {
    EXPECT_FALSE(parameter_value(amp, text)) << text;
  }
}

}  // namespace
}  // namespace knotwave::plugins
