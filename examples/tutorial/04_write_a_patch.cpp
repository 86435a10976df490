// SPDX-License-Identifier: MIT
// You learn: how a patch, a few notes and the engine make a sound, without any file but the output.
// Run:       build/release/bin/04_write_a_patch out/patch.wav
// It plays:  three notes of a bell; the third is struck harder and rings brighter.
// Next:      05_in_your_own_callback.cpp
#include <cstdio>
#include <vector>

#include "knotwave/engine/engine.h"
#include "knotwave/io/sound_file.h"

using namespace knotwave;

namespace {

constexpr int kRateHz = 48000;

constexpr const char* kPatch = R"(
format = 1
kind   = "patch"
name   = "Tutorial bell"

[curves.ring]                    # 60 dB of decay in five points
degree  = 4
points  = [1, 0.15962, 0.030761, 0.0058833, 0.001]
weights = [0.033544, 0.068924, 0.15018, 0.35327, 1]

[oscillators.body]
wave = "sine"
[oscillators.shine]
wave = "sine"
ratio = 2.76
level_db = -18

[envelopes.amp]
curve = "ring"
seconds = 1.5

[[maps]]
from = "velocity"
to = "shine.level"
depth = 12
)";

int complain(const Error& error) {
  std::fprintf(stderr, "%s\n", error.to_string().c_str());
  return 1;
}

engine::Event note_on(double seconds, int key, int velocity) {
  engine::Event event;
  event.midi.time.sample = static_cast<std::int64_t>(seconds * kRateHz);
  event.midi.bytes[0] = 0x90;
  event.midi.bytes[1] = static_cast<std::uint8_t>(key);
  event.midi.bytes[2] = static_cast<std::uint8_t>(velocity);
  return event;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s OUT.wav\n", argv[0]);
    return 2;
  }
  auto patch = engine::parse_patch(kPatch, "tutorial");
  if (!patch) return complain(patch.error());
  const auto bank = engine::BankProgram::create(engine::bank_of(std::move(*patch)));
  if (!bank) return complain(bank.error());
  const auto engine = engine::Engine::create({.rate_hz = kRateHz}, bank->get());
  if (!engine) return complain(engine.error());

  const engine::Event notes[] = {note_on(0, 60, 70), note_on(0.5, 67, 70), note_on(1, 76, 120)};
  constexpr std::size_t kFrames = std::size_t{3} * kRateHz;
  std::vector<float> left(kFrames), right(kFrames), stereo(2 * kFrames);
  // One block of three seconds or many of 64 samples: the bits are the same.
  (*engine)->process(notes, left, right);
  for (std::size_t i = 0; i < kFrames; ++i) {
    stereo[2 * i] = left[i];
    stereo[2 * i + 1] = right[i];
  }

  auto writer = io::SoundWriter::create({.path = argv[1], .rate_hz = kRateHz});
  if (!writer) return complain(writer.error());
  if (auto ok = writer->write(stereo); !ok) return complain(ok.error());
  if (auto ok = writer->finish(); !ok) return complain(ok.error());
  std::printf("%s: %lld notes\n", argv[1], static_cast<long long>((*engine)->counters().notes));
  return 0;
}
