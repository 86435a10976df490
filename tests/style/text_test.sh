#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# text_test.sh SOURCE_DIR: what every source must have (the licence line first) and must not have.
set -euo pipefail
cd "$1"
failed=0
complain() { echo "$1"; failed=1; }
sources=$(find base curves dsp engine io apps examples tests bench \( -name '*.h' -o -name '*.cpp' \))

for file in $sources; do
  [ "$(head -n 1 "$file")" = "// SPDX-License-Identifier: MIT" ] || complain "$file: the first line is not the licence line"
done
for file in $(find base curves dsp engine io -path '*/include/*.h') ; do
  grep -q '^#pragma once$' "$file" || complain "$file: no #pragma once"
  [ "$(wc -l <"$file")" -le 260 ] || complain "$file: longer than 260 lines"
done
for file in $sources; do
  case $file in tests/*) most=800 ;; *) most=500 ;; esac
  [ "$(wc -l <"$file")" -le $most ] || complain "$file: longer than $most lines"
done

# forbid WORDS WHY: nowhere in what we wrote, but in this file.
forbid() {
  local found
  if found=$(grep -rnE --include='*.h' --include='*.cpp' --include='*.cmake' --include='CMakeLists.txt' \
    --include='*.md' --include='*.toml' --include='*.sh' --include='*.py' --exclude=text_test.sh -e "$1" \
    base curves dsp engine io apps examples tests bench cmake docs tools README.md CHANGELOG.md); then
    complain "$2:"
    echo "$found" | head -n 10
  fi
}
forbid '\b(TODO|FIXME|XXX)\b' "work left for later belongs into an issue"
forbid '(^|[^A-Za-z0-9_.])/(work|home|root)/' "a path of one machine"
forbid 'hwy::[A-Za-z0-9_:]*MulAdd|\bMulAdd\(|std::fma\b' "a fused multiply-add"
forbid '(reinterpret_cast|static_cast)<[^>]*>\(std::rand\(|\bstd::rand\(|\bsrand\(' "random numbers come from base/random.h"
exit $failed
