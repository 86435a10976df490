// SPDX-License-Identifier: MIT
// The same journal gives the same bits for any block size and number of threads.
#include <algorithm>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// Notes, bends, wheels, pedals, tempo, song positions, program changes and targets on all channels
/// at odd times.
std::vector<Event> busy_journal(std::uint64_t seed, int count, std::int64_t frames) {
  const base::RandomStream random{seed, 0, 77};
  std::vector<Event> events;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](int which, int below) {
      return static_cast<int>(random.unit(static_cast<std::uint64_t>(i * 8 + which)) * below);
    };
    const std::int64_t sample = static_cast<std::int64_t>(draw(0, 1 << 30)) * frames >> 30;
    const auto fraction =
        static_cast<std::uint32_t>(random.bits(static_cast<std::uint64_t>(i * 8 + 1)));
    const int channel = draw(2, 16), kind = draw(3, 14);
    Event event = midi(sample, 0x90 | channel, 36 + draw(4, 48), 1 + draw(5, 127), fraction);
    if (kind >= 5) event.midi.bytes[0] = static_cast<std::uint8_t>(0x80 | channel);
    constexpr int kControls[] = {1, 7, 10, 11, 64, 66, 67, 74};
    if (kind == 8) {
      event = midi(sample, 0xB0 | channel, kControls[draw(4, 8)], draw(5, 128), fraction);
    } else if (kind == 9) {
      event = midi(sample, 0xE0 | channel, draw(4, 128), draw(5, 128), fraction);
    } else if (kind == 10) {
      event = midi(sample, 0xD0 | channel, draw(4, 128), 0, fraction);
    } else if (kind == 11) {
      event = of_kind(sample, Event::Kind::tempo);
      event.microseconds_per_quarter = 200000 + static_cast<std::uint32_t>(draw(4, 800000));
    } else if (kind == 12) {
      event = of_kind(sample, Event::Kind::set_target);
      event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
      event.every_channel = draw(7, 3) == 0;
      event.slot = static_cast<std::uint16_t>(draw(4, kSlotCount + 1));
      if (event.slot == kSlotCount) event.slot = Event::kEverySlot;
      event.number = draw(5, 4) == 0 ? 0 : draw(6, 1000) / 250.0 - 2;
    }
    if (kind == 13) {
      event = of_kind(sample, Event::Kind::position);
      event.midi.time.fraction = fraction;
      event.song_clocks = draw(4, 10000);
    }
    events.push_back(event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time() < b.time(); });
  return events;
}

/// Many events a piece: besides those above poly pressure, pan, modes, parameters, zones and banks.
std::vector<Event> crowded_journal(std::uint64_t seed, int count, std::int64_t frames,
                                   const BankProgram& one, const BankProgram& two) {
  std::vector<Event> events = busy_journal(seed, count, frames);
  const base::RandomStream random{seed, 1, 77};
  for (int i = 0; i < count / 2; ++i) {
    const auto draw = [&](int which, int below) {
      return static_cast<int>(random.unit(static_cast<std::uint64_t>(i * 8 + which)) * below);
    };
    const std::int64_t sample = static_cast<std::int64_t>(draw(0, 1 << 30)) * frames >> 30;
    const int channel = draw(2, 16), kind = draw(3, 40);
    constexpr int kOthers[] = {0, 5, 6, 32, 38, 65, 84, 96, 100, 101, 120, 121, 123, 126, 127};
    Event event = midi(sample, 0xA0 | channel, 36 + draw(4, 48), draw(5, 128));
    if (kind < 10) {
      event = control(sample, channel, draw(4, 2) == 0 ? kPan : kVolume, draw(5, 128));
    } else if (kind < 14) {
      event = control(sample, channel, kOthers[draw(4, 15)], draw(5, 128));
    } else if (kind == 14) {
      event = midi(sample, 0xC0 | channel, draw(4, 128), 0);
    } else if (kind == 15) {
      event = of_kind(sample, Event::Kind::install_bank);
      event.bank = draw(4, 2) == 0 ? &one : &two;
    } else if (kind < 24 || kind == 39) {
      event = of_kind(sample, kind == 39 ? Event::Kind::choke : Event::Kind::set_note);
      event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
      constexpr int kKeys[] = {40, 47, 60, Event::kEveryKey};
      event.midi.bytes[1] = static_cast<std::uint8_t>(kKeys[draw(4, 4)]);
      event.note = draw(5, 2) == 0 ? draw(6, 200) : Event::kNoNote;
      event.every_channel = draw(5, 8) == 1;
      event.is_expression = draw(7, 2) == 0;
      event.slot = static_cast<std::uint16_t>(draw(6, kSlotCount));
      if (kind == 16) event.slot = Event::kNotePressure;
      if (kind == 17) event.slot = Event::kNoteTimbre;
      event.number = draw(7, 1000) / 500.0 - 1;
    }
    if (kind >= 24 && kind < 32) {
      event = midi(sample, (kind < 29 ? 0x90 : 0x80) | channel, 36 + draw(4, 48), 1 + draw(5, 127));
      event.note = draw(6, 200);
    }
    events.push_back(event);
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time() < b.time(); });
  return events;
}

void expect_same(const Sound& expected, const Sound& found, const std::string& what) {
  ASSERT_EQ(expected.left.size(), found.left.size());
  for (std::size_t i = 0; i < expected.left.size(); ++i) {
    ASSERT_EQ(expected.left[i], found.left[i]) << what << ", sample " << i;
    ASSERT_EQ(expected.right[i], found.right[i]) << what << ", sample " << i;
  }
}

struct Case {
  const char* name;
  std::string patch;
};

class Determinism : public testing::TestWithParam<Case> {};

TEST_P(Determinism, AnyBlockSizeGivesTheSameBits) {
  const auto bank = bank_from(GetParam().patch);
  constexpr std::int64_t kFrames = 12000;
  const auto events = busy_journal(support::test_seed(), 160, kFrames);
  const auto render = [&](std::size_t block) {
    const auto engine = engine_for(*bank, {.max_voices = 10});
    return play(*engine, events, kFrames, block);
  };
  const Sound expected = render(4096);
  EXPECT_GT(peak(expected.left), 0.01);
  for (const std::size_t block : {1UL, 7UL, 64UL, 100UL, 256UL, 12000UL}) {
    expect_same(expected, render(block), "block " + std::to_string(block));
  }
}

TEST_P(Determinism, ACrowdOfEventsGivesTheSameBitsAsOneSampleAtATime) {
  const auto bank = bank_from(GetParam().patch), other = bank_from(GetParam().patch);
  constexpr std::int64_t kFrames = 6000;
  const auto events = crowded_journal(support::test_seed(), 1500, kFrames, *bank, *other);
  const auto render = [&](std::size_t block, int threads) {
    const auto engine = engine_for(*bank, {.max_voices = 12, .threads = threads});
    return play(*engine, events, kFrames, block);
  };
  const Sound expected = render(1, 1);
  EXPECT_GT(peak(expected.left), 0.01);
  for (const std::size_t block : {13UL, 64UL, 255UL, 6000UL}) {
    expect_same(expected, render(block, 1), "block " + std::to_string(block));
  }
  expect_same(expected, render(512, 2), "2 threads");
}

TEST_P(Determinism, AnyNumberOfThreadsGivesTheSameBits) {
  const auto bank = bank_from(GetParam().patch);
  constexpr std::int64_t kFrames = 20000;
  const auto events = busy_journal(support::test_seed() + 1, 200, kFrames);
  const auto render = [&](int threads) {
    const auto engine = engine_for(*bank, {.max_voices = 24, .threads = threads});
    return play(*engine, events, kFrames, 512);
  };
  const Sound expected = render(1);
  for (const int threads : {2, 3, 4}) {
    expect_same(expected, render(threads), std::to_string(threads) + " threads");
  }
}

INSTANTIATE_TEST_SUITE_P(
    Patches, Determinism,
    testing::Values(Case{"Rich", std::string(kRich)}, Case{"Mono", with(kRich, "mode = \"mono\"")},
                    Case{"Legato", with(kRich, "mode = \"legato\"\npriority = \"low\"")},
                    Case{"Plain", std::string(kPlain)},
                    Case{"EndsAboveZero", std::string(kEndsAboveZero)}),
    [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

TEST(DeterminismOfSeeds, TheEngineSeedChangesWhatIsRandomAndNothingElse) {
  const auto random = bank_from(kRich), fixed = bank_from(kPlain);
  const auto render = [](const BankProgram& bank, std::uint64_t seed) {
    return play(*engine_for(bank, {.seed = seed}), {on(0, 0, 60)}, 2000);
  };
  EXPECT_FALSE(render(*random, 1) == render(*random, 2));
  EXPECT_TRUE(render(*fixed, 1) == render(*fixed, 2));
}

}  // namespace
}  // namespace knotwave::engine
