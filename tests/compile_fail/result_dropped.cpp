// SPDX-License-Identifier: MIT
// An error nobody looks at.
#include "knotwave/base/file.h"

void save() {
#ifdef KNOTWAVE_BAD
  knotwave::base::write_file("x", "");
#else
  if (!knotwave::base::write_file("x", "")) return;
#endif
}
