// SPDX-License-Identifier: MIT
// The terminal that a person sits at: keys as they are typed, a page that is redrawn where it
// changed. Put back as it was at every end of the program, also at those nobody planned.
#pragma once
#include <string>
#include <vector>

#include "page.h"

namespace knotwave::synth {

/// Standard input as single keys, without echo. Ctrl-C and Ctrl-Z still are signals.
class KeyInput {
 public:
  /// Off where standard input is no terminal, or one that belongs to another job just now.
  KeyInput();
  KeyInput(const KeyInput&) = delete;
  KeyInput& operator=(const KeyInput&) = delete;
  ~KeyInput();

  bool is_on() const { return is_on_; }
  /// For poll(); -1 while off.
  int descriptor() const;
  /// What was typed; empty when nothing was. Off when the terminal has gone.
  std::string read();

 private:
  bool is_on_ = false;
};

/// Standard output as a screen.
class Screen {
 public:
  /// Off where standard output is no terminal (or one without a way to move the cursor) and where
  /// `is_wanted` is false.
  explicit Screen(bool is_wanted);
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen();

  bool is_on() const { return descriptor_ >= 0; }
  bool has_colour() const { return has_colour_; }
  /// Follows the window; 80 by 24 where it does not say.
  PageSize size() const;
  /// Draws what differs from what is there. Never waits: what a slow terminal does not take is
  /// drawn again next time.
  void show(const std::vector<PageLine>& lines);

 private:
  int descriptor_ = -1;
  bool has_colour_ = false;
  PageSize drawn_size_;
  std::vector<PageLine> drawn_;
};

/// Puts the terminal back. Async-signal-safe, and safe to call twice: for signal handlers.
void restore_terminal() noexcept;
/// After the program was stopped and goes on (SIGCONT): the keys and the page are taken again.
void retake_terminal() noexcept;

}  // namespace knotwave::synth
