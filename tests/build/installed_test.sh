#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# installed_test.sh BUILD_DIR SOURCE_DIR CXX [TARGET]: installs into a fresh prefix, then builds and runs a program
# outside the tree twice: with find_package and with pkg-config.
set -euo pipefail
build=$1 source=$2 cxx=$3 more=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2086
cmake --build "$build" --target installable $more >"$work/build.log" || { tail -n 30 "$work/build.log"; exit 1; }
cmake --install "$build" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
expected="0.50 0.25 261.626 Hz, empty.mid"

check() {
  echo "$1: $2"
  case $2 in "$expected"*) ;; *) echo "expected: $expected..."; exit 1 ;; esac
}

cmake -S "$source/tests/build/outside" -B "$work/cmake" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release >"$work/cmake.log" || { cat "$work/cmake.log"; exit 1; }
cmake --build "$work/cmake"
check find_package "$("$work/cmake/outside")"

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name knotwave-base.pc)")
export PKG_CONFIG_PATH
for module in base curves curves-c dsp engine io; do pkg-config --validate "knotwave-$module"; done
# shellcheck disable=SC2046
"$cxx" -std=c++20 -O1 $(pkg-config --cflags knotwave-engine knotwave-io) \
  "$source/tests/build/outside/main.cpp" -o "$work/outside" $(pkg-config --libs knotwave-engine knotwave-io)
check pkg-config "$("$work/outside")"

if find_error=$(cmake -S "$source/tests/build/outside" -B "$work/none" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DKNOTWAVE_TEST_COMPONENT=no_such_part 2>&1); then
  echo "a component that is not there was found"; exit 1
fi
grep -q "no_such_part" <<<"$find_error" || { echo "$find_error"; exit 1; }
