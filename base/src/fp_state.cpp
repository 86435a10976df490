// SPDX-License-Identifier: MIT
#include "knotwave/base/fp_state.h"
