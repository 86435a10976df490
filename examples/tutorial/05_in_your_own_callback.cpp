// SPDX-License-Identifier: MIT
// You learn: how to use a compiled curve inside an audio callback of your own.
// Run:       build/release/bin/05_in_your_own_callback examples/curves/decay.toml
// It plays:  one soft stroke a second for five seconds, or says that there is no sound device.
// Next:      docs/architecture.md, and the header of whatever you need.
#include <cstdint>
#include <cstdio>
#include <span>

#include <portaudio.h>

#include "knotwave/base/elementary.h"
#include "knotwave/base/time.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_file.h"

using namespace knotwave;

namespace {

constexpr int kRateHz = 48000;

/// All the callback needs, made before it starts. Nothing here allocates or fails afterwards.
struct Player {
  curves::CurveProgram envelope;
  curves::CurveCursor cursor;
  base::Phase phase;
  base::Phase step = base::phase_increment(440.0, kRateHz);
  std::int64_t now = 0;

  void render(std::span<float> stereo) KNOTWAVE_RT {
    const double u_per_sample = (envelope.u_max() - envelope.u_min()) / kRateHz;
    for (std::size_t i = 0; i < stereo.size(); i += 2, ++now) {
      // Time is a whole number of samples; u is made from it, never added up.
      const double since = static_cast<double>(now % kRateHz);
      const double level = envelope.at_u(envelope.u_min() + since * u_per_sample);
      const double tone = 0.25 * base::sin_cos_cycles(phase.cycles()).sin;
      stereo[i] = stereo[i + 1] = static_cast<float>(tone * level);
      phase = phase + step;
    }
  }
};

int callback(const void*, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*,
             PaStreamCallbackFlags, void* user) {
  static_cast<Player*>(user)->render({static_cast<float*>(output), 2 * frames});
  return paContinue;
}

int complain(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  return 1;
}

int play(Player& player) {
  if (Pa_GetDefaultOutputDevice() == paNoDevice) {
    std::printf("no sound device here; the same code runs wherever there is one\n");
    return 0;
  }
  PaStream* stream = nullptr;
  PaError error = Pa_OpenDefaultStream(&stream, 0, 2, paFloat32, kRateHz,
                                       paFramesPerBufferUnspecified, callback, &player);
  if (error == paNoError) error = Pa_StartStream(stream);
  if (error != paNoError) return complain(Pa_GetErrorText(error));
  std::printf("playing for five seconds\n");
  Pa_Sleep(5000);
  error = Pa_CloseStream(stream);
  return error == paNoError ? 0 : complain(Pa_GetErrorText(error));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return complain("usage: 05_in_your_own_callback CURVES.toml");
  const auto set = curves::read_curves(argv[1]);
  if (!set) return complain(set.error().to_string().c_str());
  if (set->curves.empty()) return complain("the file holds no curve");
  auto program = curves::compile_function(set->curves.front());
  if (!program) return complain(program.error().to_string().c_str());

  Player player{.envelope = std::move(*program), .cursor = {}, .phase = {}};
  if (Pa_Initialize() != paNoError) return complain("PortAudio does not start");
  const int code = play(player);
  Pa_Terminate();
  return code;
}
