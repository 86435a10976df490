// SPDX-License-Identifier: MIT
// You learn: how a curve is compiled for the audio thread and played as an envelope over a tone.
// Run:       build/release/bin/02_hear_it_as_an_envelope examples/curves/decay.toml out/tone.wav
// It plays:  two seconds of a 440 Hz sine that dies away by 60 dB, straight on a dB meter.
// Next:      03_hear_it_as_a_wave.cpp
#include <cstdio>
#include <vector>

#include "knotwave/base/elementary.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/io/sound_file.h"

using namespace knotwave;

namespace {

int complain(const Error& error) {
  std::fprintf(stderr, "%s\n", error.to_string().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CURVES.toml OUT.wav\n", argv[0]);
    return 2;
  }
  const auto set = curves::read_curves(argv[1]);
  if (!set) return complain(set.error());
  if (set->curves.empty()) return complain(fail(ErrorCode::missing_key, "the file holds no curve"));

  // A curve is for editing. A program is for the audio thread: polynomial pieces, nothing to fail.
  const auto program = curves::compile_function(set->curves.front());
  if (!program) return complain(program.error());
  std::printf("%d piece(s), largest error %g\n", program->piece_count(), program->max_error());

  constexpr int kRateHz = 48000;
  constexpr int kFrames = 2 * kRateHz;
  std::vector<float> envelope(kFrames);
  // An audio block is a map grid: a start, a step, a count. Blocks of any size give the same bits.
  const double step = (program->u_max() - program->u_min()) / kFrames;
  curves::CurveCursor cursor;
  constexpr int kBlock = 64;
  for (int first = 0; first < kFrames; first += kBlock) {
    const curves::GridRun run{program->u_min(), step, first};
    program->render(run, std::span(envelope).subspan(static_cast<std::size_t>(first), kBlock),
                    cursor);
  }

  std::vector<float> stereo(2 * std::size_t{kFrames});
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double cycles = 440.0 * static_cast<double>(i) / kRateHz;
    const double tone = 0.5 * base::sin_cos_cycles(cycles).sin;
    stereo[2 * i] = stereo[2 * i + 1] = static_cast<float>(tone) * envelope[i];
  }

  auto writer = io::SoundWriter::create({.path = argv[2], .rate_hz = kRateHz});
  if (!writer) return complain(writer.error());
  if (auto ok = writer->write(stereo); !ok) return complain(ok.error());
  if (auto ok = writer->finish(); !ok) return complain(ok.error());
  std::printf("%s: 2 s of 440 Hz\n", argv[2]);
  return 0;
}
