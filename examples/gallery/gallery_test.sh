#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# gallery_test.sh PROGRAM: every picture and its sound are there, pictures are well-formed and without
# a number that is none, and a second run makes the same bytes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" "$work/a"
"$1" "$work/b" >/dev/null
for name in string_art_quadratic string_art_cubic bernstein surface moving_knot; do
  [ -s "$work/a/$name.svg" ] || { echo "no picture $name.svg"; exit 1; }
  [ "$(wc -c <"$work/a/$name.wav")" -gt 1000000 ] || { echo "no sound $name.wav, or hardly any"; exit 1; }
  python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' "$work/a/$name.svg"
  if grep -qE '\b(nan|inf)\b' "$work/a/$name.svg"; then echo "$name.svg holds a number that is none"; exit 1; fi
done
diff -r "$work/a" "$work/b"
