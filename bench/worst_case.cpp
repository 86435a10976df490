// SPDX-License-Identifier: MIT
// worst_case rank|song|bursts|voices [--replays N] [--blocks N] PATCH...: what blocks of 64 frames
// at 48 kHz cost the live engine, as Markdown tables for bench/results/live.md. See replay.h.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "knotwave/base/random.h"

#include "replay.h"

namespace {

using namespace knotwave;
using namespace knotwave::bench;

constexpr int kVoices = 64;
constexpr int kChannels = 16;
constexpr int kMostVoices = 4096;

struct Options {
  std::string verb;
  std::vector<std::string> patches;
  int replays = 5;
  int blocks = 100000;
};

std::string name_of(const std::string& patch) {
  return std::filesystem::path(patch).stem().string();
}

engine::BankSpec bank_of(const std::string& patch) {
  auto bank = engine::read_bank(patch);
  if (!bank) {
    std::cerr << bank.error().to_string() << "\n";
    std::exit(EXIT_FAILURE);
  }
  for (engine::PatchSpec& one : bank->patches) one.polyphony = kMostVoices;
  return *std::move(bank);
}

std::string fixed(double value, int digits = 1) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}
std::string share(double us) { return fixed(100 * us / kDeadlineUs) + " %"; }

Played note(int block, int offset, int voice, bool on) {
  const auto status = static_cast<std::uint8_t>((on ? 0x90 : 0x80) | voice % kChannels);
  // Four keys a channel, all different, over five octaves.
  const auto key = static_cast<std::uint8_t>(36 + (voice * 37) % 61);
  return {block, offset, {status, key, static_cast<std::uint8_t>(64 + voice % 64)}};
}

/// Every voice begins in `block`, at one sample or spread over it.
void add_chord(Script& script, int block, int voices, bool spread, bool on = true) {
  for (int v = 0; v < voices; ++v) {
    script.messages.push_back(note(block, spread ? v * kBlockFrames / voices : 0, v, on));
  }
}

Script held_chord(int voices, int blocks) {
  Script script;
  script.blocks = blocks;
  add_chord(script, 0, voices, false);
  return script;
}

/// Times of the blocks after the first in which so many voices sounded.
std::vector<double> with_voices(const Replay& replay, int voices) {
  std::vector<double> us;
  for (std::size_t b = 1; b < replay.us.size(); ++b) {
    if (replay.voices[b] == voices) us.push_back(replay.us[b]);
  }
  return us;
}

// --- rank: which patch is the heaviest ---

void rank(const Options& options) {
  struct Row {
    std::string name;
    double us = 0;
    std::size_t blocks = 0;
  };
  std::vector<Row> rows;
  for (const std::string& patch : options.patches) {
    const engine::BankSpec bank = bank_of(patch);
    const Replay heard = replay(bank, held_chord(kVoices, 750), {.replays = options.replays});
    const int voices = *std::max_element(heard.voices.begin(), heard.voices.end());
    const std::vector<double> us = with_voices(heard, voices);
    if (us.empty()) continue;
    rows.push_back({name_of(patch) + (voices < kVoices ? " (" + std::to_string(voices) + ")" : ""),
                    percentile(us, 50) * kVoices / voices, us.size()});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.us > b.us; });
  std::cout << "| patch | 64 voices, us a block | share of 1.333 ms | ns a sample and voice |\n"
               "|---|---|---|---|\n";
  for (const Row& row : rows) {
    std::cout << "| " << row.name << " | " << fixed(row.us) << " | " << share(row.us) << " | "
              << fixed(row.us * 1e3 / kBlockFrames / kVoices) << " |\n";
  }
}

// --- song: a MIDI cable as full as it gets, 64 voices throughout ---

/// About one message a block, as many as fit through a MIDI cable: controllers of all kinds, and
/// one in eight a new note in place of an old one.
Script full_cable(int blocks) {
  Script script;
  script.blocks = blocks;
  script.through_ring = true;
  add_chord(script, 0, kVoices, true);
  const base::RandomStream random{4, 0, 0};
  std::uint64_t draw = 0;
  const auto next = [&](int below) { return static_cast<int>(random.unit(draw++) * below); };
  int voice = 0;
  for (int block = 1; block < blocks; ++block) {
    const int offset = next(kBlockFrames);
    const int kind = next(8), channel = next(kChannels), value = next(128);
    const auto status = [&](int high) { return static_cast<std::uint8_t>(high | channel); };
    const auto byte = [](int number) { return static_cast<std::uint8_t>(number); };
    if (kind == 0) {
      script.messages.push_back(note(block, offset, voice, false));
      script.messages.push_back(note(block, offset, voice, true));
      voice = (voice + 1) % kVoices;
    } else if (kind == 1) {
      script.messages.push_back({block, offset, {status(0xE0), byte(next(128)), byte(value)}});
    } else if (kind == 2) {
      script.messages.push_back({block, offset, {status(0xD0), byte(value), 0}});
    } else if (kind == 3) {
      const Played struck = note(block, offset, voice, true);
      script.messages.push_back(
          {block, offset, {byte(0xA0 | (struck.bytes[0] & 15)), struck.bytes[1], byte(value)}});
    } else {
      constexpr std::array<int, 4> kControllers = {1, 11, 74, 10};
      const int controller = kControllers[static_cast<std::size_t>(kind - 4)];
      script.messages.push_back({block, offset, {status(0xB0), byte(controller), byte(value)}});
    }
  }
  return script;
}

void song(const Options& options) {
  std::cout << "| patch | voices | p50 | p99 | p99.99 | max | p99.99 | max |\n"
               "|---|---|---|---|---|---|---|---|\n";
  for (const std::string& patch : options.patches) {
    const Replay heard =
        replay(bank_of(patch), full_cable(options.blocks), {.replays = options.replays});
    const std::span<const double> all(heard.us);
    // Without the first, which begins from nothing: that is a burst.
    const std::vector<double> us(all.begin() + 4, all.end());
    const int fewest = *std::min_element(heard.voices.begin() + 4, heard.voices.end());
    std::cout << "| " << name_of(patch) << " | " << fewest << " or more | ";
    for (const double p : {50.0, 99.0, 99.99, 100.0}) {
      std::cout << fixed(percentile(us, p)) << " us | ";
    }
    std::cout << share(percentile(us, 99.99)) << " | " << share(percentile(us, 100)) << " |"
              << std::endl;
    std::cerr << name_of(patch) << ": sha256 " << heard.sha256 << "\n";
  }
}

// --- bursts ---

struct Burst {
  const char* name;
  Script script;
  int from = 0, to = 0;  ///< the blocks it is looked for in
};

std::vector<Burst> bursts() {
  constexpr int kAt = 40, kEnd = 240;
  std::vector<Burst> all;
  const auto add = [&](const char* name, auto&& change) {
    Burst burst{name, held_chord(kVoices, kEnd), kAt, kEnd};
    change(burst);
    all.push_back(std::move(burst));
  };
  const auto from_silence = [&](Burst& burst, bool spread) {
    burst.script.messages.clear();
    add_chord(burst.script, kAt, kVoices, spread);
  };
  add("64 notes begin at one sample", [&](Burst& b) { from_silence(b, false); });
  add("64 notes begin in one block, one a sample", [&](Burst& b) { from_silence(b, true); });
  add("the bank is exchanged", [&](Burst& b) { b.script.swap_block = kAt; });
  add("64 notes end at one sample",
      [&](Burst& b) { add_chord(b.script, kAt, kVoices, false, false); });
  add("64 notes end in one block, one a sample",
      [&](Burst& b) { add_chord(b.script, kAt, kVoices, true, false); });
  add("64 notes take the voices of 64 that sound",
      [&](Burst& b) { add_chord(b.script, kAt, kVoices, false); });
  add("64 controllers move, one a sample", [&](Burst& b) {
    for (int i = 0; i < kBlockFrames; ++i) {
      const auto status = static_cast<std::uint8_t>(0xB0 | i % kChannels);
      b.script.messages.push_back({kAt, i, {status, 1, static_cast<std::uint8_t>(2 * i)}});
    }
  });
  add("all sound off on 16 channels", [&](Burst& b) {
    for (int c = 0; c < kChannels; ++c) {
      b.script.messages.push_back({kAt, 0, {static_cast<std::uint8_t>(0xB0 | c), 120, 0}});
    }
  });
  return all;
}

void show_bursts(const Options& options) {
  for (const std::string& patch : options.patches) {
    const engine::BankSpec bank = bank_of(patch);
    const double median = percentile(
        with_voices(replay(bank, held_chord(kVoices, 240), {.replays = options.replays}), kVoices),
        50);
    std::cout << "| " << name_of(patch) << ", median block of 64 voices " << fixed(median)
              << " us | most in a block | share of the deadline | times the median |\n"
                 "|---|---|---|---|\n";
    for (const Burst& burst : bursts()) {
      const Replay heard = replay(bank, burst.script, {.replays = options.replays});
      const double most =
          *std::max_element(heard.us.begin() + burst.from, heard.us.begin() + burst.to);
      std::cout << "| " << burst.name << " | " << fixed(most) << " us | " << share(most) << " | "
                << fixed(most / median, 2) << " |" << std::endl;
    }
    std::cout << "\n";
  }
}

// --- voices: how many of them a core holds ---

/// The 99th percentile of blocks in which all of them sound.
double us_of(const engine::BankSpec& bank, int voices, int threads, int replays) {
  const Replay heard = replay(bank, held_chord(voices, 150),
                              {.max_voices = voices, .threads = threads, .replays = replays});
  const std::vector<double> us = with_voices(heard, voices);
  if (us.empty()) {
    std::cerr << "worst_case: " << voices << " voices never sound at once\n";
    std::exit(EXIT_FAILURE);
  }
  return percentile(us, 99);
}

int voices_within(const engine::BankSpec& bank, double limit_us, int threads, int replays) {
  int low = 1, high = kMostVoices;
  while (high - low > std::max(1, low / 100)) {
    const int middle = (low + high) / 2;
    (us_of(bank, middle, threads, replays) <= limit_us ? low : high) = middle;
  }
  return low;
}

void voices(const Options& options) {
  std::cout << "| patch | one core | two cores |\n|---|---|---|\n";
  for (const std::string& patch : options.patches) {
    const engine::BankSpec bank = bank_of(patch);
    std::cout << "| " << name_of(patch) << " |";
    for (const int threads : {1, 2}) {
      std::cout << " " << voices_within(bank, 0.9 * kDeadlineUs, threads, options.replays) << " |"
                << std::flush;
    }
    std::cout << std::endl;
  }
}

bool read_options(int argc, char** argv, Options& options) {
  const std::span<char*> words(argv, static_cast<std::size_t>(argc));
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    int* number = word == "--replays"  ? &options.replays
                  : word == "--blocks" ? &options.blocks
                                       : nullptr;
    if (number != nullptr) {
      if (++i == words.size() || (*number = std::atoi(words[i])) < 1) return false;
    } else if (options.verb.empty()) {
      options.verb = word;
    } else {
      options.patches.push_back(word);
    }
  }
  return !options.patches.empty();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (read_options(argc, argv, options)) {
    if (options.verb == "rank") return rank(options), EXIT_SUCCESS;
    if (options.verb == "song") return song(options), EXIT_SUCCESS;
    if (options.verb == "bursts") return show_bursts(options), EXIT_SUCCESS;
    if (options.verb == "voices") return voices(options), EXIT_SUCCESS;
  }
  std::cerr << "worst_case rank|song|bursts|voices [--replays N] [--blocks N] PATCH...\n";
  return 2;
}
