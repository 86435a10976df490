// SPDX-License-Identifier: MIT
#include <vector>

#include "knotwave/dsp/smoother.h"

#include "bits.h"

namespace knotwave::bits {

void dsp() {
  dsp::Smoother smoother;
  smoother.reset(0, 480);
  std::vector<double> values(4096);
  smoother.set_target(0.7, 10);
  smoother.set_target(-0.3, 100);
  smoother.set_target(0.1, 1000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = smoother.value_at(static_cast<std::int64_t>(1000 + i));
  }
  print("smoother", values);
}

}  // namespace knotwave::bits
