// SPDX-License-Identifier: MIT
// RtMidi without its exceptions and its words on the terminal. [control]
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <RtMidi.h>

#include "knotwave/base/result.h"

#include "jack_watch.h"
#include "library_silence.h"

namespace knotwave::io {

/// "alsa", "jack", "core", "winmm": as RtMidi names them.
std::vector<std::string> midi_apis();
RtMidi::Api midi_api(std::string_view name);
bool is_jack(std::string_view api);
/// What RtMidi says of an API that does not work, in words a player can act on.
std::string why_not(std::string_view api, const std::string& said);

/// An RtMidiIn or RtMidiOut whose complaints are kept instead of thrown or printed. `client_name`
/// is what others see.
template <class Port>
class RtMidiPort {
 public:
  /// Errors: unsupported, with what RtMidi says. For jack only while a JackWatch lives.
  static Result<std::unique_ptr<RtMidiPort>> create(const std::string& api,
                                                    const std::string& client_name) {
    const SilentStandardError silence;
    try {
      return std::unique_ptr<RtMidiPort>(new RtMidiPort(midi_api(api), client_name));
    } catch (const RtMidiError& error) {
      return fail(ErrorCode::unsupported, why_not(api, error.getMessage()));
    } catch (const std::exception& error) {
      return fail(ErrorCode::unsupported, error.what());
    }
  }

  Port* operator->() { return &port_; }
  Port& operator*() { return port_; }
  /// Ports of others that it can be connected to, as RtMidi counts them. Those that vanish
  /// meanwhile have empty names.
  std::vector<std::string> names() {
    std::vector<std::string> all(port_.getPortCount());
    for (unsigned int i = 0; i < all.size(); ++i) all[i] = port_.getPortName(i);
    return all;
  }
  /// Connects to the port of that name. False, with complaint(), where it is not there any more.
  bool open(const std::string& name, const std::string& own_name) {
    const std::vector<std::string> all = names();
    for (unsigned int i = 0; i < all.size(); ++i) {
      if (all[i] != name) continue;
      port_.openPort(i, own_name);
      return port_.isPortOpen() && port_.getPortName(i) == name;  // the list may have moved
    }
    complaint_ = "it has gone";
    return false;
  }
  bool open_virtual(const std::string& own_name) {
    complaint_.clear();
    port_.openVirtualPort(own_name);
    return complaint_.empty();
  }
  /// The last one; empty: none.
  const std::string& complaint() const { return complaint_; }

 private:
  RtMidiPort(RtMidi::Api api, const std::string& client_name) : port_(api, client_name) {
    port_.setErrorCallback([](RtMidiError::Type, const std::string& text,
                              void* self) { static_cast<RtMidiPort*>(self)->complaint_ = text; },
                           this);
  }

  std::string complaint_;
  Port port_;
};
using RtMidiInput = RtMidiPort<RtMidiIn>;
using RtMidiOutput = RtMidiPort<RtMidiOut>;

/// Names of virtual outputs of this program, so that its inputs leave them alone. [any]
class OwnOutput {
 public:
  OwnOutput(std::string api, std::string name);
  ~OwnOutput();
  OwnOutput(const OwnOutput&) = delete;
  OwnOutput& operator=(const OwnOutput&) = delete;
  const std::string& name() const { return name_; }
  static bool has(const std::string& api, const std::string& name);

 private:
  std::string api_, name_;
};

/// What `after` holds and `before` does not: the full name that a port of ours, "...:own_name", was
/// given. Empty: none.
std::string new_name(const std::vector<std::string>& before, const std::vector<std::string>& after,
                     const std::string& own_name);

/// For messages: 'a', 'b' and 9 more, or "none".
std::string listed(const std::vector<std::string>& names);

}  // namespace knotwave::io
