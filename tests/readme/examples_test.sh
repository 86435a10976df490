#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# examples_test.sh SOURCE_DIR BUILD_DIR NINJA [PYTHON]: the "Run:" line of each example works in a copy of the
# tree whose build/release is the build under test, and what it runs is made by ./run build, or else by the
# target of the example's "Build:" line. Without PYTHON there is no Python module here, nor a part of one.
set -euo pipefail
source=$1 build=$2 ninja=$3 python=${4:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -a "$source/examples" "$work/"
mkdir -p "$work/build" "$work/out" "$work/path"
ln -s "$build" "$work/build/release"
cd "$work"
# Sound that nobody hears, for the example that plays.
printf 'pcm.!default { type null }\nctl.!default { type null }\n' >null_device.conf
export ALSA_CONFIG_PATH=$work/null_device.conf JACK_NO_START_SERVER=1 PYTHONDONTWRITEBYTECODE=1

# targets COMMAND...: what stands behind --target.
targets() { sed -nE 's/.*cmake --build --preset release --target ([a-z_ ]+[a-z]).*/\1/p' <<<"$*"; }
made_by_run=$(targets "$(sed -n '/^build()/,/^}/p' "$source/run")")
[ -n "$made_by_run" ] || { echo "./run build names no targets"; exit 1; }

count=0
for example in $(grep -rlE '^(// )?Run: ' examples | sort); do
  command=$(sed -nE 's/^(\/\/ )?Run: +//p' "$example")
  made_by=$(targets "$(grep -E '^(// )?Build: ' "$example" || true)")
  # The folder of a Python module, or a program.
  thing=$(grep -oE 'build/release/[a-z0-9_/]+' <<<"$command" | head -n 1)
  if [[ $command == *python3* ]]; then
    if [ -z "$python" ]; then
      [ ! -e "$thing/knotwave" ] || { echo "$thing holds a part of the module"; exit 1; }
      echo "$example: no Python module in this build, not run"
      continue
    fi
    ln -sf "$python" path/python3
  fi
  # shellcheck disable=SC2086
  "$ninja" -C "$build" -t commands ${made_by:-$made_by_run} >commands
  grep -qE "( -o |$build/)${thing#build/release/}( |/)" commands || { echo "$example: ${made_by:-./run build} does not build $thing"; exit 1; }
  PATH=$work/path:$PATH bash -euc "$command" >output 2>&1 || { cat output; echo "$example: '$command' fails"; exit 1; }
  [ -s output ] || { echo "$example: '$command' prints nothing"; exit 1; }
  for file in $(grep -oE '\bout/[a-z.]+' <<<"$command"); do
    [ -s "$file" ] || { echo "$example: '$command' makes no $file"; exit 1; }
  done
  count=$((count + 1))
  echo "$example: $command"
done
[ "$count" -ge 6 ] || { echo "only $count examples were run"; exit 1; }

# A tree that is configured and not built holds no half of the Python module.
cmake -S "$source" -B "$work/fresh" -G Ninja -D CMAKE_MAKE_PROGRAM="$ninja" -D KNOTWAVE_MODULES=curves >fresh.log 2>&1 ||
  { cat fresh.log; exit 1; }
[ ! -e "$work/fresh/python/knotwave" ] || { echo "configuring makes half of the Python module"; exit 1; }
