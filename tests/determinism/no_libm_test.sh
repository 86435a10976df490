#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# no_libm_test.sh NM CXX ARCHIVE...: the libraries that make samples call no function of libm, whose bits
# differ between versions and processors. sqrt, floor, ceil, trunc, round and fabs are exact and may be called.
set -euo pipefail
nm=$1 cxx=$2
shift 2
names='sin|cos|tan|sincos|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|fma|erf|erfc|tgamma|lgamma|fmod|remainder'
pattern="^ +U (__)?($names)(f|l|f32|f64)?(_finite)?(@.*)?\$"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '#include <cmath>\ndouble f(double a) { return std::sin(a); }\nfloat g(float a) { return std::pow(a, a); }\n' >"$work/libm.cpp"
"$cxx" -O2 -c "$work/libm.cpp" -o "$work/libm.o"
[ "$("$nm" -u "$work/libm.o" | grep -cE "$pattern")" = 2 ] || { echo "the pattern finds nothing"; exit 1; }

for archive in "$@"; do
  "$nm" -u "$archive" >"$work/undefined"
  echo "$(basename "$archive"): $(wc -l <"$work/undefined") undefined symbols"
  if grep -E "$pattern" "$work/undefined" >"$work/found"; then
    echo "$archive calls libm:"
    sort -u "$work/found"
    exit 1
  fi
done
