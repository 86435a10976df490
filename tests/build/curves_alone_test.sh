#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# curves_alone_test.sh BUILD_DIR SOURCE_DIR CXX CC: KNOTWAVE_MODULES=curves, with nothing to be found but
# Highway, toml++ and the compiler. Installs it into a fresh prefix; then a C++ and a C program outside the tree
# are built and run, with find_package and with pkg-config. The build is kept, so that the second run is quick.
set -euo pipefail
build=$1/curves_alone source=$2 cxx=$3 cc=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }; }
hidden=()
for package in PkgConfig CLI11 GTest benchmark Python3 pybind11; do
  hidden+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
quietly cmake -S "$source" -B "$build" -G Ninja -DKNOTWAVE_MODULES=curves "${hidden[@]}" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O2
quietly cmake --build "$build"
quietly cmake --install "$build" --prefix "$work/prefix"
found=$(cd "$work/prefix" && find . -name 'libknotwave_*' -printf '%f\n' | sort | tr '\n' ' ')
[ "$found" = "libknotwave_base.a libknotwave_curves.a libknotwave_curves_c.so libknotwave_curves_c.so.1 " ] ||
  { echo "installed: $found"; exit 1; }
for other in dsp engine io; do
  [ ! -e "$work/prefix/include/knotwave/$other" ] || { echo "$other came along"; exit 1; }
done
if grep -rE '^#include <(toml|hwy)' "$work/prefix/include"; then echo "a header of others is asked for"; exit 1; fi

check() {
  echo "$1: $2"
  [ "$2" = "0 0.0625 0.25 0.5625 1 " ] || { echo "expected: 0 0.0625 0.25 0.5625 1"; exit 1; }
}
outside=$source/tests/build/outside_curves
quietly cmake -S "$outside" -B "$work/cmake" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc"
quietly cmake --build "$work/cmake"
check "find_package, C++" "$("$work/cmake/cpp")"
check "find_package, C" "$("$work/cmake/c")"
# One component each, in a project of that language alone.
for only in "cpp CXX curves" "c C curves_c"; do
  read -r suffix language component <<<"$only"
  mkdir "$work/only_$component"
  printf '%s\n' "cmake_minimum_required(VERSION 3.24)" "project(only LANGUAGES $language)" \
    "find_package(knotwave REQUIRED COMPONENTS $component)" "add_executable(only \"$outside/main.$suffix\")" \
    "target_link_libraries(only PRIVATE knotwave::$component)" >"$work/only_$component/CMakeLists.txt"
  quietly cmake -S "$work/only_$component" -B "$work/only_$component/build" -G Ninja \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc"
  quietly cmake --build "$work/only_$component/build"
  check "COMPONENTS $component" "$("$work/only_$component/build/only")"
done

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name knotwave-curves.pc)")
export PKG_CONFIG_PATH
pkg-config --validate knotwave-curves
pkg-config --validate knotwave-curves-c
[ "$(pkg-config --print-requires knotwave-curves | sort | tr '\n' ' ')" = "knotwave-base libhwy " ]
[ -z "$(pkg-config --print-requires knotwave-curves-c)" ]
# shellcheck disable=SC2046
quietly "$cxx" -std=c++20 $(pkg-config --cflags knotwave-curves) "$outside/main.cpp" -o "$work/cpp" $(pkg-config --libs knotwave-curves)
check "pkg-config, C++" "$("$work/cpp")"
libraries=$(pkg-config --variable=libdir knotwave-curves-c)
# shellcheck disable=SC2046
quietly "$cc" -std=c11 -Wall -Werror $(pkg-config --cflags knotwave-curves-c) "$outside/main.c" -o "$work/c" \
  $(pkg-config --libs knotwave-curves-c) "-Wl,-rpath,$libraries"
check "pkg-config, C" "$("$work/c")"

# The program, the CMakeLists.txt and the command that docs/curves.md prints.
mkdir "$work/page"
# block LANGUAGE: the first of it after the heading.
block() {
  awk -v mark="\`\`\`$1" '/^## Use it in your program/ { here = 1 } here && $0 == mark && !done { on = 1; next }
    /^```/ { if (on) done = 1; on = 0 } on' "$source/docs/curves.md"
}
block cpp >"$work/page/bell.cpp"
block cmake >"$work/page/CMakeLists.txt"
block text >"$work/page/wanted"
block sh >"$work/page/build.sh"
quietly cmake -S "$work/page" -B "$work/page/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$cxx"
quietly cmake --build "$work/page/build"
diff "$work/page/wanted" <("$work/page/build/bell")
(cd "$work/page" && sed -i "s|^c++ |$cxx |" build.sh && quietly bash -e build.sh && diff wanted <(./bell))

if cmake -S "$source" -B "$work/wrong" -G Ninja -DKNOTWAVE_MODULES=curve >"$work/log" 2>&1; then
  echo "a module that is not there was built"; exit 1
fi
grep -q "there is no 'curve'" "$work/log" || { cat "$work/log"; exit 1; }
