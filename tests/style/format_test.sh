#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# format_test.sh SOURCE_DIR CLANG_FORMAT: every source is as clang-format leaves it.
set -euo pipefail
cd "$1"
find base curves dsp engine io plugins apps examples tests bench \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 "$2" --dry-run --Werror
