// SPDX-License-Identifier: MIT
// The engine knows no device and no file.
#ifdef KNOTWAVE_BAD
#include "knotwave/io/midi_file.h"
#else
#include "knotwave/dsp/smoother.h"
#endif
