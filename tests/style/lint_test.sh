#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# lint_test.sh SOURCE_DIR BUILD_DIR CLANG_TIDY changed|all: clang-tidy over the sources of the last commit and
# of the working tree, or over all of them. Modules not in `clean` are looked at by `all` only.
set -euo pipefail
source=$1 build=$2 tidy=$3 which=$4
clean='^base/'
cd "$source"
if [ "$which" = all ]; then
  files=$(find base curves dsp engine io apps -name '*.cpp')
elif git rev-parse -q --verify HEAD~1 >/dev/null; then
  files=$({ git diff --name-only --diff-filter=d HEAD~1; git ls-files --others --exclude-standard; } | grep -E '\.cpp$' | grep -E "$clean" || true)
else
  files=$(find base -name '*.cpp')
  echo "no commit before this one: base is looked at"
fi
[ -n "$files" ] || { echo "the last commit touched no source of these modules"; exit 0; }
echo "$files"
# The compile commands may be gcc's, with warnings clang does not know.
# shellcheck disable=SC2086
printf '%s\n' $files | xargs -P 2 -n 1 "$tidy" -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option
