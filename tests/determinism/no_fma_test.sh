#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# no_fma_test.sh OBJDUMP CXX ARCHIVE...: disassembles the libraries and finds no fused multiply-add, nor an
# approximate reciprocal. Shows first, on a function made for it, that it would find one.
set -euo pipefail
objdump=$1 cxx=$2
shift 2
case $(uname -m) in
  x86_64) fused='\bvfn?m(add|sub|addsub|subadd)[0-9]*[ps][sd]\b|\bv?(rcp|rsqrt)(14|28)?[ps][sd]\b' flag=-mfma ;;
  aarch64) fused='\bfn?m(add|sub|la|ls)\b|\bf(recpe|rsqrte)\b' flag= ;;
  *) echo "no pattern for $(uname -m): nothing was checked"; exit 1 ;;
esac

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo 'double f(double a, double b, double c) { return __builtin_fma(a, b, c); }' >"$work/fused.cpp"
# shellcheck disable=SC2086
"$cxx" -O2 $flag -c "$work/fused.cpp" -o "$work/fused.o"
"$objdump" -d --no-show-raw-insn "$work/fused.o" | grep -qE "$fused" || { echo "the pattern finds nothing"; exit 1; }

total=0
for archive in "$@"; do
  "$objdump" -d --no-show-raw-insn "$archive" >"$work/text"
  count=$(grep -cE '^ +[0-9a-f]+:' "$work/text" || true)
  total=$((total + count))
  echo "$(basename "$archive"): $count instructions"
  if grep -nE "$fused" "$work/text" >"$work/found"; then
    echo "$archive: fused or approximate instructions:"
    head -n 20 "$work/found"
    exit 1
  fi
done
[ "$total" -gt 1000 ] || { echo "only $total instructions seen"; exit 1; }
