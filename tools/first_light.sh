#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# first_light.sh BIN_DIR: what ./run demo shows. Renders the first-light score, draws the curve of its decay
# and says what one should hear.
set -euo pipefail
bin=$1
curve=examples/curves/decay.toml#decay60
mkdir -p out
"$bin/knotwave-curve" plot "$curve"
"$bin/knotwave-curve" plot "$curve" -o out/first-light.svg
"$bin/knotwave-curve" plot "$curve" -o out/first-light.png
"$bin/knotwave-render" --demo first-light -o out/first-light.wav
cat <<'TEXT'

Listen to out/first-light.wav: the same four notes, four times, each time with one more idea.
  1. straight lines: a plain decay, drawn with a ruler
  2. five points: one rational curve of degree 4 rings like a struck string, straight on a dB meter
  3. one weight swept: the same points, one of them pulls harder and harder
  4. a surface scanned: the wave itself changes all the way through each note
The picture of the decay is out/first-light.svg and .png.
TEXT
