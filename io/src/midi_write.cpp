// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_file.h"
