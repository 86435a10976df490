// SPDX-License-Identifier: MIT
// A JACK server of a test's own, without a sound card.
#pragma once
#include <memory>
#include <string>

#include "support/background_program.h"
#include "support/program.h"

namespace knotwave::support {

/// jackd's dummy device in sync mode: a late cycle is late and never lost. The environment of this
/// process names it while it lives, so that clients and child processes find it and no other. One
/// at a time. Needs the programs of the package jackd2: without them the test fails.
class JackServer {
 public:
  explicit JackServer(int block_frames = 1024, int rate_hz = 48000);
  ~JackServer();
  JackServer(const JackServer&) = delete;
  JackServer& operator=(const JackServer&) = delete;

  /// False where jackd did not come up; what it said is in log().
  bool runs() const { return runs_; }
  std::string log() const;
  /// Has its own process id in it.
  const std::string& name() const { return name_; }

  void kill();   ///< SIGKILL: no client is told
  void pause();  ///< SIGSTOP
  void resume();
  bool restart();  ///< after kill(), under the same name

 private:
  void launch();

  int block_frames_, rate_hz_;
  std::string name_;
  SetVariable found_by_, not_started_;
  ScratchFolder folder_;
  std::unique_ptr<BackgroundProgram> program_;
  bool runs_ = false, was_killed_ = false;
};

/// While it lives, no JACK server is found.
class NoJackServer {
 public:
  NoJackServer();

 private:
  SetVariable found_by_, not_started_;
};

}  // namespace knotwave::support
