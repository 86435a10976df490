#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# render_splits_test.sh RENDERER SOURCE_DIR: one song, rendered with every block size, number of threads and
# instruction set, has one hash.
set -euo pipefail
renderer=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
first=""
has_avx2=true
"$renderer" --demo first-light --check --simd avx2 >"$work/said" 2>&1 || {
  grep -q 'has no AVX2' "$work/said" || { cat "$work/said"; exit 1; }
  has_avx2=false
  cat "$work/said"
}
for options in "" "--block 1" "--block 7" "--block 64" "--block 4096" "--threads 2" "--threads 4" \
  "--threads 4 --block 7" "--simd baseline" "--simd avx2" "--bits 32f"; do
  if [ "$options" = "--simd avx2" ] && ! "$has_avx2"; then continue; fi
  # shellcheck disable=SC2086
  "$renderer" "$source/examples/banks/general-midi.toml" "$source/examples/scores/groove.mid" \
    -o "$work/out.wav" --quiet --json "$work/report.json" $options >/dev/null
  hash=$(sed -nE 's/.*"sha256": "([0-9a-f]{64})".*/\1/p' "$work/report.json" | head -n 1)
  echo "${hash:0:16} ${options:-as it comes}"
  [ -n "$hash" ] || { cat "$work/report.json"; exit 1; }
  first=${first:-$hash}
  [ "$hash" = "$first" ] || { echo "another hash"; exit 1; }
done
