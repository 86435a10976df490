// SPDX-License-Identifier: MIT
#include "knotwave/base/sha256.h"
