// SPDX-License-Identifier: MIT
// Plays the synth of this test by OSC, so whatever becomes of MIDI and sound servers.
#pragma once
#include <lo/lo.h>

#include "live/synth_scene.h"

namespace knotwave::synth {

class OscSender {
 public:
  OscSender() : to_(lo_address_new("127.0.0.1", osc_port().c_str())) {}
  ~OscSender() { lo_address_free(to_); }
  OscSender(const OscSender&) = delete;
  OscSender& operator=(const OscSender&) = delete;

  void note_on(int key) { lo_send(to_, "/note", "ii", key, 127); }
  void note_off(int key) { lo_send(to_, "/off", "i", key); }
  void load(const std::string& patch) { lo_send(to_, "/patch", "s", patch.c_str()); }
  /// That it is heard by the player, if not by anyone else.
  void hold_note(const SynthProcess& synth) {
    note_on(69);
    seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 20);
    ASSERT_GT(synth.number("peak_left_dbfs"), -30) << synth.out() << synth.err();
  }

 private:
  lo_address to_;
};

}  // namespace knotwave::synth
