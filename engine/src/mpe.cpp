// SPDX-License-Identifier: MIT
#include "knotwave/engine/mpe.h"

#include <algorithm>

namespace knotwave::engine {

bool MpeZones::configure(int channel, int members) KNOTWAVE_RT {
  members = std::clamp(members, 0, 15);
  if (channel == kLowerMaster) {
    lower_ = members;
    upper_ = std::min(upper_, std::max(0, 14 - lower_));
    return true;
  }
  if (channel == kUpperMaster) {
    upper_ = members;
    lower_ = std::min(lower_, std::max(0, 14 - upper_));
    return true;
  }
  return false;
}

int MpeZones::master_of(int channel) const KNOTWAVE_RT {
  if (lower_ > 0 && channel > kLowerMaster && channel <= kLowerMaster + lower_) return kLowerMaster;
  if (upper_ > 0 && channel < kUpperMaster && channel >= kUpperMaster - upper_) return kUpperMaster;
  return channel;
}

}  // namespace knotwave::engine
