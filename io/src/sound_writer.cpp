// SPDX-License-Identifier: MIT
#include "knotwave/io/sound_file.h"
