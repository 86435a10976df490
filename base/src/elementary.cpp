// SPDX-License-Identifier: MIT
#include "knotwave/base/elementary.h"
