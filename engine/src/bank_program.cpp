// SPDX-License-Identifier: MIT
#include "knotwave/engine/bank_program.h"
