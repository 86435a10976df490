// SPDX-License-Identifier: MIT
// Ardour 7 without a window: its Lua sessions, with a home of their own, only our module in it and
// nothing that changes a sample. Debian's package ardour.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "support/background_program.h"
#include "support/program.h"

namespace knotwave::support {

/// Ardour 7.3 without a window fails now and then of its own, whatever the plugin:
/// - two of its threads write to JACK's socket at once while a session is made, which JACK answers
///   by letting the client go ("JACK HALTED"); nothing is processed from there on;
/// - it dies of its own heap (glibc says so) while a session with a plugin is loaded, with its own
///   Reasonable Synth as well.
/// Then it is started again, as a person would, at most kMostAttempts times.
class Ardour {
 public:
  static constexpr int kMostAttempts = 15;

  Ardour();

  ProgramRun scan() const;  ///< the module, by Ardour's scanner
  std::string session() const { return folder_.file("session"); }
  std::string exported(const std::string& name) const { return folder_.file(name + ".wav"); }
  std::string log() const;

  /// Runs a script without a sound server, until it has come to its end. `fresh` are files and
  /// folders that are not there at its beginning.
  bool run(const std::string& script, const std::vector<std::string>& fresh);
  /// The same under a JACK server of its own: `then` is called while Ardour runs.
  bool run_under_jack(const std::string& script, const std::vector<std::string>& fresh,
                      const std::function<void()>& then);

  // Parts of scripts.

  /// A session with a track "synth": our instrument at unity gain, `parameter` set to `value`, the
  /// track's panner off, its input heard; saved.
  std::string new_session(std::size_t parameter, double value) const;
  std::string old_session() const;
  /// Prints "value is x".
  static std::string print_value(std::size_t parameter);
  /// plugin_notes() come out of a plugin before ours where the song is at kFramesBefore.
  static std::string notes_in_song();
  /// The song from there on, kHeardFrames long, as floats: exported(name).
  std::string export_song(const std::string& name) const;

 private:
  void write_configuration() const;

  ScratchFolder folder_;
  SetVariable home_;
};

}  // namespace knotwave::support
