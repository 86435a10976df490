// SPDX-License-Identifier: MIT
// The parts that every way of sound is made of: choosing a device, the pump, the load meter, the
// clock of cycles, the watch, messages in one piece, calls that hang.
#include <array>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/midi_stream.h"

#include "audio_backend.h"
#include "block_pump.h"
#include "block_watch.h"
#include "complete_midi.h"
#include "cycle_clock.h"
#include "load_meter.h"
#include "patient_call.h"

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

FoundDevices some_devices() {
  FoundDevices found;
  const auto add = [&](const char* api, const char* name, bool is_default) {
    AudioDeviceInfo info;
    info.number = static_cast<int>(found.devices.size());
    info.api = api;
    info.name = name;
    info.is_default = is_default;
    found.devices.push_back({info, -1});
  };
  add("jack", "system", true);
  add("alsa", "HDA Intel: (hw:0,0)", false);
  add("alsa", "USB Audio: (hw:1,0)", false);
  add("alsa", "default", true);
  add("alsa", "default:usb", false);
  found.notes = {"oss: no device with outputs"};
  return found;
}

int chosen(const char* api, const char* device) {
  const auto found = choose_device(some_devices(), {.api = api, .device = device});
  return found ? found->info.number : -1;
}

Error choice_refused(const FoundDevices& found, const char* api, const char* device) {
  const auto choice = choose_device(found, {.api = api, .device = device});
  EXPECT_FALSE(choice);
  return choice ? Error{} : choice.error();
}

TEST(ChooseDevice, TheDefaultOfTheFirstApiOrOfTheOneAskedForIsTaken) {
  EXPECT_EQ(chosen("", ""), 0);
  EXPECT_EQ(chosen("jack", ""), 0);
  EXPECT_EQ(chosen("alsa", ""), 3);
}

TEST(ChooseDevice, ANumberIsThatOfTheList) {
  EXPECT_EQ(chosen("", "2"), 2);
  EXPECT_EQ(chosen("alsa", "2"), 2);
}

TEST(ChooseDevice, PartOfANameInAnyCaseIsEnoughAndAWholeNameBeatsParts) {
  EXPECT_EQ(chosen("", "hda intel"), 1);
  EXPECT_EQ(chosen("", "SYSTEM"), 0);
  EXPECT_EQ(chosen("", "Default"), 3);
}

TEST(ChooseDevice, WhatIsNotThereIsRefusedWithWhatIs) {
  const FoundDevices found = some_devices();
  const struct {
    const char *api, *device, *words;
  } cases[] = {
      {"", "9", "no device '9'; there is: 0 jack 'system', 1 alsa 'HDA Intel: (hw:0,0)', 2"},
      {"alsa", "0", "no device '0' of alsa; there is: 1 alsa"},
      {"jack", "usb", "no device 'usb' of jack; there is: 0 jack 'system'"},
      {"", "usb", "more than one device is named 'usb': 2 alsa 'USB Audio: (hw:1,0)', 4 alsa"},
      {"coreaudio", "", "there is no audio API 'coreaudio' here; there is: jack, alsa, oss, none"},
  };
  for (const auto& wrong : cases) {
    const Error error = choice_refused(found, wrong.api, wrong.device);
    EXPECT_EQ(error.code, ErrorCode::unknown_name) << error.message;
    EXPECT_THAT(error.message, HasSubstr(wrong.words));
  }
}

TEST(ChooseDevice, WithoutAnyDeviceTheMessageIsOneLineWithTheFixAndTheReasons) {
  FoundDevices none;
  none.notes = {"jack: no server is running", "alsa: no device with outputs"};
  const Error error = choice_refused(none, "", "usb");
  EXPECT_EQ(error.code, ErrorCode::unsupported);
  EXPECT_EQ(error.message,
            "no sound device: start a JACK or PipeWire server, or plug one in (jack: no server is "
            "running; alsa: no device with outputs)");
  EXPECT_THAT(choice_refused(some_devices(), "oss", "").message,
              HasSubstr("no sound device of oss"));
}

TEST(ChooseDevice, AListTooLongForALineIsCutAndSaysWhereTheWholeOneIs) {
  FoundDevices many;
  for (int i = 0; i < 13; ++i) {
    many.devices.push_back({{.number = i, .api = "alsa", .name = "x" + std::to_string(i)}, i});
  }
  const std::string words = choice_refused(many, "", "none such").message;
  EXPECT_THAT(words, HasSubstr("11 alsa 'x11', ... (--list-devices shows all)"));
  EXPECT_THAT(words, ::testing::Not(HasSubstr("x12")));
}

TEST(LoadMeter, SharesAreOfTheDeadlineAndTheSmoothedOneForgetsWithinSeconds) {
  LoadMeter meter;
  EXPECT_EQ(meter.figures().p99, 0);
  for (int i = 0; i < 1000; ++i) meter.count(250, 1000);  // 1 us each: no time to settle
  EXPECT_EQ(meter.figures().max, 0.25);
  EXPECT_LT(meter.figures().load, 0.001);
  LoadMeter slow;
  for (int i = 0; i < 1000; ++i) slow.count(5'000'000, 10'000'000);  // 10 s
  EXPECT_NEAR(slow.figures().load, 0.5, 1e-4);
  for (int i = 0; i < 100; ++i) slow.count(0, 10'000'000);  // 1 s: down to 1/e
  EXPECT_NEAR(slow.figures().load, 0.5 / 2.71828, 0.002);
}

TEST(LoadMeter, P99IsAtMostOnePercentOfTheDeadlineAboveTheTruth) {
  for (int percent = 0; percent < 400; ++percent) {
    LoadMeter meter;
    const std::int64_t busy = 10 * percent + 3;
    for (int i = 0; i < 990; ++i) meter.count(busy, 1000);
    for (int i = 0; i < 10; ++i) meter.count(busy + 5000, 1000);
    const double truth = static_cast<double>(busy) / 1000;
    EXPECT_GE(meter.figures().p99, truth);
    EXPECT_LE(meter.figures().p99, truth + 0.01) << percent;
    EXPECT_NEAR(meter.figures().max, truth + 5, 1e-12);
  }
}

TEST(LoadMeter, OverrunsAreBlocksThatTookLongerThanTheyLast) {
  LoadMeter meter;
  meter.count(1000, 1000);
  meter.count(1001, 1000);
  meter.count(1'000'000, 1000);
  meter.count(-5, 1000);  // a clock that went back
  meter.count(5, 0);      // no block at all
  EXPECT_EQ(meter.figures().overruns, 2);
  EXPECT_EQ(meter.figures().max, 1000);
  EXPECT_EQ(meter.figures().p99, 1000);
}

class KeepingClient : public AudioClient {
 public:
  struct Call {
    std::int64_t frame, time_ns;
    int frames;
    std::vector<std::int64_t> midi;
    bool operator==(const Call&) const = default;
  };
  void process(const AudioBlock& block) KNOTWAVE_RT override {
    for (float* output : block.outputs) std::fill_n(output, block.frames, 1.0F);
    std::vector<std::int64_t> midi;
    for (const auto& event : block.midi) midi.push_back(event.time.sample);
    calls.push_back({block.frame, block.time_ns, block.frames, std::move(midi)});
  }
  std::vector<Call> calls;
};

TEST(BlockPump, ABlockTooLongBecomesSeveralWithTheirOwnTimesAndMessages) {
  KeepingClient client;
  BlockPump pump(client, 8192, 1);  // 8192 frames a second
  pump.open();
  std::vector<float> samples(20000);
  float* const output = samples.data();
  std::array<base::MidiEvent, 4> midi{};
  const std::int64_t at[] = {0, 8191, 8192, 19999};
  for (std::size_t i = 0; i < 4; ++i) midi[i].time.sample = at[i];
  pump.run({.frame = 100, .time_ns = 7, .outputs = {&output, 1}, .frames = 20000, .midi = midi});
  using Call = KeepingClient::Call;
  EXPECT_THAT(client.calls,
              ElementsAre(Call{100, 7, 8192, {0, 8191}}, Call{8292, 1'000'000'007, 8192, {0}},
                          Call{16484, 2'000'000'007, 3616, {3615}}));
  EXPECT_THAT(samples, ::testing::Each(1.0F));
  EXPECT_EQ(pump.blocks(), 1);
}

TEST(BlockPump, ClosedItIsSilentAndOpenAgainItSounds) {
  KeepingClient client;
  BlockPump pump(client, 48000, 2);
  std::vector<float> left(64, 9.0F), right(64, 9.0F);
  float* const outputs[] = {left.data(), right.data()};
  pump.run({.outputs = outputs, .frames = 64});
  EXPECT_THAT(left, ::testing::Each(0.0F));
  EXPECT_THAT(right, ::testing::Each(0.0F));
  EXPECT_TRUE(client.calls.empty());
  pump.open();
  pump.run({.outputs = outputs, .frames = 64});
  EXPECT_THAT(right, ::testing::Each(1.0F));
  pump.close();
  pump.run({.outputs = outputs, .frames = 64});
  EXPECT_THAT(right, ::testing::Each(0.0F));
  EXPECT_EQ(client.calls.size(), 1U);
}

TEST(BlockPump, WithoutADeadlineNoLoadIsCounted) {
  KeepingClient client;
  BlockPump pump(client, 768000, 1);
  pump.open();
  float sample = 0;
  float* const output = &sample;
  pump.run({.outputs = {&output, 1}, .frames = 1, .has_deadline = false});
  EXPECT_EQ(pump.blocks(), 1);
  EXPECT_EQ(pump.load().max, 0);
}

TEST(BlockPump, NoCallRunsOnceCloseHasReturned) {
  class Slow : public AudioClient {
   public:
    void process(const AudioBlock& /*block*/) KNOTWAVE_RT override {
      is_inside = true;
      for (int i = 0; i < 20000; ++i) spin_ = i;
      is_inside = false;
    }
    std::atomic<bool> is_inside{false};

   private:
    volatile int spin_ = 0;
  } client;
  BlockPump pump(client, 48000, 1);
  std::atomic<bool> must_end{false};
  std::thread device([&] {
    float sample = 0;
    float* const output = &sample;
    while (!must_end) pump.run({.outputs = {&output, 1}, .frames = 1});
  });
  for (int i = 0; i < 50; ++i) {
    pump.open();
    const std::int64_t blocks = pump.blocks();
    while (pump.blocks() == blocks) std::this_thread::sleep_for(100us);
    pump.close();
    EXPECT_FALSE(client.is_inside);
    const std::int64_t closed_at = pump.blocks();
    std::this_thread::sleep_for(200us);
    EXPECT_FALSE(client.is_inside);
    EXPECT_EQ(pump.blocks(), closed_at);
  }
  must_end = true;
  device.join();
}

TEST(CycleClock, FramesJumpOverWhatWasSkippedWrapAndNeverOverlap) {
  CycleClock clock;
  const auto frame_after = [&](std::uint32_t frame_time) {
    clock.advance({frame_time, 0, 64}, 0);
    return clock.frame();
  };
  EXPECT_EQ(frame_after(0xFFFFFF80U), 0);
  EXPECT_EQ(frame_after(0xFFFFFFC0U), 64);
  EXPECT_EQ(frame_after(0), 128);    // the count wraps
  EXPECT_EQ(frame_after(640), 768);  // ten cycles were skipped
  EXPECT_EQ(frame_after(650), 832);  // less than a block on: no overlap
  EXPECT_EQ(frame_after(100), 896);  // a step back
  EXPECT_EQ(frame_after(164), 960);
}

TEST(CycleClock, TimesAreThoseOfTheCycleAndNeverGoBack) {
  CycleClock clock;
  const auto time_after = [&](std::int64_t age_us, std::int64_t now_ns) {
    clock.advance({0, age_us, 64}, now_ns);
    return clock.time_ns();
  };
  EXPECT_EQ(time_after(5, 1'000'000), 995'000);
  EXPECT_EQ(time_after(100, 1'010'000), 995'000);
  EXPECT_EQ(time_after(-20, 1'020'000), 1'040'000);
  EXPECT_EQ(time_after(1'000'001, 1'050'000), 1'050'000);  // no age
  EXPECT_EQ(time_after(-500'001, 1'060'000), 1'060'000);
  EXPECT_EQ(time_after(INT64_MAX, 1'070'000), 1'070'000);
}

TEST(BlockWatch, SilenceIsEightTenthsOfASecondOrFourBlocks) {
  BlockWatch watch;
  constexpr std::int64_t kMs = 1'000'000;
  watch.restart(0);
  EXPECT_FALSE(watch.is_silent(0, 5 * kMs, 799 * kMs));
  EXPECT_TRUE(watch.is_silent(0, 5 * kMs, 800 * kMs));
  EXPECT_FALSE(watch.is_silent(1, 5 * kMs, 800 * kMs));
  EXPECT_FALSE(watch.is_silent(1, 5 * kMs, 1599 * kMs));
  EXPECT_FALSE(watch.is_silent(1, 300 * kMs, 1999 * kMs));
  EXPECT_TRUE(watch.is_silent(1, 300 * kMs, 2000 * kMs));
}

// The reader of cables, tested on its own, is the oracle: bytes are one message if it is complete
// after the last byte and not before.
TEST(CompleteMidi, AcceptsWhatACableWouldDeliverAsOneMessageAndNothingElse) {
  int accepted = 0;
  for (int status = 0; status < 256; ++status) {
    for (std::size_t size = 1; size <= 4; ++size) {
      for (const std::uint8_t data : {std::uint8_t{0}, std::uint8_t{127}, std::uint8_t{128}}) {
        std::vector<std::uint8_t> bytes(size, data);
        bytes[0] = static_cast<std::uint8_t>(status);
        MidiStream cable;
        bool is_whole = false, is_early = false;
        for (const std::uint8_t byte : bytes) {
          is_early |= is_whole;
          is_whole = cable.feed(byte);
        }
        base::MidiEvent event;
        const bool is_read = read_complete_midi(bytes, event);
        ASSERT_EQ(is_read, is_whole && !is_early) << status << " " << size << " " << int{data};
        if (!is_read) continue;
        ++accepted;
        EXPECT_TRUE(std::equal(event.bytes, event.bytes + 3, cable.message().bytes));
      }
    }
  }
  // 5 kinds of 16 channels with 3 bytes and F2; 2 kinds and F1, F3; each with data 0 and 127. The 7
  // of one byte, thrice.
  EXPECT_EQ(accepted, 2 * (5 * 16 + 1) + 2 * (2 * 16 + 2) + 3 * 7);
}

TEST(CompleteMidi, SystemExclusiveIsReferredToWhereItStands) {
  const std::uint8_t bytes[] = {0xF0, 0x7D, 1, 0xF7};
  base::MidiEvent event;
  ASSERT_TRUE(read_complete_midi(bytes, event));
  EXPECT_EQ(event.sysex, bytes + 1);
  EXPECT_EQ(event.sysex_size, 2U);
  const std::vector<std::vector<std::uint8_t>> wrong = {
      {}, {0xF0}, {0xF7}, {0xF0, 1}, {0xF0, 0x80, 0xF7}, {0xF0, 0xF8, 0xF7}, {0xF0, 0xF7, 0xF7}};
  for (const auto& message : wrong) EXPECT_FALSE(read_complete_midi(message, event));
  EXPECT_EQ(event.sysex_size, 2U);  // as it was
}

TEST(PatientCall, WorkIsDoneWhenItReturnsAndGivesBackWhatItOwns) {
  PatientCall calls;
  const auto owned = std::make_shared<int>(0);
  EXPECT_EQ(calls.run(10s, [owned] { ++*owned; }), PatientCall::Outcome::done);
  EXPECT_EQ(*owned, 1);
  EXPECT_EQ(owned.use_count(), 1);
  EXPECT_FALSE(calls.is_stuck());
}

TEST(PatientCall, WorkThatHangsIsLeftBehindOthersAreRefusedUntilItComesBack) {
  PatientCall calls;
  std::atomic<bool> may_return{false};
  const auto hang = [&] {
    while (!may_return) std::this_thread::sleep_for(1ms);
  };
  EXPECT_EQ(calls.run(20ms, hang), PatientCall::Outcome::hangs);
  EXPECT_TRUE(calls.is_stuck());
  bool has_run = false;
  EXPECT_EQ(calls.run(10s, [&] { has_run = true; }), PatientCall::Outcome::refused);
  EXPECT_FALSE(has_run);
  may_return = true;
  while (calls.is_stuck()) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(calls.run(10s, [&] { has_run = true; }), PatientCall::Outcome::done);
  EXPECT_TRUE(has_run);
}

TEST(PatientCall, CallsOfTwoThreadsTakeTurns) {
  PatientCall calls;
  std::atomic<int> inside{0}, most{0};
  const auto work = [&] {
    most = std::max(most.load(), ++inside);
    std::this_thread::sleep_for(1ms);
    --inside;
  };
  std::thread other([&] {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(calls.run(10s, work), PatientCall::Outcome::done);
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(calls.run(10s, work), PatientCall::Outcome::done);
  other.join();
  EXPECT_EQ(most, 1);
}

}  // namespace
}  // namespace knotwave::io
