// SPDX-License-Identifier: MIT
// Patches that the tests of the engine share, as text.
#pragma once
#include <string_view>

namespace knotwave::engine::scenes {

/// One oscillator and a loudness that rises in 10 ms, holds, and falls in 50 ms to exactly 0.
inline constexpr std::string_view kPlain = R"(
format = 1
kind = "patch"
name = "Plain"
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.035, 0.06,0.06,0.06]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.06
sustain_at = 0.01
release_at = 0.01
)";

/// Everything at once: two stereo sources, crossfade, shaper, filter, five envelopes and LFOs, maps
/// of every kind.
inline constexpr std::string_view kRich = R"(
format = 1
kind = "patch"
name = "Rich"
polyphony = 6
glide_s = 0.05
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.035, 0.06,0.06,0.06]
[curves.fall]
degree = 3
points = [1, 0.18, 0.04, 0.001]
weights = [1, 1.5, 2, 1]
[curves.drawn]
degree = 3
periodic = true
points = [-0.9, -0.2, 0.9, 1, 0.2, 0.7, 0.1, -0.3, 0.35, -0.5, -1]
[curves.bend]
degree = 2
points = [0, 0.2, 1]
[curves.fold]
degree = 3
points = [-1, -1.2, 1.2, 1]
knots = [-1,-1,-1,-1, 1,1,1,1]
[surfaces.morph]
degree_u = 3
degree_v = 1
periodic_u = true
points = [[0, 1, 0, -1, 0.2], [0.5, -1, 0.3, 1, -0.8]]
[surfaces.by_wheel]
degree_u = 1
degree_v = 1
knots_u = [-1,-1,1,1]
points = [[0, 0], [-1, 1]]
[oscillators.a]
wave = "morph"
pan = 0.3
[oscillators.b]
wave = "drawn"
detune_cents = 9
pan = 0.8
phase = "random"
[noise]
level_db = -30
envelope = "sweep"
[crossfade]
between = ["a", "b"]
position = 0.4
[shaper]
curve = "fold"
mix = 0.5
[filter]
kind = "low"
cutoff_hz = 1200
resonance = 0.3
key_track = 0.5
[envelopes.amp]
curve = "gate"
seconds = 0.06
sustain_at = 0.01
release_at = 0.01
[envelopes.sweep]
curve = "fall"
seconds = 0.4
velocity_time = 1
key_time = 0.5
[lfos.vibrato]
curve = "sine"
rate_hz = 5.4
[lfos.steps]
curve = "triangle"
beats = 0.5
mode = "free"
[[maps]]
from = ["vibrato", "mod"]
surface = "by_wheel"
to = "pitch"
depth = 0.4
[[maps]]
from = "sweep"
to = "filter.cutoff"
depth = 30
[[maps]]
from = "pressure"
curve = "bend"
to = "a.position"
[[maps]]
from = "timbre"
to = "crossfade"
depth = 0.5
[[maps]]
from = "steps"
to = "pan"
depth = 0.2
[[maps]]
from = "velocity"
to = "shaper.drive"
depth = 6
[[maps]]
from = "mod"
to = "curve.fall.weight.1"
low = 0.5
high = 3
[[maps]]
from = "vibrato"
to = "b.pitch"
depth = 0.1
)";

/// A loudness that ends at a thousandth and a sound that ends before its key is up.
inline constexpr std::string_view kEndsAboveZero = R"(
format = 1
kind = "patch"
name = "Struck"
velocity_db = 18
[curves.ring]
degree = 4
points = [1, 0.15962, 0.030761, 0.0058833, 0.001]
weights = [0.033544, 0.068924, 0.15018, 0.35327, 1]
[oscillators.a]
wave = "triangle"
[envelopes.amp]
curve = "ring"
seconds = 0.05
velocity_time = 0.3
)";

}  // namespace knotwave::engine::scenes
