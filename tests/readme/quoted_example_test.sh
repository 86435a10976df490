#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# quoted_example_test.sh PAGE LANGUAGE FILE COMMAND...: the first ```LANGUAGE block of PAGE is FILE, and COMMAND
# prints the first ```text block. `UPDATE=1` writes both into the page instead.
set -euo pipefail
page=$1 language=$2 file=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$@" >"$work/output" || { cat "$work/output"; exit 1; }
# block WORD: the lines of the first block of that language.
block() { awk -v mark="\`\`\`$1" '$0 == mark && !done { on = 1; next } /^```/ { if (on) done = 1; on = 0 } on' "$page"; }
if [ -n "${UPDATE:-}" ]; then
  awk -v code="$file" -v output="$work/output" -v mark="\`\`\`$language" '
    function quote(name,  line) { while ((getline line < name) > 0) print line; seen[name] = 1 }
    $0 == mark && !(code in seen) { print; quote(code); skip = 1; next }
    $0 == "```text" && !(output in seen) { print; quote(output); skip = 1; next }
    /^```/ { skip = 0 }
    !skip' "$page" >"$work/page"
  cp "$work/page" "$page"
fi
diff <(block "$language") "$file" || { echo "$page quotes another text than $file"; exit 1; }
diff <(block text) "$work/output" || { echo "$page states other output than the program prints"; exit 1; }
