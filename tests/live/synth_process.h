// SPDX-License-Identifier: MIT
// knotwave-synth as a process that goes on while the test looks at what it says.
#pragma once
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

namespace knotwave::synth {

class SynthProcess {
 public:
  struct Options {
    std::string folder;         ///< working directory
    bool has_terminal = false;  ///< a pseudo-terminal as input, output and error
    bool is_stdin_closed = false;
  };
  /// Begins it with these words.
  SynthProcess(std::vector<std::string> words, const Options& options);
  ~SynthProcess();  ///< SIGKILL if it still runs
  SynthProcess(const SynthProcess&) = delete;
  SynthProcess& operator=(const SynthProcess&) = delete;

  /// All it said so far.
  std::string out() const;
  std::string err() const;
  /// False after `timeout_s`.
  bool says(const std::string& text, double timeout_s = 20) const;
  /// The value of a field in the newest line of --json-status; empty: there is none yet.
  std::string field(const std::string& name) const;
  double number(const std::string& name) const;

  void type(const std::string& keys);
  void signal(int number) const;
  /// Its exit code, 128 + signal when a signal ended it; -1: it still runs after `timeout_s`.
  int exit_code(double timeout_s = 20);
  /// Of the pseudo-terminal, for tcgetattr().
  int terminal() const { return terminal_; }
  pid_t id() const { return process_; }

 private:
  void listen(int descriptor, std::string& into);

  pid_t process_ = -1;
  int exit_code_ = -1;
  int terminal_ = -1;        ///< our side
  int terminal_other_ = -1;  ///< its side, kept so that settings can be looked at
  mutable std::mutex mutex_;
  std::string out_, err_;
  std::vector<std::thread> listeners_;
};

}  // namespace knotwave::synth
