// SPDX-License-Identifier: MIT
// One API of RtMidi as MidiInputs needs it: it may not work, its server may come and go, and none
// of its calls may hang the program. [control]
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "midi_cable.h"
#include "rtmidi_port.h"

namespace knotwave::io {

/// An input that is open, and what its callback fills.
struct OpenInput {
  std::shared_ptr<MidiCable> cable;
  std::unique_ptr<RtMidiInput> port;  ///< goes first
};

class MidiApi {
 public:
  MidiApi(std::string name, std::string client_name);
  /// Every input must be closed before.
  ~MidiApi();
  MidiApi(MidiApi&&) = default;
  MidiApi& operator=(MidiApi&&) = delete;

  const std::string& name() const { return name_; }
  bool works() const { return works_; }
  /// Why it does not; empty while it does.
  const std::string& fault() const { return fault_; }

  /// Tries it if it does not work: once, but a server again every 0.5 s. True: now it does.
  bool start(std::int64_t now_ns);
  /// Its server has gone: close every input, then stop().
  bool has_gone() const { return watch_ != nullptr && !watch_->is_alive(); }
  void stop();

  /// Names of the ports one can listen to.
  std::vector<std::string> sources();
  Result<OpenInput> open(const std::string& source, std::shared_ptr<MidiCable> cable);
  /// `full_name` becomes what the server calls it, where that can be known.
  Result<OpenInput> open_virtual(std::shared_ptr<MidiCable> cable, std::string& full_name);
  void close(OpenInput input);
  /// Who is connected to a port of ours. Empty where that cannot be known.
  std::vector<std::string> connections(const std::string& full_name) const;

 private:
  Result<OpenInput> make(std::shared_ptr<MidiCable> cable) const;

  std::string name_, client_name_, fault_;
  bool works_ = false;
  std::int64_t next_try_ns_ = 0;
  std::unique_ptr<JackWatch> watch_;     ///< jack
  std::unique_ptr<RtMidiInput> lister_;  ///< the others
};

}  // namespace knotwave::io
