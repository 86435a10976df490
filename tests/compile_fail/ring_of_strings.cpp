// SPDX-License-Identifier: MIT
// Items that own memory would be freed on the audio thread.
#include <string>

#include "knotwave/base/spsc_ring.h"

#ifdef KNOTWAVE_BAD
knotwave::base::SpscRing<std::string> ring(8);
#else
knotwave::base::SpscRing<int> ring(8);
#endif
