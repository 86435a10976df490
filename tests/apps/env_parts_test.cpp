// SPDX-License-Identifier: MIT
// What knotwave-env writes and says, and how it counts time.
#include <array>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "env/env_input.h"
#include "env/live.h"
#include "env/planner.h"
#include "env/sent_files.h"
#include "env/sent_plot.h"
#include "env/status.h"
#include "support/program.h"
#include "support/seed.h"

namespace knotwave::env {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

base::MidiEvent midi(std::int64_t sample, int status, int one = 0, int two = 0) {
  base::MidiEvent event;
  event.time = {sample, 0};
  event.bytes[0] = static_cast<std::uint8_t>(status);
  event.bytes[1] = static_cast<std::uint8_t>(one);
  event.bytes[2] = static_cast<std::uint8_t>(two);
  return event;
}

const SentNames kNames = {{"synth", "a, \"b\""}, {{"", "/filter/cutoff"}}};

/// One of each kind, not in order.
SentList some_of_each() {
  SentList sent;
  const std::uint8_t data[] = {0x7E, 0x7F, 9, 1};
  base::MidiEvent sysex = midi(96000, 0xF0);
  sysex.sysex = data;
  sysex.sysex_size = 4;
  sent.midi(0, sysex);
  sent.midi(1, midi(48001, 0xE1, 0, 0x20));
  sent.midi(0, midi(48000, 0xB2, 74, 63));
  sent.midi(0, midi(48000, 0x90, 60, 100));
  sent.midi(0, midi(72000, 0xD0, 5));
  sent.midi(0, midi(72001, 0xF8));
  sent.osc(0, 1, {24000, 0x80000000}, 0.25);
  sent.sort();
  return sent;
}

TEST(EnvSentList, IsByTimeAndKeepsTheOrderOfOneTime) {
  const SentList sent = some_of_each();
  std::vector<int> statuses;
  for (const SentMessage& message : sent.messages()) statuses.push_back(message.bytes[0]);
  EXPECT_THAT(statuses, ElementsAre(0, 0xB2, 0x90, 0xE1, 0xD0, 0xF8, 0xF0));
}

TEST(EnvSentList, HasAHashOfEveryTimePortAndByte) {
  const std::string hash = some_of_each().sha256();
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(some_of_each().sha256(), hash);
  std::vector<std::string> all = {hash, SentList().sha256()};
  for (int change = 0; change < 5; ++change) {
    SentList sent;
    base::MidiEvent event = midi(10, 0xB0, 1, 2);
    if (change == 1) event.time.fraction = 1;
    if (change == 2) event.bytes[2] = 3;
    if (change == 3) event.time.sample = 11;
    sent.midi(change == 4 ? 1 : 0, event);
    all.push_back(sent.sha256());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());
}

TEST(EnvSentFiles, AMidiFileHasEveryMessageAtItsSample) {
  const SentList sent = some_of_each();
  std::size_t left_out = 0;
  const io::Song made = song_of(sent.messages(), kNames, 100'000, left_out);
  EXPECT_EQ(left_out, 2u);  // the clock and OSC
  const auto bytes = io::write_midi(made);
  const auto song = io::parse_midi(std::as_bytes(std::span(bytes)), "sent.mid");
  ASSERT_TRUE(song.has_value()) << song.error().to_string();
  EXPECT_EQ(song->warnings.size(), 0u);
  EXPECT_EQ(song->track_count, 3);
  EXPECT_EQ(song->length_ticks, 100'000u);
  io::TickClock clock(*song, kClockHz);
  std::vector<std::int64_t> samples;
  std::vector<int> statuses;
  for (const io::SongEvent& event : song->events) {
    EXPECT_EQ(clock.at(event.tick).fraction, 0u);
    samples.push_back(clock.at(event.tick).sample);
    statuses.push_back(event.bytes[0]);
  }
  EXPECT_THAT(samples, ElementsAre(48000, 48000, 48001, 72000, 96000));
  EXPECT_THAT(statuses, ElementsAre(0xB2, 0x90, 0xE1, 0xD0, 0xF0));
  EXPECT_THAT(song->sysex_bytes, ElementsAre(0x7E, 0x7F, 9, 1));
}

TEST(EnvSentFiles, TimesHaveNineDigitsAndASign) {
  EXPECT_EQ(seconds_text({0, 0}, kClockHz), "0.000000000");
  EXPECT_EQ(seconds_text({-48, 0}, kClockHz), "-0.001000000");
  EXPECT_EQ(seconds_text({-1, 0x80000000}, kClockHz), "-0.000010416");
  EXPECT_EQ(seconds_text({48000 * std::int64_t{86400} + 1, 0}, kClockHz), "86400.000020833");
}

TEST(EnvSentFiles, ATimeBetweenSamplesGoesToTheNearest) {
  SentList sent;
  base::MidiEvent event = midi(7, 0xB0, 1, 2);
  event.time.fraction = 0x7FFFFFFF;
  sent.midi(0, event);
  event.time.fraction = 0x80000000;
  sent.midi(0, event);
  std::size_t left_out = 0;
  const io::Song song = song_of(sent.messages(), {{"out"}, {}}, 0, left_out);
  EXPECT_EQ(song.events[0].tick, 7u);
  EXPECT_EQ(song.events[1].tick, 8u);
}

TEST(EnvSentFiles, ATableHasALineAMessage) {
  EXPECT_EQ(csv_of(some_of_each().messages(), kNames),
            "time_s,port,message,channel,number,value,hex\n"
            "0.500010416,osc,osc,,/filter/cutoff,0.25,\n"
            "1.000000000,synth,control,3,74,63,B24A3F\n"
            "1.000000000,synth,note on,1,60,100,903C64\n"
            "1.000020833,\"a, \"\"b\"\"\",bend,2,,-4096,E10020\n"
            "1.500000000,synth,pressure,1,,5,D005\n"
            "1.500020833,synth,system,,,,F8\n"
            "2.000000000,synth,exclusive,,,,F07E7F0901F7\n");
}

TEST(EnvSentFiles, AMessageReadsAsAMusicianSaysIt) {
  const SentList sent = some_of_each();
  std::vector<std::string> lines;
  for (const SentMessage& message : sent.messages()) {
    lines.push_back(message_text(message, kNames));
  }
  EXPECT_THAT(lines, ElementsAre("/filter/cutoff 0.25", "CC 74 = 63 ch 3", "note on 60 100 ch 1",
                                 "bend -4096 ch 2", "pressure 5 ch 1", "system F8",
                                 "exclusive F07E7F0901F7"));
}

TEST(EnvReceivers, HoldWhatTheHalvesOfAValueSay) {
  engine::OutputSpec spec;
  spec.number = 1;
  spec.bits = 14;
  SentList sent;
  sent.midi(0, midi(0, 0xB0, 1, 64));     // upper
  sent.midi(0, midi(48, 0xB0, 33, 3));    // lower, 1 ms later: one value
  sent.midi(0, midi(4800, 0xB0, 33, 5));  // the lower alone
  sent.midi(0, midi(9600, 0xB0, 1, 65));  // the upper alone
  sent.midi(0, midi(9600, 0xB1, 1, 99));  // another channel
  sent.midi(1, midi(9600, 0xB0, 1, 99));  // another port
  EXPECT_THAT(received(sent.messages(), 0, 0, 0, spec),
              ElementsAre(Pair(0.001, 64 * 128 + 3), Pair(0.1, 64 * 128 + 5), Pair(0.2, 65 * 128)));
}

TEST(EnvReceivers, TakeAParameterOnlyWhileItIsSelected) {
  engine::OutputSpec spec;
  spec.kind = engine::OutputKind::nrpn;
  spec.number = 3 << 7 | 5;
  SentList sent;
  sent.midi(0, midi(0, 0xB0, 6, 1));  // nothing is selected
  sent.midi(0, midi(1, 0xB0, 99, 3));
  sent.midi(0, midi(2, 0xB0, 98, 5));
  sent.midi(0, midi(4800, 0xB0, 6, 77));
  sent.midi(0, midi(4801, 0xB0, 98, 6));
  sent.midi(0, midi(4802, 0xB0, 6, 78));
  EXPECT_THAT(received(sent.messages(), 0, 0, 0, spec), ElementsAre(Pair(0.1, 77)));
}

TEST(EnvClock, IsExactBothWays) {
  EXPECT_EQ(sample_time(5'000'000'000, 4'000'000'000), (base::SampleTime{48000, 0}));
  EXPECT_EQ(sample_time(62'500, 0), (base::SampleTime{3, 0}));
  EXPECT_EQ(sample_time(10'416, 0).sample, 0);
  EXPECT_EQ(sample_time(3, 5), (base::SampleTime{0, 0}));  // before the begin
  std::mt19937_64 random(support::test_seed());
  for (int i = 0; i < 10'000; ++i) {
    const auto begin_ns = static_cast<std::int64_t>(random() >> 8);
    const auto passed_ns = static_cast<std::int64_t>(random() >> (random() % 40 + 10));
    const std::int64_t back = steady_time(sample_time(begin_ns + passed_ns, begin_ns), begin_ns);
    EXPECT_LE(back, begin_ns + passed_ns);
    EXPECT_GE(back, begin_ns + passed_ns - 2);
  }
}

engine::EnvelopePatchSpec swell() {
  auto patch = engine::parse_envelope_patch(R"(
format = 1
kind = "envelope"
name = "swell"
[trigger]
from = "note"
channel = 1
[ports.synth]
device = "Minitaur"
wire = "din"
[curves.rise]
points = [0, 1, 1, 0]
degree = 1
[envelopes.swell]
curve = "rise"
seconds = 1
loop = [0.3333333333333333, 0.6666666666666666]
[[outputs]]
from = "swell"
to = "cc74"
port = "synth"
channel = 3
[[outputs]]
from = "swell"
to = "bend"
port = "synth"
channel = "note"
range = [0, 8191]
[[outputs]]
from = "swell"
to = "osc"
address = "/x"
range = [0, 1]
)",
                                            "swell.toml");
  EXPECT_TRUE(patch.has_value()) << patch.error().to_string();
  return *patch;
}

TEST(EnvReceivers, AreThoseOfTheirOwnPort) {
  const support::ScratchFolder folder;
  const std::string body =
      "[curves.c]\ndegree = 1\npoints = [0, 1]\n[envelopes.e]\ncurve = \"c\"\n";
  const std::string head = "format = 1\nkind = \"envelope\"\n" + body;
  const std::string to = "[[outputs]]\nfrom = \"e\"\nto = ";
  std::ofstream(folder.file("named.toml")) << head + "[ports.synth]\n" + to + "\"cc74\"\n";
  std::ofstream(folder.file("bare.toml")) << head + to + "\"cc74\"\n" + to + "\"cv\"\n";
  EnvOptions options;
  options.patches = {folder.file("named.toml"), folder.file("bare.toml")};
  const auto input = read_input(options);
  ASSERT_TRUE(input.has_value()) << input.error().to_string();
  const auto run = dry_run(options, *input, io::Song());
  ASSERT_TRUE(run.has_value()) << run.error().to_string();
  EXPECT_THAT(run->names.ports, ElementsAre("synth", "out"));
  EXPECT_THAT(run->output_ports, ElementsAre(ElementsAre(0), ElementsAre(1, -1)));
}

TEST(EnvStatus, SaysARouteInOneLine) {
  const auto patch = swell();
  engine::RouteStatus route;
  route.port = 0;
  route.bytes_per_second = 412.4;
  route.share = 0.132;
  EXPECT_EQ(route_line(patch, route, "KeyStep", "Minitaur"),
            "IN KeyStep ch1 note -> swell.rise (loop 0.3333333333333333..0.6666666666666666) -> "
            "CC74 ch3 Minitaur 412 B/s 13 %");
  route.output = 2;
  route.port = -1;
  route.value = 0.5;
  EXPECT_THAT(route_line(patch, route, "", ""), HasSubstr("IN ch1 note -> swell.rise"));
  EXPECT_THAT(route_line(patch, route, "", ""), HasSubstr("-> /x = 0.500"));
}

TEST(EnvOptions, RedirectTheFirstOutput) {
  EnvOptions options;
  options.control = 11;
  options.channel = 7;
  auto patch = swell();
  std::swap(patch.outputs[0], patch.outputs[1]);  // the bend first
  redirect(options, patch);
  EXPECT_EQ(destination_text(patch.outputs[0]), "CC11 ch7");
  EXPECT_EQ(patch.outputs[0].low, 64);
  EXPECT_EQ(patch.outputs[0].high, 127);
  EXPECT_EQ(patch.outputs[0].rest, 64);
  EXPECT_EQ(destination_text(patch.outputs[1]), "CC74 ch7");
  EXPECT_EQ(destination_text(patch.outputs[2]), "/x");
}

TEST(EnvOptions, AControllerHasTheSameShareOfItsScaleAsTheOutputOfThePatch) {
  struct Case {
    engine::OutputKind kind;
    int bits;
    double low, high, rest;
    std::array<double, 3> right;
  };
  using Kind = engine::OutputKind;
  const Case cases[] = {
      {Kind::control, 7, 100, 10, 64, {100, 10, 64}},
      {Kind::control, 14, 0, 8191, 16383, {0, 63, 127}},
      {Kind::pitch_bend, 14, -2048, 2048, 0, {48, 79, 64}},
      {Kind::pitch_bend, 14, 8191, -8192, 0, {127, 0, 64}},
      {Kind::channel_pressure, 7, 20, 40, 20, {20, 40, 20}},
      {Kind::osc, 7, 200, 4000, 200, {0, 127, 0}},
      {Kind::voltage, 7, 5, -5, 0, {127, 0, 64}},
      {Kind::voltage, 7, 5, 5, 5, {0, 0, 0}},
  };
  EnvOptions options;
  options.control = 11;
  for (const Case& c : cases) {
    engine::EnvelopePatchSpec patch;
    engine::OutputSpec& output = patch.outputs.emplace_back();
    output.kind = c.kind;
    output.bits = c.bits;
    output.low = c.low;
    output.high = c.high;
    output.rest = c.rest;
    redirect(options, patch);
    EXPECT_THAT((std::array{output.low, output.high, output.rest}),
                testing::ElementsAreArray(c.right))
        << c.low << " to " << c.high;
    EXPECT_EQ(output.bits, 7);
  }
}

TEST(EnvVoltages, TellWhatAsksForTheHighestChannel) {
  EnvOptions options;
  options.patches = {std::string(KNOTWAVE_SOURCE_DIR) + "/examples/envelopes/four-voltages.toml"};
  auto input = read_input(options);
  ASSERT_TRUE(input.has_value()) << input.error().to_string();
  EXPECT_EQ(highest_channel_text(*input), "event 1 of 'Four voltages' goes to channel 5");
}

TEST(EnvOptions, NameOutputsByThePortsOfThePatches) {
  EnvOptions options;
  const std::vector<engine::PortSpec> ports = {{.name = "synth", .device = "Minitaur"},
                                               {.name = "drums"}};
  auto all = output_ports(options, ports);
  ASSERT_TRUE(all.has_value());
  EXPECT_EQ((*all)[0].port, "Minitaur");
  EXPECT_EQ((*all)[1].port, "");
  EXPECT_EQ((*all)[1].own_name, "drums");
  options.midi_out = {"Moog", "drums=TR=8"};
  all = output_ports(options, ports);
  EXPECT_EQ((*all)[0].port, "Moog");
  EXPECT_EQ((*all)[1].port, "TR=8");
  options.midi_out = {"drms=TR"};
  EXPECT_EQ(output_ports(options, ports).error().message,
            "--midi-out: no patch has a port 'drms'; did you mean 'drums'?");
  options.midi_out = {"foo=Bar"};
  EXPECT_EQ(output_ports(options, ports).error().message,
            "--midi-out: no patch has a port 'foo'; there is: synth, drums");
  EXPECT_EQ(output_ports(options, std::vector<engine::PortSpec>(1)).error().message,
            "--midi-out: no patch has a port 'foo'; theirs has no name: --midi-out PORT");
  options.midi_out = {"=Foo=Bar"};  // a device with such a name
  all = output_ports(options, std::vector<engine::PortSpec>(1));
  ASSERT_TRUE(all.has_value()) << all.error().to_string();
  EXPECT_EQ((*all)[0].port, "Foo=Bar");
  options.midi_out = {"Moog"};
  EXPECT_EQ(output_ports(options, {}).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace knotwave::env
