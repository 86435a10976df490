// SPDX-License-Identifier: MIT
// MIDI inputs over RtMidi: all of them, as they come and go, each message stamped on arrival.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"

namespace knotwave::io {

struct MidiPortInfo {
  std::string api;  ///< "alsa", "jack", ... as RtMidi names them, in lower case
  std::string name;
};
struct MidiPortList {
  std::vector<MidiPortInfo> inputs, outputs;
  std::vector<std::string> notes;  ///< why an API has none
};
/// [control] Every API of RtMidi is asked; what one of them throws becomes a note.
MidiPortList list_midi_ports();

struct MidiInputConfig {
  std::string api;  ///< empty: every API that works
  /// Parts of names in any case; empty: all, also those to come. Virtual outputs of this program
  /// are never opened; with all, ports of ALSA that JACK shows once more are left to ALSA.
  std::vector<std::string> ports;
  /// With all, no port with this in its name, in any case: what it sends would come round. Empty:
  /// none is left out.
  std::string left_out;
  bool virtual_port = true;  ///< one of our own, "in", that others can connect to
  std::string client_name = "Knotwave";
};

inline constexpr int kMaxMidiPorts = 16;

/// Called on a thread of RtMidi's, or on that of poll(); never two calls for one port at a time.
class MidiListener {
 public:
  virtual ~MidiListener() = default;
  /// `event.port` is 0..kMaxMidiPorts-1, its time is not set: `time_ns` is, by steady_clock_ns().
  /// System exclusive data is valid during the call. Must not block or allocate.
  virtual void message(const base::MidiEvent& event, std::int64_t time_ns) noexcept = 0;
  /// The cable was pulled (with JACK also out of our own port, whoever else is in it), or active
  /// sensing went silent for 300 ms: its notes must end.
  virtual void port_lost(int port) noexcept = 0;
};

struct MidiPortStatus {
  int port = 0;
  std::string api, name;
  bool is_open = false;  ///< false: gone; it gets its number again when it comes back,
                         ///< unless all numbers were taken meanwhile
  bool is_own = false;   ///< the one that others connect to
  std::int64_t messages = 0;
  std::int64_t faults = 0;  ///< stray bytes, cut messages, system exclusive too long
};

/// [control] One thread. With RtMidi's JACK a message is stamped when its block begins to be
/// processed: up to a block late. A JACK server that dies takes its ports along, and ports are
/// there again within 0.6 s of its successor and a poll(); in between this holds no client of JACK.
class MidiInputs {
 public:
  /// `listener` must outlive it. No port at all is no error: one may come. Errors: unknown_name (an
  /// API or a port by a name nobody has; the message lists the near ones), unsupported (built
  /// without RtMidi).
  static Result<std::unique_ptr<MidiInputs>> open(const MidiInputConfig& config,
                                                  MidiListener& listener);
  virtual ~MidiInputs() = default;

  /// Looks for ports that came or went, and for active sensing that stopped: call it some ten times
  /// a second. True if a port came or went.
  virtual bool poll() = 0;
  virtual std::vector<MidiPortStatus> ports() const = 0;
  /// Lines worth telling: APIs that do not work here, ports beyond kMaxMidiPorts and left out.
  virtual std::vector<std::string> notes() const = 0;
};

}  // namespace knotwave::io
