#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# demo_env.sh BIN_DIR: what ./run demo-env shows. A shipped score opens a filter by MIDI, without any device: what
# would be sent becomes a MIDI file and a picture.
set -euo pipefail
bin=$1
mkdir -p out
"$bin/knotwave-env" examples/envelopes/filter-swell.toml --dry-run examples/scores/first-light.mid \
  -o out/filter-swell.mid --plot out/filter-swell.svg
cat <<'TEXT'

out/filter-swell.mid is what a synth would be sent: the notes, and CC 74 at the times where the curve crosses from
step to step, as fast as a MIDI cable carries them. out/filter-swell.svg shows the steps over the curve.
TEXT
