#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# links_test.sh SOURCE_DIR: every relative link of docs/*.md leads to a file, every link whose text is
# Suite.Name to a test of that name in that file, and every row of docs/from-opengl.md has such a link.
set -euo pipefail
cd "$1/docs"
failed=0
complain() { echo "$1"; failed=1; }
tests_named=0

while IFS=$'\t' read -r page text target; do
  target=${target%%#*}
  case $target in "" | http://* | https://* | mailto:*) continue ;; esac
  [ -e "$target" ] || { complain "$page links to $target, which is not there"; continue; }
  if [[ $text =~ ^([A-Za-z0-9]+)\.([A-Za-z0-9]+)$ && $target == *_test.cpp ]]; then
    tests_named=$((tests_named + 1))
    grep -qzE "TEST(_F|_P)?\(${BASH_REMATCH[1]},[[:space:]]*${BASH_REMATCH[2]}\)" "$target" ||
      complain "$page names the test $text, but $target has none of that name"
  fi
done < <(grep -oHE '\[[^][]*\]\([^()[:space:]]+\)' ./*.md | sed -E 's/^\.\/([^:]+):\[(.*)\]\((.*)\)$/\1\t\2\t\3/')

rows=0
while IFS= read -r row; do
  rows=$((rows + 1))
  [[ $row == *_test.cpp\)* ]] || complain "from-opengl.md: no test for ${row:0:60}"
done < <(grep -E '^\| *`' from-opengl.md)
[ "$rows" -ge 25 ] || complain "from-opengl.md has $rows rows, the evaluators and GLU have 25"
[ "$tests_named" -ge "$rows" ] || complain "only $tests_named tests are named"
echo "$tests_named tests are named in docs, $rows rows in from-opengl.md"
exit $failed
