// SPDX-License-Identifier: MIT
#include "knotwave/base/suggest.h"
