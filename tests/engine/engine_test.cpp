// SPDX-License-Identifier: MIT
#include "knotwave/engine/engine.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <system_error>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes.h"
#include "support/allocation_count.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

std::size_t first_sounding(const Sound& sound) {
  for (std::size_t i = 0; i < sound.left.size(); ++i) {
    if (sound.left[i] != 0) return i;
  }
  return sound.left.size();
}

TEST(Engine, IsSilentAndIdleWithoutNotes) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {}, 1000);
  EXPECT_EQ(peak(sound.left), 0);
  EXPECT_TRUE(engine->is_idle());
  EXPECT_EQ(engine->now(), 1000);
}

TEST(Engine, ANoteBeginsAtItsSampleAndEndsWithItsEnvelope) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {on(1000, 0, 69), off(24000, 0, 69)}, 48000);
  EXPECT_EQ(peak(sound.left, 0, 1001), 0);
  EXPECT_GT(peak(sound.left, 1001, 1010), 0);
  EXPECT_EQ(peak(sound.left, 24000 + 2401, 48000), 0);  // 50 ms of release
  EXPECT_TRUE(engine->is_idle());
}

TEST(Engine, ANoteBetweenTwoSamplesIsFirstHeardAtTheNext) {
  const auto bank = bank_from(kPlain);
  const auto a = engine_for(*bank);
  const auto b = engine_for(*bank);
  // The sine starts at phase 0 with loudness 0, so the sample of the note itself is 0.
  const Sound whole = play(*a, {midi(100, 0x90, 69, 127)}, 4096, 64);
  const Sound between = play(*b, {midi(99, 0x90, 69, 127, 0x80000000)}, 4096, 33);
  EXPECT_EQ(first_sounding(whole), 101U);
  EXPECT_EQ(first_sounding(between), 100U);
  // Half a sample earlier: in the middle of two samples of the later one, up to its curvature.
  for (std::size_t i = 1000; i < 2000; ++i) {
    EXPECT_NEAR(between.left[i], (whole.left[i] + whole.left[i + 1]) / 2.0, 2e-4);
  }
}

TEST(Engine, OneFullNotePeaksSixteenDecibelsBelowFullScale) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {on(0, 0, 69, 127)}, 48000);
  // -9 dB a voice, -3.01 dB centre pan, -4.15 dB channel volume 100.
  EXPECT_NEAR(20 * std::log10(peak(sound.left)), -9 - 3.0103 + 40 * std::log10(100 / 127.0), 0.01);
  EXPECT_NEAR(20 * std::log10(peak(sound.right)), -16.16, 0.01);
}

TEST(Engine, LateAndEarlyEventsArePlayedAndCounted) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  std::vector<float> left(256), right(256);
  engine->process({}, left, right);
  const std::vector<Event> events = {on(10, 0, 60), on(300, 0, 64), off(5000, 0, 64)};
  engine->process(events, left, right);
  EXPECT_EQ(engine->counters().notes, 2);
  EXPECT_EQ(engine->counters().events_late, 2);
  EXPECT_GT(peak(left), 0);
}

TEST(Engine, RefusesWhatItCannotDo) {
  const auto bank = bank_from(kPlain);
  for (EngineConfig config : {EngineConfig{.rate_hz = 7999}, EngineConfig{.rate_hz = 800000},
                              EngineConfig{.max_voices = 0}, EngineConfig{.threads = 0},
                              EngineConfig{.threads = 65}, EngineConfig{.volume_db = 100}}) {
    const auto made = Engine::create(config, bank.get());
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::value_out_of_range);
  }
  EXPECT_FALSE(Engine::create({}, nullptr));
}

/// In a process of its own that may start no thread: 0 when create() says so, else what is wrong.
int refusal_without_threads(const BankProgram* bank) {
  const rlimit none{1, 1};
  const bool is_bound = ::setrlimit(RLIMIT_NPROC, &none) == 0 &&
                        (::geteuid() != 0 || ::setuid(65534) == 0);  // no limit binds root
  if (!is_bound) return 3;
  const auto made = Engine::create({.threads = 8}, bank);
  if (made) return 1;
  const std::string text = "the number of threads is 8; this system starts 1 and no more: " +
                           std::generic_category().message(EAGAIN);
  const bool is_told =
      made.error().code == ErrorCode::value_out_of_range && made.error().message == text;
  return is_told ? 0 : 2;
}

TEST(Engine, ThreadsTheSystemDoesNotStartAreAnError) {
  const auto bank = bank_from(kPlain);
  const pid_t child = ::fork();
  if (child == 0) ::_exit(refusal_without_threads(bank.get()));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  if (WEXITSTATUS(status) == 3) GTEST_SKIP() << "no right to become a user with a limit";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Engine, ProcessAllocatesNothing) {
  const auto bank = bank_from(kRich);
  const auto engine = engine_for(*bank, {.max_voices = 8});
  std::vector<Event> events;
  for (int i = 0; i < 40; ++i) events.push_back(on(i * 100, i % 16, 40 + i, 100));
  for (int i = 0; i < 40; ++i) events.push_back(off(4000 + i * 10, i % 16, 40 + i));
  events.push_back(of_kind(4600, Event::Kind::all_notes_off));
  std::vector<float> left(4096), right(4096);
  const auto half = std::find_if(events.begin(), events.end(),
                                 [](const Event& e) { return e.time().sample >= 4096; });
  const std::span<const Event> first(events.begin(), half), second(half, events.end());
  EXPECT_EQ(support::allocations_in([&] {
              engine->process(first, left, right);
              engine->process(second, left, right);
            }),
            0);
}

TEST(Engine, ResetGivesTheSameBitsAgain) {
  const auto bank = bank_from(kRich);
  const auto engine = engine_for(*bank);
  const std::vector<Event> events = {on(0, 0, 60), control(100, 0, 1, 127), control(200, 3, 7, 5),
                                     on(4000, 3, 67), off(9000, 0, 60)};
  const Sound once = play(*engine, events, 12000);
  engine->reset();
  EXPECT_EQ(engine->now(), 0);
  EXPECT_TRUE(engine->is_idle());
  EXPECT_TRUE(once == play(*engine, events, 12000));
}

TEST(Engine, StemsAddUpToTheMixToTheBit) {
  const auto bank = bank_from(kRich);
  const auto engine = engine_for(*bank);
  std::vector<Event> events;
  for (int c = 0; c < 16; c += 3) events.push_back(on(c * 10, c, 50 + c));
  constexpr std::size_t kFrames = 3000;
  std::vector<std::vector<float>> buffers(32, std::vector<float>(kFrames, 9.0F));
  std::vector<Engine::Stem> stems;
  for (std::size_t c = 0; c < 16; ++c) stems.push_back({buffers[2 * c], buffers[2 * c + 1]});
  std::vector<float> left(kFrames), right(kFrames);
  engine->process(events, left, right, stems);
  EXPECT_GT(peak(left), 0);
  for (std::size_t i = 0; i < kFrames; ++i) {
    float sum_left = 0, sum_right = 0;
    for (std::size_t c = 0; c < 16; ++c) {
      sum_left += buffers[2 * c][i];
      sum_right += buffers[2 * c + 1][i];
    }
    ASSERT_EQ(sum_left, left[i]) << i;
    ASSERT_EQ(sum_right, right[i]) << i;
  }
}

}  // namespace
}  // namespace knotwave::engine
