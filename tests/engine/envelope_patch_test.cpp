// SPDX-License-Identifier: MIT
#include "knotwave/engine/envelope_patch.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/envelope_patch_program.h"

#include "support/seed.h"

namespace knotwave::engine {
namespace {

// A patch of the least that is one, with `more` at its end. Its nine lines come first.
std::string least(const std::string& more = "") {
  return "format = 1\nkind = \"envelope\"\n[curves.swell]\ndegree = 1\npoints = [0, 1]\n"
         "[envelopes.swell]\ncurve = \"swell\"\n"
         "[[outputs]]\nfrom = \"swell\"\n" +
         (more.starts_with("to") ? "" : std::string("to = \"cc74\"\n")) + more;
}

EnvelopePatchSpec parsed(const std::string& text) {
  auto spec = parse_envelope_patch(text, "test.toml");
  EXPECT_TRUE(spec) << spec.error().to_string();
  return spec ? std::move(*spec) : EnvelopePatchSpec{};
}

std::string error_of(const std::string& text) {
  const auto spec = parse_envelope_patch(text, "test.toml");
  if (!spec) return spec.error().to_string();
  const auto program = EnvelopePatchProgram::create(*spec);
  return program ? "no error" : program.error().to_string();
}

TEST(EnvelopePatch, WhatIsNotWrittenHasItsDefault) {
  const EnvelopePatchSpec spec = parsed(least());
  EXPECT_FALSE(spec.patch.has_sound);
  EXPECT_EQ(spec.patch.mode, PlayMode::mono);
  EXPECT_EQ(spec.patch.polyphony, 8);
  EXPECT_EQ(spec.trigger.kind, TriggerSpec::Kind::note);
  EXPECT_EQ(spec.trigger.channel, 0);
  EXPECT_EQ(spec.trigger.program, -1);
  EXPECT_EQ(spec.notes, NoteOutput::off);
  ASSERT_EQ(spec.outputs.size(), 1u);
  const OutputSpec& output = spec.outputs[0];
  EXPECT_EQ(output.kind, OutputKind::control);
  EXPECT_EQ(output.number, 74);
  EXPECT_EQ(output.bits, 7);
  EXPECT_EQ(output.channel, 1);
  EXPECT_EQ(output.of_low, 0);
  EXPECT_EQ(output.of_high, 1);
  EXPECT_EQ(output.low, 0);
  EXPECT_EQ(output.high, 127);
  EXPECT_EQ(output.rest, 0);
}

TEST(EnvelopePatch, EveryKeyReachesItsPlace) {
  const EnvelopePatchSpec spec = parsed(R"(format = 1
kind = "envelope"
name = "All"
mode = "poly"
polyphony = 4
priority = "low"
seed = 7
notes = "mpe"
notes_port = "synth"
[trigger]
from = "note"
channel = 3
keys = [36, 96]
program = 5
[ports.synth]
device = "Minitaur"
wire = "din"
running_status = false
[ports.other]
wire = "usb"
[curves.swell]
degree = 1
points = [0, 1, 0]
[envelopes.swell]
curve = "swell"
loop = [0.25, 0.75]
[lfos.wow]
curve = "sine"
[[maps]]
from = "velocity"
to = "free.depth"
[[outputs]]
from = "swell"
to = "cc1"
bits = 14
port = "other"
channel = "note"
of = [0.25, 0.5]
range = [16383, 100]
curve = "swell"
rest = 3
[[outputs]]
from = "wow"
to = "nrpn300"
bits = 14
[[outputs]]
from = "free.depth"
to = "bend"
[[outputs]]
from = "swell"
to = "pressure"
range = [20, 90]
[[outputs]]
from = "swell"
to = "poly_pressure"
[[outputs]]
from = "swell"
to = "osc"
address = "/filter/cutoff"
rate_hz = 50
[[outputs]]
from = "swell"
to = "cv"
cv_channel = 4
range = [-5, 5]
[[events]]
envelope = "swell"
at = "loop"
note = 40
channel = 10
velocity = 90
port = "synth"
seconds = 0.02
[[events]]
envelope = "swell"
at = 0.5
gate = 3
volts = 8
)");
  EXPECT_EQ(spec.patch.name, "All");
  EXPECT_EQ(spec.patch.polyphony, 4);
  EXPECT_EQ(spec.patch.priority, NotePriority::low);
  EXPECT_EQ(spec.patch.seed, 7u);
  EXPECT_EQ(spec.notes, NoteOutput::mpe);
  EXPECT_EQ(spec.notes_port, "synth");
  EXPECT_EQ(spec.trigger.channel, 3);
  EXPECT_EQ(spec.trigger.key_low, 36);
  EXPECT_EQ(spec.trigger.key_high, 96);
  EXPECT_EQ(spec.trigger.program, 5);
  ASSERT_EQ(spec.ports.size(), 2u);
  EXPECT_EQ(spec.ports[0].device, "Minitaur");
  EXPECT_EQ(spec.ports[0].wire, PortSpec::Wire::din);
  EXPECT_FALSE(spec.ports[0].running_status);
  EXPECT_EQ(spec.ports[1].wire, PortSpec::Wire::usb);
  ASSERT_EQ(spec.outputs.size(), 7u);
  const OutputSpec& fine = spec.outputs[0];
  EXPECT_EQ(fine.bits, 14);
  EXPECT_EQ(fine.port, "other");
  EXPECT_EQ(fine.channel, 0);
  EXPECT_EQ(fine.of_low, 0.25);
  EXPECT_EQ(fine.low, 16383);
  EXPECT_EQ(fine.high, 100);
  EXPECT_EQ(fine.curve, "swell");
  EXPECT_EQ(fine.rest, 3);
  EXPECT_EQ(spec.outputs[1].kind, OutputKind::nrpn);
  EXPECT_EQ(spec.outputs[1].source, MapSource::lfo);
  EXPECT_EQ(spec.outputs[1].number, 300);
  EXPECT_EQ(spec.outputs[1].high, 16383);
  EXPECT_EQ(spec.outputs[2].source, MapSource::free_number);
  EXPECT_EQ(spec.outputs[2].bits, 14);
  EXPECT_EQ(spec.outputs[2].low, -8192);
  EXPECT_EQ(spec.outputs[2].high, 8191);
  EXPECT_EQ(spec.outputs[2].rest, 0);
  EXPECT_EQ(spec.outputs[3].rest, 20) << "the end of the range nearest to 0";
  EXPECT_EQ(spec.outputs[4].kind, OutputKind::poly_pressure);
  EXPECT_EQ(spec.outputs[5].address, "/filter/cutoff");
  EXPECT_EQ(spec.outputs[5].osc_hz, 50);
  EXPECT_EQ(spec.outputs[5].high, 1);
  EXPECT_EQ(spec.outputs[6].number, 4);
  EXPECT_EQ(spec.outputs[6].low, -5);
  ASSERT_EQ(spec.place_events.size(), 2u);
  EXPECT_EQ(spec.place_events[0].at, PlaceEventSpec::At::loop);
  EXPECT_EQ(spec.place_events[0].key, 40);
  EXPECT_EQ(spec.place_events[0].channel, 10);
  EXPECT_EQ(spec.place_events[0].velocity, 90);
  EXPECT_EQ(spec.place_events[0].length_s, 0.02);
  EXPECT_EQ(spec.place_events[1].at, PlaceEventSpec::At::place);
  EXPECT_EQ(spec.place_events[1].place_u, 0.5);
  EXPECT_EQ(spec.place_events[1].kind, PlaceEventSpec::Kind::voltage);
  EXPECT_EQ(spec.place_events[1].voltage_channel, 3);
  EXPECT_EQ(spec.place_events[1].volts, 8);
}

TEST(EnvelopePatch, TriggersOfEveryKindAreRead) {
  using Kind = TriggerSpec::Kind;
  const auto trigger = [](const std::string& text) {
    return parsed(least("[trigger]\n" + text)).trigger;
  };
  EXPECT_EQ(trigger("from = 'pedal'").kind, Kind::gate);
  EXPECT_EQ(trigger("from = 'pedal'").control, 64);
  EXPECT_EQ(trigger("from = 'cc20'\nthreshold = 100").control, 20);
  EXPECT_EQ(trigger("from = 'cc20'\nthreshold = 100").threshold, 100);
  EXPECT_EQ(trigger("from = 'loop'").kind, Kind::loop);
  const TriggerSpec clock =
      trigger("from = 'clock'\nbeats = 0.5\noffset_beats = 0.25\ngate = 0.125");
  EXPECT_EQ(clock.kind, Kind::clock);
  EXPECT_EQ(clock.beats, 0.5);
  EXPECT_EQ(clock.offset_beats, 0.25);
  EXPECT_EQ(clock.gate_share, 0.125);
  EXPECT_EQ(trigger("channel = 'any'\nkeys = 40").key_low, 40);
  EXPECT_EQ(trigger("channel = 'any'\nkeys = 40").key_high, 40);
}

TEST(EnvelopePatch, EveryFaultIsToldWithItsPlace) {
  const struct {
    std::string text;
    const char* error;
  } kFaults[] = {
      {"format = 1\nkind = 'patch'\n",
       "test.toml:2:8: error: this file's kind is 'patch'; a patch of the envelope generator (kind "
       "= \"envelope\") is needed here; knotwave-synth and knotwave-render play this one"},
      {"format = 1\nkind = 'envelope'\n",
       "test.toml:1:1: error: the patch has no [[outputs]] and no [[events]], so nothing would "
       "come out"},
      {least("[oscillators.a]\nwave = 'sine'\n"),
       "test.toml:11:2: error: an envelope patch makes no sound: 'oscillators' belongs to a patch "
       "(kind = \"patch\")"},
      {"format = 1\nkind = 'envelope'\ntuning = 'a.scl'\n",
       "test.toml:3:1: error: an envelope patch makes no sound: 'tuning' belongs to a patch (kind "
       "= "
       "\"patch\")"},
      {least("[[maps]]\nfrom = 'velocity'\nto = 'filter.cutoff'\n"),
       "test.toml:13:6: error: map 1: there is no target 'filter.cutoff' in this patch, which has "
       "no oscillators and no sound: a map moves free.NAME, envelope.NAME.time, lfo.NAME.rate or a "
       "number of a curve"},
      {least("[[maps]]\nfrom = 'velocity'\nto = 'pitch'\n"),
       "test.toml:13:6: error: map 1: there is no target 'pitch' in this patch, which has no "
       "oscillators and no sound: a map moves free.NAME, envelope.NAME.time, lfo.NAME.rate or a "
       "number of a curve"},
      {least("[[maps]]\nfrom = 'velocity'\nto = 'envelope.swll.time'\n"),
       "test.toml:13:6: error: map 1: there is no target 'envelope.swll.time' in this patch; did "
       "you mean 'envelope.swell.time'?"},
      {least("[trigger]\nfrom = 'nope'\n"),
       "test.toml:12:8: error: trigger: from is 'nope'; it must be one of note, pedal, cc0 to "
       "cc119, clock, loop; did you mean 'note'?"},
      {least("[trigger]\nfrom = 'cc007'\n"),
       "test.toml:12:8: error: trigger: controllers are cc0 to cc119"},
      {least("[[outputs]]\nfrom = 'swell'\nto = 'cc007'\n"),
       "test.toml:13:6: error: output 2: there is no output 'cc007'; there are cc0 to cc119, nrpn0 "
       "to nrpn16383, bend, pressure, poly_pressure, osc and cv"},
      {least("[ports.a]\ndevice = \"Mini\\ntaur\"\n"),
       "test.toml:12:10: error: port 'a': device has a control character (U+000A); it is one line "
       "of text"},
      {"format = 1\nkind = 'envelope'\nname = \"a\\u0000b\"\n",
       "test.toml:3:8: error: envelope patch: name has a control character (U+0000); it is one "
       "line "
       "of text"},
      {"format = 1\nkind = 'envelope'\nabout = \"a\\u001B[2J\"\n",
       "test.toml:3:9: error: envelope patch: about has a control character (U+001B); it is one "
       "line of text"},
      {least("[trigger]\nfrom = 'cc120'\n"),
       "test.toml:12:8: error: trigger: controllers are cc0 to cc119"},
      {least("[trigger]\nfrom = 'clock'\nkeys = 3\n"),
       "test.toml:13:8: error: trigger: 'keys' belongs to from = \"note\""},
      {least("[trigger]\nkeys = [96, 36]\n"),
       "test.toml:12:8: error: trigger: keys must be a number from 0 to 127, or two rising ones: "
       "[36, 96]"},
      {least("[trigger]\nbeats = 2\n"),
       "test.toml:12:9: error: trigger: 'beats' belongs to from = \"clock\""},
      {least("[trigger]\nfrom = 'loop'\nprogram = 3\n"),
       "test.toml:13:11: error: trigger: 'program' needs a 'channel' (1 to 16) here"},
      {least("[trigger]\nchanel = 3\n"),
       "test.toml:12:1: error: trigger: unknown key 'chanel'; did you mean 'channel'?"},
      {least("[ports.a]\nwire = 'usb'\nrunning_status = true\n"),
       "test.toml:13:18: error: port 'a': 'running_status' belongs to wire = \"din\""},
      {least("to = 'cc120'\n"),
       "test.toml:10:6: error: output 1: there is no output 'cc120'; there are cc0 to cc119 and "
       "nrpn0 to nrpn16383"},
      {least("to = 'pitchbend'\n"),
       "test.toml:10:6: error: output 1: there is no output 'pitchbend'; did you mean 'bend'?"},
      {least("to = 'modwheel'\n"),
       "test.toml:10:6: error: output 1: there is no output 'modwheel'; did you mean 'cc1'?"},
      {least("to = 'xyzzy'\n"),
       "test.toml:10:6: error: output 1: there is no output 'xyzzy'; there are cc0 to cc119, "
       "nrpn0 to nrpn16383, bend, pressure, poly_pressure, osc and cv"},
      {least("to = 'cc40'\nbits = 14\n"),
       "test.toml:11:8: error: output 1: cc40 has no low half: 14 bits are for cc0 to cc31"},
      {least("bits = 8\n"), "test.toml:11:8: error: output 1: bits must be 7 or 14"},
      {least("to = 'bend'\nbits = 14\n"),
       "test.toml:11:8: error: output 1: 'bits' belongs to controllers and NRPN"},
      {least("to = 'osc'\n"), "test.toml:8:1: error: output 1: 'address' is missing"},
      {least("to = 'osc'\naddress = 'cutoff'\n"),
       "test.toml:11:11: error: output 1: 'cutoff' is no OSC address: it begins with '/' and has "
       "no blanks and none of #*,?[]{}"},
      {least("to = 'cv'\nport = 'a'\n[ports.a]\n"),
       "test.toml:11:8: error: output 1: 'port' belongs to outputs to MIDI"},
      {least("port = 'syth'\n[ports.synth]\n"),
       "test.toml:11:8: error: output 1: there is no [ports.syth]; did you mean 'synth'?"},
      {least("of = [1, 0]\n"),
       "test.toml:11:6: error: output 1: of must be two rising numbers; a falling 'range' turns an "
       "output round"},
      {least("range = [0, 128]\n"),
       "test.toml:11:13: error: output 1: range: 128 is outside 0 to 127"},
      {least("range = [0]\n"),
       "test.toml:11:9: error: output 1: range must be two numbers: [from, to]"},
      {least("rest = -1\n"), "test.toml:11:8: error: output 1: rest is -1; it must be in 0 to 127"},
      {least("curve = 'swel'\n"),
       "test.toml:11:9: error: output 1: there is no curve 'swel'; did you mean 'swell'?"},
      {least("[trigger]\nfrom = 'clock'\n[[outputs]]\nfrom = 'swell'\nto = 'cc1'\nchannel = "
             "'note'\n"),
       "test.toml:16:11: error: output 2: a trigger from a clock or loop has no channel of its "
       "own: channel = 1 to 16"},
      {least("to = 'poly_pressure'\n[trigger]\nfrom = 'loop'\n"),
       "test.toml:10:6: error: output 1: \"poly_pressure\" is of a key: it needs a trigger from = "
       "\"note\""},
      {least("[[outputs]]\nfrom = 'velocity'\nto = 'cc1'\n"),
       "test.toml:12:8: error: output 2: there is no envelope, LFO or free number 'velocity': a "
       "map "
       "brings 'velocity' to a free number, which can be sent"},
      {least("[[outputs]]\nfrom = 'swel'\nto = 'cc1'\n"),
       "test.toml:12:8: error: output 2: there is no envelope, LFO or free number 'swel'; did you "
       "mean 'swell'?"},
      {least("[[events]]\nenvelope = 'swell'\n"),
       "test.toml:11:1: error: event 1: 'note' (or 'gate') is missing"},
      {least("[[events]]\nenvelope = 'swell'\nat = 'loop'\nnote = 3\n"),
       "test.toml:13:6: error: event 1: envelope 'swell' has no loop"},
      {least("[[events]]\nenvelope = 'swell'\nat = 1.5\nnote = 3\n"),
       "test.toml:13:6: error: event 1: at is 1.5; it must be in 0 to 1"},
      {least("[[events]]\nenvelope = 'swell'\nnote = 3\nvolts = 5\n"),
       "test.toml:14:9: error: event 1: 'volts' belongs to events with a 'gate'"},
      {"format = 1\nkind = 'envelope'\nnotes = 'mpe'\n",
       "test.toml:3:9: error: envelope patch: notes = \"mpe\" needs mode = \"poly\""},
      {"format = 1\nkind = 'envelope'\nnotes_port = 'a'\n[ports.a]\n",
       "test.toml:3:14: error: envelope patch: 'notes_port' belongs to notes = \"thru\" or "
       "\"mpe\""},
      {"mode = 'poly'\npolyphony = 16\nnotes = 'mpe'\n" + least(),
       "test.toml:1:1: error: polyphony is 16, but MPE has channels for 15 notes"},
      {least("curve = 'law'\n[curves.law]\ndegree = 1\npoints = [0, 1]\nknots = [0, 0, 2, 2]\n"),
       "test.toml:11:9: error: output 1: curve 'law' runs from 0 to 2; an output's curve runs from "
       "0 to 1"},
      {least("curve = 'law'\n[curves.law]\ndegree = 1\npoints = [0, 1]\n[[maps]]\nfrom = "
             "'mod'\nto = 'curve.law.point.1'\nlow = 0.5\nhigh = 1\n"),
       "test.toml:11:9: error: output 1: a map moves a number of curve 'law'; an output's curve "
       "stands still. A map to a free number can have a curve that moves"},
      {least("[[maps]]\nfrom = 'swell'\nto = 'envelope.swell.time'\n"),
       "test.toml:12:8: error: map 1: an envelope's time is read once, when a note starts; an "
       "envelope or LFO cannot move it"},
  };
  for (const auto& fault : kFaults) EXPECT_EQ(error_of(fault.text), fault.error) << fault.text;
}

TEST(EnvelopePatch, TooManyOfAnythingIsAFaultAtTheFirstTooMany) {
  std::string outputs, events, ports;
  for (int i = 0; i < kMaxOutputs; ++i) outputs += "[[outputs]]\nfrom = 'swell'\nto = 'cc1'\n";
  for (int i = 0; i <= kMaxPlaceEvents; ++i) events += "[[events]]\nenvelope='swell'\nnote = 1\n";
  for (int i = 0; i <= kMaxOutputPorts; ++i) ports += "[ports.p" + std::to_string(i) + "]\n";
  EXPECT_EQ(error_of(least(outputs)),
            "test.toml:104:1: error: this output is one more than the 32 a patch may have");
  EXPECT_EQ(error_of(least(events)),
            "test.toml:59:1: error: this event is one more than the 16 a patch may have");
  EXPECT_EQ(error_of(least(ports)),
            "test.toml:27:8: error: ports: 'p16' is one more than the 16 a patch may have");
}

TEST(EnvelopePatch, ThePartsOfAPatchOfSoundAreReadByTheSameCode) {
  const EnvelopePatchSpec spec = parsed(
      least("[envelopes.time]\ncurve = 'swell'\nbeats = 2\nsustain_at = 0.5\nrelease_at = 0.75\n"
            "[lfos.wow]\ncurve = 'sine'\nbeats = 0.5\nmode = 'free'\n"
            "[[maps]]\nfrom = ['swell', 'velocity']\nsurface = 'row'\nto = 'free.depth'\n"
            "[[maps]]\nfrom = 'mod'\nto = 'curve.swell.point.1'\nlow = 0.5\nhigh = 1\n"
            "[surfaces.row]\ndegree_u = 1\ndegree_v = 1\npoints = [[0, 1], [1, 0]]\n"));
  ASSERT_EQ(spec.patch.envelopes.size(), 2u);
  EXPECT_TRUE(spec.patch.envelopes[1].tempo_beats);
  EXPECT_EQ(spec.patch.envelopes[1].spec.release_u, 0.75);
  EXPECT_EQ(spec.patch.lfos.at(0).spec.beats, 0.5);
  EXPECT_EQ(spec.patch.maps.size(), 2u);
  const auto program = EnvelopePatchProgram::create(spec);
  ASSERT_TRUE(program) << program.error().to_string();
  EXPECT_EQ((*program)->patch().envelopes().size(), 2u) << "no built-in amp envelope";
  EXPECT_EQ((*program)->patch().amp_envelope(), -1);
}

TEST(EnvelopePatch, ASynthDoesNotPlayIt) {
  const auto bank = BankProgram::create(bank_of(parsed(least()).patch));
  ASSERT_FALSE(bank);
  EXPECT_EQ(bank.error().code, ErrorCode::unsupported);
}

// What a program may hand in without a file.
TEST(EnvelopePatch, ASpecThatNoReaderGivesIsRefused) {
  const auto code_of = [](auto&& spoil) {
    EnvelopePatchSpec spec = parsed(least("[[events]]\nenvelope = 'swell'\nnote = 3\n"));
    spoil(spec);
    const auto program = EnvelopePatchProgram::create(spec);
    return program ? std::string("none") : std::string(to_string(program.error().code));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([](auto&) {}), "none");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].source_index = 1; }), "unknown_name");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].source = MapSource::velocity; }), "unknown_name");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].curve = "none"; }), "unknown_name");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].port = "none"; }), "unknown_name");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].channel = 17; }), "value_out_of_range");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].bits = 9; }), "value_out_of_range");
  EXPECT_EQ(code_of([](auto& s) { s.outputs[0].number = 120; }), "value_out_of_range");
  EXPECT_EQ(code_of([&](auto& s) { s.outputs[0].high = nan; }), "value_out_of_range");
  EXPECT_EQ(code_of([&](auto& s) { s.outputs[0].of_high = nan; }), "value_out_of_range");
  EXPECT_EQ(code_of([](auto& s) { s.place_events[0].envelope = -1; }), "unknown_name");
  EXPECT_EQ(code_of([&](auto& s) { s.place_events[0].length_s = nan; }), "value_out_of_range");
  EXPECT_EQ(code_of([&](auto& s) { s.trigger.beats = nan; }), "value_out_of_range");
  EXPECT_EQ(code_of([](auto& s) { s.patch.polyphony = 33; }), "value_out_of_range");
  EXPECT_EQ(code_of([](auto& s) { s.notes = NoteOutput::mpe; }), "unsupported");
  EXPECT_EQ(code_of([](auto& s) { s.patch.has_sound = true; }), "unsupported");
}

// The value law: of..range, exact at both ends, held beyond them, NaN at rest.
TEST(EnvelopePatch, ValuesReachBothEndsOfTheRangeExactlyAndNeverLeaveIt) {
  const base::RandomStream random{support::test_seed(), 0, 2100};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::uint64_t i = 0; i < 2000; ++i) {
    EnvelopePatchProgram::Output output;
    output.spec.kind = OutputKind::osc;
    output.spec.of_low = 10 * random.bipolar(8 * i);
    output.spec.of_high = output.spec.of_low + 1e-3 + 10 * random.unit(8 * i + 1);
    output.spec.low = 100 * random.bipolar(8 * i + 2);
    output.spec.high = 100 * random.bipolar(8 * i + 3);
    output.spec.rest = random.unit(8 * i + 4);
    curves::CurveCursor cursor;
    EXPECT_EQ(output.value(output.spec.of_low, cursor), output.spec.low);
    EXPECT_EQ(output.value(output.spec.of_high, cursor), output.spec.high);
    EXPECT_EQ(output.value(-infinity, cursor), output.spec.low);
    EXPECT_EQ(output.value(infinity, cursor), output.spec.high);
    EXPECT_EQ(output.value(nan, cursor), output.spec.rest);
    const double t = random.unit(8 * i + 5);
    const double x = output.spec.of_low + t * (output.spec.of_high - output.spec.of_low);
    const double y = output.value(x, cursor);
    EXPECT_NEAR(y, output.spec.low + t * (output.spec.high - output.spec.low), 1e-9);
    EXPECT_GE(y, std::min(output.spec.low, output.spec.high));
    EXPECT_LE(y, std::max(output.spec.low, output.spec.high));
  }
}

TEST(EnvelopePatch, AnOutputsCurveBendsBetweenTheEnds) {
  const auto program = EnvelopePatchProgram::create(
      parsed(least("range = [10, 110]\ncurve = 'bent'\n[curves.bent]\ndegree = 2\n"
                   "points = [0, 0, 1]\n")));
  ASSERT_TRUE(program) << program.error().to_string();
  const EnvelopePatchProgram::Output& output = (*program)->outputs()[0];
  curves::CurveCursor cursor;
  EXPECT_EQ(output.value(0, cursor), 10);
  EXPECT_EQ(output.value(1, cursor), 110);
  for (int i = 0; i <= 100; ++i) {
    const double x = i / 100.0;
    EXPECT_NEAR(output.value(x, cursor), 10 + 100 * x * x, 1e-12);
  }
}

TEST(EnvelopePatch, FilesAreKeptAsTheyWereRead) {
  EXPECT_EQ(read_envelope_patch("/no-such-folder/a.toml").error().code, ErrorCode::file_not_found);
}

}  // namespace
}  // namespace knotwave::engine
