#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# without_audio_test.sh BUILD_DIR SOURCE_DIR CXX: all audio parts OFF. Builds every library and the
# programs that are left, and runs the tests of the modules the parts touch. Kept between runs, so that
# the second run is quick; ccache shares what both builds compile.
set -euo pipefail
work=$1/without_audio source=$2 cxx=$3
cmake -S "$source" -B "$work" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O2 -DKNOTWAVE_BUILD_EXAMPLES=OFF \
  -DKNOTWAVE_WITH_SNDFILE=OFF -DKNOTWAVE_WITH_PORTAUDIO=OFF -DKNOTWAVE_WITH_JACK=OFF \
  -DKNOTWAVE_WITH_RTMIDI=OFF -DKNOTWAVE_WITH_LIBLO=OFF >"$work.log" ||
  { cat "$work.log"; exit 1; }
for part in SNDFILE PORTAUDIO JACK RTMIDI LIBLO; do
  grep -q "Knotwave: $part off" "$work.log" || { echo "$part is not off"; cat "$work.log"; exit 1; }
done
targets=(knotwave_base knotwave_curves knotwave_dsp knotwave_engine knotwave_io test_io programs)
cmake --build "$work" --target "${targets[@]}" 2>&1 | tail -n 30
ctest --test-dir "$work" -L '^io$' -LE 'stress|soak' --output-on-failure -j2 | tail -n 15
exit "${PIPESTATUS[0]}"
