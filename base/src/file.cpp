// SPDX-License-Identifier: MIT
#include "knotwave/base/file.h"
