// SPDX-License-Identifier: MIT
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "osc_map.h"

namespace knotwave::synth {
namespace {

using engine::LiveMessage;
using testing::ElementsAre;
using Arguments = std::vector<io::OscArgument>;

Result<std::uint16_t> lookup(std::string_view name) {
  if (name == "cutoff") return std::uint16_t{4};
  return fail(ErrorCode::unknown_name, "there is no target '" + std::string(name) + "'");
}

Result<OscCommand> command(std::string_view address, const Arguments& arguments) {
  return osc_command(address, arguments, 77, lookup);
}

std::vector<int> bytes_of(std::string_view address, const Arguments& arguments) {
  const auto done = command(address, arguments);
  if (!done || !std::holds_alternative<LiveMessage>(*done)) return {};
  const auto& message = std::get<LiveMessage>(*done);
  EXPECT_EQ(message.time_ns, 77);
  EXPECT_EQ(message.kind, LiveMessage::Kind::midi);
  return {message.bytes[0], message.bytes[1], message.bytes[2]};
}

std::string fault(std::string_view address, const Arguments& arguments) {
  const auto done = command(address, arguments);
  return done ? "" : done.error().message;
}

TEST(OscMap, ChannelMessagesAreWhatMidiSays) {
  EXPECT_THAT(bytes_of("/note", {60.0, 100.0}), ElementsAre(0x90, 60, 100));
  EXPECT_THAT(bytes_of("/note", {60.0, 100.0, 16.0}), ElementsAre(0x9F, 60, 100));
  EXPECT_THAT(bytes_of("/off", {60.0, 2.0}), ElementsAre(0x81, 60, 64));
  EXPECT_THAT(bytes_of("/cc", {74.0, 127.0}), ElementsAre(0xB0, 74, 127));
  EXPECT_THAT(bytes_of("/program", {5.0, 3.0}), ElementsAre(0xC2, 5, 0));
  EXPECT_THAT(bytes_of("/pressure", {64.0}), ElementsAre(0xD0, 64, 0));
  EXPECT_THAT(bytes_of("/bend", {-1.0}), ElementsAre(0xE0, 0, 0));
  EXPECT_THAT(bytes_of("/bend", {0.0}), ElementsAre(0xE0, 0, 64));
  EXPECT_THAT(bytes_of("/bend", {1.0}), ElementsAre(0xE0, 127, 127));
  EXPECT_THAT(bytes_of("/midi", {176.0, 1.0, 2.0}), ElementsAre(0xB0, 1, 2));
}

TEST(OscMap, VolumeIsTheMasterVolumeOfMidi) {
  const auto done = command("/volume", {1.0});
  const auto& message = std::get<LiveMessage>(*done);
  EXPECT_EQ(message.bytes[0], 0xF0);
  EXPECT_EQ(message.sysex_size, 6);
  EXPECT_THAT(std::vector<int>(message.sysex.begin(), message.sysex.begin() + 6),
              ElementsAre(0x7F, 0x7F, 4, 1, 127, 127));
}

TEST(OscMap, TempoAndTargetsAreMessagesOfTheirOwn) {
  const auto tempo = command("/tempo", {120.0});
  EXPECT_EQ(std::get<LiveMessage>(*tempo).kind, LiveMessage::Kind::tempo);
  EXPECT_EQ(std::get<LiveMessage>(*tempo).number, 500000);
  const auto target = command("/target/cutoff", {-12.5, 2.0});
  const auto& message = std::get<LiveMessage>(*target);
  EXPECT_EQ(message.kind, LiveMessage::Kind::set_target);
  EXPECT_EQ(message.index, 4);
  EXPECT_EQ(message.number, -12.5);
  EXPECT_EQ(message.bytes[0], 1);
  EXPECT_EQ(fault("/target/cutof", {1.0}), "OSC /target/cutof: there is no target 'cutof'");
}

TEST(OscMap, ThingsForTheProgramAreNoMessages) {
  EXPECT_TRUE(std::holds_alternative<OscPanic>(*command("/panic", {})));
  const auto patch = command("/patch", {std::string_view("a b.toml")});
  EXPECT_EQ(std::get<OscPatch>(*patch).path, "a b.toml");
}

TEST(OscMap, WrongArgumentsAreToldWithWhatIsTaken) {
  EXPECT_EQ(fault("/note", {60.0}), "OSC /note takes KEY VELOCITY [CHANNEL]");
  EXPECT_EQ(fault("/note", {60.0, std::string_view("loud")}),
            "OSC /note takes KEY VELOCITY [CHANNEL]");
  EXPECT_EQ(fault("/note", {60.0, 1.0, 1.0, 1.0}), "OSC /note takes KEY VELOCITY [CHANNEL]");
  EXPECT_EQ(fault("/panic", {1.0}), "OSC /panic takes nothing");
  EXPECT_EQ(fault("/patch", {}), "OSC /patch takes PATH");
  EXPECT_EQ(fault("/note", {128.0, 1.0}), "OSC /note: 128 is not in 0 to 127");
  EXPECT_EQ(fault("/cc", {1.0, 1.0, 17.0}), "OSC /cc: 17 is not in 1 to 16");
  EXPECT_EQ(fault("/bend", {1.5}), "OSC /bend: 1.5 is not in -1 to 1");
  EXPECT_EQ(fault("/bend", {std::numeric_limits<double>::quiet_NaN()}),
            "OSC /bend: nan is not in -1 to 1");
  EXPECT_EQ(fault("/notes", {60.0}), "OSC /notes means nothing here; did you mean '/note'?");
}

TEST(OscMap, WhatIsNotUnderstoodIsToldOnceAnAddress) {
  OscFaults faults;
  const Error error = fail(ErrorCode::unknown_name, "OSC /x means nothing here");
  EXPECT_TRUE(faults.told_once("/x", error).has_value());
  EXPECT_FALSE(faults.told_once("/x", error).has_value());
  EXPECT_TRUE(faults.told_once("/y", error).has_value());
  for (int i = 0; i < 1000; ++i) faults.told_once("/" + std::to_string(i), error);
  EXPECT_FALSE(faults.told_once("/z", error).has_value()) << "memory has an end";
  EXPECT_EQ(faults.count(), 1004);
}

}  // namespace
}  // namespace knotwave::synth
