// SPDX-License-Identifier: MIT
#include "knotwave/base/document.h"
