#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols_test.sh NM LIBRARY SOURCE_DIR: the shared library shows the functions its headers declare and no
# other name, and every one of them is called by a test.
set -euo pipefail
nm=$1 library=$2 source=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
headers=$source/curves/c/include/knotwave
sed -e 's|//.*||' "$headers"/curves.h "$headers"/c/*.h | tr '\n' ' ' | grep -oE 'KW_API [^;{]*\(' |
  grep -oE 'kw_[a-z0-9_]+ *\($' | tr -d ' (' | sort -u >"$work/declared"
"$nm" -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | sort -u >"$work/shown"
[ "$(wc -l <"$work/declared")" -gt 100 ] || { echo "the headers declare little"; exit 1; }
diff "$work/declared" "$work/shown" || { echo "< declared in the headers, > shown by the library"; exit 1; }
grep -ohE '\bkw_[a-z0-9_]+' "$source"/tests/curves_c/*.cpp "$source"/tests/curves_c/*.h | sort -u >"$work/called"
untested=$(comm -23 "$work/declared" "$work/called")
[ -z "$untested" ] || { echo "no test calls:"; echo "$untested"; exit 1; }
echo "$(wc -l <"$work/declared") functions"
