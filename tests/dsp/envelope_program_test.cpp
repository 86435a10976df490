// SPDX-License-Identifier: MIT
// What a program says to places that make no sense.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"

#include "envelopes.h"

namespace {

using namespace knotwave::test;

std::string error_of(const EnvelopeSpec& spec) {
  const auto program = EnvelopeProgram::create(bell(), spec);
  EXPECT_FALSE(program.has_value());
  return program ? "" : program.error().message;
}

TEST(EnvelopeProgram, SaysWhichPlaceIsWrong) {
  EXPECT_EQ(error_of({.compile = {}, .seconds = 0}),
            "an envelope lasts more than 0 and less than 1e9 seconds, not 0");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 1.5}),
            "sustain is at 1.5, the curve runs from 0 to 1");
  EXPECT_EQ(error_of({.compile = {}, .loop_start_u = 0.5, .loop_end_u = 0.25}),
            "loop start (0.5) is after loop end (0.25)");
  EXPECT_EQ(error_of({.compile = {}, .loop_start_u = 0.25, .loop_end_u = 0.5, .release_u = 0.3}),
            "loop end (0.5) is after release (0.3)");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 0.5, .release_u = 0.3}),
            "sustain (0.5) is after release (0.3)");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 0.3, .loop_start_u = 0.25, .loop_end_u = 0.5}),
            "an envelope holds at its sustain place (0.3) or repeats its loop (0.25 to 0.5), not "
            "both");
  EXPECT_NE(error_of({.compile = {}, .release_u = std::numeric_limits<double>::quiet_NaN()}), "");
}

}  // namespace
