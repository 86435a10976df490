// SPDX-License-Identifier: MIT
// What needs no sound server: tests/live/midi_input_test.cpp has the rest.
#include "knotwave/io/midi_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/midi_output.h"

#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class Deaf : public MidiListener {
 public:
  void message(const base::MidiEvent&, std::int64_t) noexcept override {}
  void port_lost(int) noexcept override {}
};

TEST(MidiInputs, NoServerAndNoPortAreNoErrorAndNothingIsPrinted) {
  const support::NoJackServer nowhere;
  Deaf listener;
  testing::internal::CaptureStderr();
  auto inputs = MidiInputs::open({}, listener);
  ASSERT_TRUE(inputs.has_value()) << inputs.error().to_string();
  for (int i = 0; i < 100; ++i) (*inputs)->poll();
  EXPECT_THAT((*inputs)->notes(), Contains(HasSubstr("jack: ")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(MidiInputs, AnApiNobodyHasIsRefusedWithThoseThereAre) {
  Deaf listener;
  const auto inputs = MidiInputs::open({.api = "MIDImax"}, listener);
  ASSERT_FALSE(inputs.has_value());
  EXPECT_EQ(inputs.error().code, ErrorCode::unknown_name);
  EXPECT_THAT(inputs.error().message,
              HasSubstr("there is no MIDI API 'MIDImax' here; there is: '"));
}

TEST(MidiInputs, APortNobodyHasIsRefused) {
  const support::NoJackServer nowhere;
  Deaf listener;
  const auto inputs = MidiInputs::open({.api = "jack", .ports = {"piano"}}, listener);
  ASSERT_FALSE(inputs.has_value());
  EXPECT_EQ(inputs.error().message, "no MIDI input has 'piano' in its name; there is: none");
}

TEST(MidiInputs, TheListSaysWhyAnApiHasNone) {
  const support::NoJackServer nowhere;
  EXPECT_THAT(list_midi_ports().notes, Contains(HasSubstr("jack: ")));
}

TEST(MidiOutput, NoServerIsToldWithTheReason) {
  const support::NoJackServer nowhere;
  const auto output = MidiOutput::open({.api = "jack"});
  ASSERT_FALSE(output.has_value());
  EXPECT_EQ(output.error().code, ErrorCode::unsupported);
  EXPECT_THAT(output.error().message, HasSubstr("no MIDI output can be opened (jack: "));
}

}  // namespace
}  // namespace knotwave::io
