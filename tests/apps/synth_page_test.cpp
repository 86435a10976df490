// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "page.h"

namespace knotwave::synth {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t characters_in(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string text_of(const std::vector<PageLine>& lines) {
  std::string text;
  for (const auto& line : lines) text += line.text + "\n";
  return text;
}

SynthStatus playing() {
  SynthStatus status;
  status.patch = "bell.toml";
  status.patch_name = "Bell";
  status.format = {.api = "jack",
                   .device = "system",
                   .rate_hz = 48000,
                   .block_frames = 256,
                   .channels = 2,
                   .latency_s = 0.0107,
                   .has_midi = true};
  status.stream.state = io::AudioStatus::State::running;
  status.stream.load = 0.12;
  status.stream.load_p99 = 0.25;
  status.stream.load_max = 0.31;
  status.stream.xruns = 2;
  status.live.counters.voices_now = 5;
  status.live.messages = 17;
  status.live.peak_left = 0.5f;
  status.live.last_midi[0] = 0x90;
  status.live.last_midi[1] = 60;
  status.live.last_midi[2] = 96;
  status.midi = {{0, "alsa", "Keystep", true, false, 17, 0},
                 {1, "alsa", "Faders", false, false, 0, 0}};
  status.song = "prelude.mid";
  status.song_s = 62.5;
  status.song_length_s = 125;
  status.has_keys = true;
  status.messages = {"now playing bell.toml"};
  return status;
}

curves::NurbsCurve decay() {
  curves::CurveSpec spec;
  spec.name = "decay";
  spec.degree = 2;
  spec.points = {1, 0.2, 0};
  return *curves::NurbsCurve::create(spec);
}

TEST(Page, SaysAllAtAGlance) {
  const std::string text = text_of(page(playing(), {100, 30}));
  for (const char* part :
       {"Bell  (bell.toml)", "jack: system, 48000 Hz, 256 frames, latency 10.7 ms",
        "Keystep, Faders (gone), its own JACK port", "note on C4 (60), velocity 96, channel 1",
        "mean 12 %  p99 25 %  max 31 %   xruns 2", "5  peak 0", "-6.0 dBFS", "silence",
        "now playing bell.toml", "octave 4", "song    1:02.5 of 2:05.0  prelude.mid"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Page, FitsEveryWindow) {
  SynthStatus status = playing();
  const auto curve = decay();
  status.envelope = &curve;
  status.live.envelope_position = 0.5;
  status.messages.assign(50, std::string(300, 'x'));
  status.recording = "take.wav";
  for (int columns = 1; columns < 200; columns += 7) {
    for (int rows = 1; rows < 60; rows += 5) {
      const auto lines = page(status, {columns, rows});
      EXPECT_LE(lines.size(), static_cast<std::size_t>(rows));
      for (const auto& line : lines) {
        EXPECT_LE(characters_in(line.text), static_cast<std::size_t>(std::max(2, columns)))
            << columns << " " << line.text;
      }
    }
  }
}

TEST(Page, MarksWhereTheCurveIsPlayed) {
  SynthStatus status = playing();
  const auto curve = decay();
  status.envelope = &curve;
  std::size_t last = 0;
  for (const double position : {0.0, 0.25, 0.5, 1.0}) {
    status.live.envelope_position = position;
    const auto lines = page(status, {80, 40});
    const auto axis = std::find_if(lines.begin(), lines.end(), [](const PageLine& line) {
      return line.text.find("└") != std::string::npos;
    });
    ASSERT_NE(axis, lines.end());
    const std::string& mark = std::next(axis)->text;
    ASSERT_THAT(mark, HasSubstr("▲"));
    const std::size_t left = characters_in(axis->text.substr(0, axis->text.find("└"))) + 1;
    const auto wide = static_cast<double>(characters_in(axis->text) - left - 1);
    EXPECT_EQ(mark.find("▲"), left + static_cast<std::size_t>(std::lround(position * wide)));
    EXPECT_TRUE(position == 0 || mark.find("▲") > last);
    last = mark.find("▲");
  }
  status.live.envelope_position = -1;
  EXPECT_THAT(text_of(page(status, {80, 40})), Not(HasSubstr("▲"))) << "nothing sounds";
}

TEST(Page, ALostDeviceIsAnAlarm) {
  SynthStatus status = playing();
  status.is_lost = true;
  status.lost_reason = "the JACK server has gone";
  const auto lines = page(status, {80, 24});
  EXPECT_EQ(lines[1].text, "sound   LOST: the JACK server has gone");
  EXPECT_EQ(lines[1].style, PageLine::Style::alarm);
}

TEST(Page, NothingOfOthersTellsTheTerminalWhatToDo) {
  SynthStatus status = playing();
  status.messages = {"\x1b[2J\x07"};
  status.midi[0].name = "\x1b]0;x\x07";
  EXPECT_THAT(text_of(page(status, {80, 24})), Not(HasSubstr("\x1b")));
}

TEST(Page, AMeterIsFullFromZeroOn) {
  EXPECT_EQ(meter(0, 4), "████");
  EXPECT_EQ(meter(6, 4), "████");
  EXPECT_EQ(meter(-30, 4), "██··");
  EXPECT_EQ(meter(-60, 4), "····");
  EXPECT_EQ(meter(dbfs(0), 4), "····");
}

TEST(Page, ColourIsLeftOutWhereItIsNotWanted) {
  const PageLine line{"x", PageLine::Style::alarm};
  EXPECT_EQ(terminal_text(line, false), "x");
  EXPECT_EQ(terminal_text(line, true), "\x1b[1;31mx\x1b[0m");
}

TEST(MidiWords, NameWhatAMusicianKnows) {
  const auto words = [](int a, int b, int c) {
    const std::uint8_t bytes[3] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b),
                                   static_cast<std::uint8_t>(c)};
    return midi_words(bytes);
  };
  EXPECT_EQ(words(0, 0, 0), "");
  EXPECT_EQ(words(0x80, 21, 0), "note off A0 (21), channel 1");
  EXPECT_EQ(words(0x93, 0, 0), "note off C-1 (0), channel 4");
  EXPECT_EQ(words(0x93, 127, 1), "note on G9 (127), velocity 1, channel 4");
  EXPECT_EQ(words(0xA0, 61, 9), "pressure of C#4 (61): 9, channel 1");
  EXPECT_EQ(words(0xBF, 74, 64), "controller 74: 64, channel 16");
  EXPECT_EQ(words(0xC0, 5, 0), "program 5, channel 1");
  EXPECT_EQ(words(0xD0, 5, 0), "pressure 5, channel 1");
  EXPECT_EQ(words(0xE0, 0, 64), "pitch bend 0, channel 1");
  EXPECT_EQ(words(0xF0, 0, 0), "system exclusive");
}

TEST(StatusLines, JsonIsOneLineWithEveryField) {
  const std::string line = json_line(playing());
  EXPECT_THAT(line, testing::StartsWith("{\"seconds\": 0, \"patch\": \"bell.toml\""));
  EXPECT_THAT(line, HasSubstr("\"state\": \"running\""));
  EXPECT_THAT(line, HasSubstr("\"peak_left_dbfs\": -6.0206, \"peak_right_dbfs\": null"));
  EXPECT_THAT(line, HasSubstr("{\"api\": \"alsa\", \"name\": \"Faders\", \"open\": false"));
  EXPECT_THAT(line, HasSubstr("\"song\": \"prelude.mid\", \"song_s\": 62.5, "));
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(StatusLines, APlainLineIsEqualWhileNothingHappens) {
  SynthStatus status = playing();
  const std::string line = plain_line(status);
  status.seconds = 9;
  status.stream.load = 0.5;
  status.live.peak_left = 0.1f;
  EXPECT_EQ(plain_line(status), line);
  status.live.messages = 18;
  EXPECT_NE(plain_line(status), line);
}

TEST(ClockText, IsReadAsAClock) {
  EXPECT_EQ(clock_text(0), "0:00.0");
  EXPECT_EQ(clock_text(62.56), "1:02.5");
  EXPECT_EQ(clock_text(3600), "1:00:00.0");
}

}  // namespace
}  // namespace knotwave::synth
