#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# readme_test.sh SOURCE_DIR BUILD_DIR: runs every ```sh block of README.md, one after another, in a copy of
# the tree whose build/release is the build under test; then looks for every ```text block, line by line, and
# every hash of the README in what was printed. Verbs of ./run that would run this test again are left out.
set -euo pipefail
source=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -a "$source/run" "$source/CMakePresets.json" "$source/examples" "$source/tools" "$source/README.md" "$work/"
mkdir -p "$work/build"
ln -s "$build" "$work/build/release"
touch -d @0 "$work/CMakePresets.json"
# No sound device of this machine takes part: its rate would be another, and its owner would hear it.
printf 'pcm.none { type hw card 31 }\n' >"$work/no_device.conf"  # PortAudio aborts where ALSA names none
export ALSA_CONFIG_PATH=$work/no_device.conf JACK_NO_START_SERVER=1 JACK_DEFAULT_SERVER=none.$$
cd "$work"

awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' README.md |
  grep -vE '^\./run (test|build|bench)|^git clone|^cd ' >commands.sh
[ -s commands.sh ] || { echo "the README holds no commands"; exit 1; }
echo "--- commands"; cat commands.sh
bash -euo pipefail commands.sh >output.txt 2>&1 || { cat output.txt; echo "a command of the README failed"; exit 1; }
echo "--- output"; cat output.txt

awk '/^```text$/ { on = 1; next } /^```/ { on = 0 } on' README.md >expected.txt
grep -oE '\b[0-9a-f]{64}\b' README.md >hashes.txt || { echo "the README states no hash"; exit 1; }
failed=0
while IFS= read -r line; do
  grep -qF -- "$line" output.txt || { echo "not printed: $line"; failed=1; }
done < <(cat hashes.txt expected.txt)
for file in $(grep -oE '\bout/[a-z0-9_.-]+\.(wav|svg|png|flac)' README.md | sort -u); do
  [ -s "$file" ] || { echo "the README names $file, but it was not made"; failed=1; }
done
peak=$("$build/bin/knotwave-render" --quiet --journal out/take.journal -o out/again.wav --json - |
  sed -nE 's/.*"peak_dbfs": (-?[0-9.]+).*/\1/p' | xargs printf '%.2f')
grep -qF -- "peak is $peak dBFS" README.md || { echo "the take's peak is $peak dBFS"; failed=1; }
for path in $(grep -oE '\]\([A-Za-z][A-Za-z0-9_./-]*\)' README.md | tr -d '])('); do
  [ -e "$source/$path" ] || { echo "the README links to $path, which is not there"; failed=1; }
done
exit $failed
