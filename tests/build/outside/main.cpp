// SPDX-License-Identifier: MIT
// Touches every installed module, so that each header is found and each archive links.
#include <cstdio>

#include "knotwave/base/elementary.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/tuning.h"
#include "knotwave/io/midi_file.h"

int main() {
  const knotwave::curves::CurveSpec ramp = {.name = "ramp", .degree = 1, .points = {0, 1}};
  const auto curve = knotwave::curves::NurbsCurve::create(ramp);
  if (!curve) {
    std::fprintf(stderr, "%s\n", curve.error().to_string().c_str());
    return 1;
  }
  double middle = 0;
  curve->evaluate(0.5, {&middle, 1});
  knotwave::dsp::Smoother smoother;
  smoother.reset(0.25, 64);
  const knotwave::engine::Tuning tuning;
  const auto song = knotwave::io::parse_midi({}, "empty.mid");
  std::printf("%.2f %.2f %.3f Hz, %s\n", middle, smoother.value_at(0), tuning.hz(60),
              song ? "a song" : song.error().source.c_str());
}
