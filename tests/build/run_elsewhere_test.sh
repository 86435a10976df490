#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run_elsewhere_test.sh SOURCE_DIR: where there is no apt, ./run names all that is missing in one message and
# installs nothing. The system is one of a few commands that say what they are told to have.
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
for tool in bash env dirname cat; do ln -s "$(command -v "$tool")" "$work/bin/$tool"; done
failed=0

# have NAME TEXT: a command that runs TEXT.
have() { printf '#!%s/bin/bash\n%s\n' "$work" "$2" >"$work/bin/$1"; chmod +x "$work/bin/$1"; }

# expect VERB MISSING: the first line of what ./run VERB says, which ends with 1.
expect() {
  local code=0 said
  said=$(env -i PATH="$work/bin" "$work/bin/bash" "$source/run" "$1" 2>&1) || code=$?
  if [ "$code" != 1 ] || [ "${said%%$'\n'*}" != "run: missing here: $2" ]; then
    printf '%s: ended with %s\nsaid:     %s\nexpected: run: missing here: %s\n' "$1" "$code" "$said" "$2"
    failed=1
  fi
}

modules="libhwy tomlplusplus CLI11 sndfile portaudio-2.0 jack rtmidi liblo libebur128 gtest gmock benchmark"
tools="clang++-14 clang-format-14 clang-tidy-14 python3 midicsv objdump git jackd mandoc zsh fish desktop-file-validate dpkg-shlibdeps file"
expect build "c++ cmake ninja ccache pkg-config $modules"
expect demo "c++ cmake ninja ccache pkg-config $modules"
expect test "c++ cmake ninja ccache pkg-config $modules $tools pybind11"

for tool in cmake ninja ccache; do have "$tool" "exit 0"; done
have c++ "exit 1"         # finds no header
have pkg-config "exit 1"  # knows no module
expect build "$modules"

have pkg-config '[ "$2" != CLI11 ] && [ "$2" != tomlplusplus ] && [ "$2" != gtest ]'
expect build "tomlplusplus CLI11 gtest"
have c++ 'read -r line && [ "$line" = "#include <toml++/toml.h>" ]'  # a header without a .pc file
expect build "CLI11 gtest"

have pkg-config "exit 0"
for tool in clang++-14 clang-tidy-14 midicsv objdump git jackd mandoc zsh fish desktop-file-validate dpkg-shlibdeps file; do
  have "$tool" "exit 0"
done
have python3 "exit 1"  # without any module
expect test "clang-format-14 python3-mido python3-mpmath python3-numpy python3-pytest python3-scipy"
exit $failed
