// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/file.h"
#include "knotwave/engine/bank.h"
#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/engine.h"

#include "bits.h"

namespace knotwave::bits {
namespace {

using engine::Event;

template <typename T>
T value_of(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().to_string().c_str());
    std::exit(1);
  }
  return *std::move(result);
}

Event midi(std::int64_t sample, int status, int one, int two) {
  Event event;
  event.midi.time = {sample, 0x40000000};
  event.midi.bytes[0] = static_cast<std::uint8_t>(status);
  event.midi.bytes[1] = static_cast<std::uint8_t>(one);
  event.midi.bytes[2] = static_cast<std::uint8_t>(two);
  return event;
}

/// A chord with everything that moves a patch: velocity, wheel, bend, pressure, timbre, pan,
/// retriggers, portamento, and a zone of MPE with a bent member.
std::vector<Event> everything() {
  return {midi(0, 0x90, 40, 30),     midi(100, 0x90, 64, 127),  midi(900, 0xB0, 1, 90),
          midi(1500, 0xE0, 5, 100),  midi(2000, 0xD0, 77, 0),   midi(2600, 0xB0, 74, 20),
          midi(3000, 0xB0, 10, 20),  midi(3300, 0x90, 64, 90),  midi(3700, 0xB0, 5, 40),
          midi(3800, 0xB0, 65, 127), midi(4000, 0x90, 76, 101), midi(5000, 0x80, 40, 64),
          midi(5200, 0xBF, 101, 0),  midi(5200, 0xBF, 100, 6),  midi(5200, 0xBF, 6, 3),
          midi(5400, 0x9E, 67, 99),  midi(5800, 0xEE, 0, 90),   midi(6000, 0x80, 64, 10),
          midi(6500, 0x80, 76, 127), midi(6600, 0x8E, 67, 0)};
}

void print_bank(const std::string& name, const engine::BankSpec& spec,
                const std::vector<Event>& events) {
  const auto bank = value_of(engine::BankProgram::create(spec));
  const auto player = value_of(engine::Engine::create({.rate_hz = 44100}, bank.get()));
  std::vector<float> sound(2 * 9000);
  const auto left = std::span(sound).first(9000), right = std::span(sound).last(9000);
  player->process(events, left, right);
  print(name, sound);
}

/// Every patch there is, in the order of its name.
void print_patches(const std::filesystem::path& examples) {
  std::set<std::filesystem::path> patches;
  for (const auto& entry : std::filesystem::directory_iterator(examples / "patches")) {
    if (entry.path().extension() == ".toml") patches.insert(entry.path());
  }
  for (const auto& path : patches) {
    print_bank("patch " + path.stem().string(), value_of(engine::read_bank(path.string())),
               everything());
  }
}

/// Each drum key once, one soon after the other.
void print_drums(const std::filesystem::path& examples) {
  std::vector<Event> events;
  for (int key = 27; key < 88; ++key) events.push_back(midi(50 * (key - 27), 0x99, key, 100));
  const auto bank = (examples / "banks" / "general-midi.toml").string();
  print_bank("drums", value_of(engine::read_bank(bank)), events);
}

/// One patch in a scale of a file.
void print_tuning(const std::filesystem::path& examples) {
  auto bank = value_of(engine::read_bank((examples / "patches" / "organ.toml").string()));
  const auto text_of = [&](const char* name) {
    return value_of(base::read_file((examples / "tunings" / name).string(), 1 << 20));
  };
  const std::string scale = text_of("bohlen-pierce.scl"), keys = text_of("c_261.kbm");
  for (engine::PatchSpec& patch : bank.patches) {
    patch.tuning = value_of(engine::Tuning::create(scale, "scale", keys, "keys"));
  }
  print_bank("tuning", bank, everything());
}

}  // namespace

void engine(const std::string& examples) {
  print_patches(examples);
  print_drums(examples);
  print_tuning(examples);
}

}  // namespace knotwave::bits
