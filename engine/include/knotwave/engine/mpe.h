// SPDX-License-Identifier: MIT
// MPE zones: which channels carry single notes and which one speaks for all of them.
// Source: MIDI Polyphonic Expression 1.0 (M1-100-UM). All [audio].
#pragma once
#include "knotwave/base/rt.h"

namespace knotwave::engine {

inline constexpr double kMpeMemberBendSemitones = 48;
inline constexpr double kMpeMasterBendSemitones = 2;
inline constexpr int kLowerMaster = 0;   ///< channel 1
inline constexpr int kUpperMaster = 15;  ///< channel 16

/// The lower zone is channel 1 with members from 2 upwards, the upper one channel 16 with members
/// from 15 downwards. Channels count from 0.
class MpeZones {
 public:
  void reset() KNOTWAVE_RT { lower_ = upper_ = 0; }
  /// RPN 6 on `channel`: members 0 closes the zone. The newer zone takes channels from the older.
  /// False when the channel is no master (the message then means nothing).
  bool configure(int channel, int members) KNOTWAVE_RT;

  int lower_members() const KNOTWAVE_RT { return lower_; }
  int upper_members() const KNOTWAVE_RT { return upper_; }
  bool is_member(int channel) const KNOTWAVE_RT { return master_of(channel) != channel; }
  /// `channel` speaks for a zone.
  bool is_master(int channel) const KNOTWAVE_RT {
    return (channel == kLowerMaster && lower_ > 0) || (channel == kUpperMaster && upper_ > 0);
  }
  /// The channel that speaks for `channel`: the zone's master, or itself outside zones.
  int master_of(int channel) const KNOTWAVE_RT;

 private:
  int lower_ = 0, upper_ = 0;
};

}  // namespace knotwave::engine
