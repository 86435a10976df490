#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# matrix_test.sh SOURCE_DIR BUILD_DIR CXX [quick|full]: builds the libraries and the subject programs once per
# row (compiler, -O level, instruction set) with warnings as errors, and compares every line they print, on
# every vector unit. A new subject is a line in bits_*.cpp or in hashes(); a new row is a line at the end.
set -euo pipefail
source=$1 build=$2 cxx=$3 size=${4:-quick}
work=$build/determinism
mkdir -p "$work"

# hashes BIN LEVEL: what a row prints on one vector unit: NAME HASH, one subject a line.
hashes() {
  local bin=$1 level=$2
  "$bin/knotwave_bits" "$source/examples" "$level" || return
  "$bin/knotwave-render" --demo first-light -o "$work/render.wav" --quiet --json "$work/render.json" \
    --simd "$level" >/dev/null || return
  sed -nE 's/.*"sha256": "([0-9a-f]{64})".*/first-light \1/p' "$work/render.json" | head -n 1
}

# The build the test belongs to is the first row; it is built already.
hashes "$build/bin" best >"$work/this.bits"
[ -s "$work/this.bits" ] || { echo "this build printed nothing"; exit 1; }
echo "this build: $(wc -l <"$work/this.bits") subjects"

# compare NAME BIN LEVEL: that build on that unit prints what the first row printed.
compare() {
  local name=$1 bin=$2 level=$3
  if ! hashes "$bin" "$level" >"$work/$name.bits" 2>"$work/$name.said"; then
    # Only a build for AVX-512 alone, or a processor without AVX2, has no AVX2 to compare.
    if [ "$level" = avx2 ] && grep -q 'has no AVX2' "$work/$name.said"; then
      echo "$name: NOT compared on avx2: $(head -n 1 "$work/$name.said")"
      return
    fi
    cat "$work/$name.said"
    exit 1
  fi
  diff "$work/this.bits" "$work/$name.bits" || { echo "$name differs from this build on $level"; exit 1; }
  echo "$name: the same bits on $level: $(cat "$work/$name.said")"
}
compare this-build "$build/bin" avx2
compare this-build "$build/bin" baseline

# row NAME COMPILER FLAGS
row() {
  local name=$1 compiler=$2 flags=$3
  command -v "$compiler" >/dev/null || { echo "$name: no $compiler here; ./run test installs it"; exit 1; }
  cmake -S "$source" -B "$work/$name" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="$flags" \
    -DKNOTWAVE_BUILD_EXAMPLES=OFF >"$work/$name.log" 2>&1 || { cat "$work/$name.log"; exit 1; }
  local targets=(knotwave_bits knotwave-render)
  cmake --build "$work/$name" --target "${targets[@]}" >"$work/$name.log" 2>&1 ||
    { tail -n 60 "$work/$name.log"; exit 1; }
  for level in best avx2 baseline; do compare "$name" "$work/$name/bin" "$level"; done
}

row gcc-O0 "$cxx" "-O0"
row clang-O3 clang++-14 "-O3"
if [ "$size" = full ]; then
  row gcc-O3 "$cxx" "-O3"
  row clang-O0 clang++-14 "-O0"
  row gcc-O3-v3 "$cxx" "-O3 -march=x86-64-v3"
  row clang-O3-v3 clang++-14 "-O3 -march=x86-64-v3"
fi
