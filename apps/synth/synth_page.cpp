// SPDX-License-Identifier: MIT
// What a running synth shows and tells.
#include <algorithm>
#include <cstdio>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "knotwave/io/midi_file.h"

#include "page.h"
#include "synth.h"

namespace knotwave::synth {
namespace {

constexpr std::int64_t kPageNs = 100'000'000, kLineNs = 1'000'000'000;
constexpr std::size_t kMessagesKept = 200;
constexpr std::size_t kMostCharacters = 1000;

}  // namespace

/// On the page while it covers the terminal that standard error is, and there once it is gone.
void Synth::tell(const std::string& line) {
  messages_.push_back(io::printable(line, kMostCharacters));
  if (messages_.size() > kMessagesKept) messages_.erase(messages_.begin());
  if (screen_->is_on() && ::isatty(STDERR_FILENO) != 0) {
    told_later_.push_back(messages_.back());
    if (told_later_.size() > kMessagesKept) told_later_.erase(told_later_.begin());
    return;
  }
  std::fprintf(stderr, "%s\n", messages_.back().c_str());
}

void Synth::tell_all(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) tell(line);
}

SynthStatus Synth::status(std::int64_t now_ns) {
  SynthStatus status;
  player_->describe(status);
  status.seconds = static_cast<double>(now_ns - start_ns_) * 1e-9;
  status.patch = name_.empty() ? watch_->path() : name_;
  if (status.song_length_s > 0) status.song = song_name_;
  if (osc_) osc_->describe(status);
  if (recorder_) {
    status.recording = recorder_->path();
    status.recorded_s = recorder_->seconds();
  }
  status.has_keys = keys_.is_on();
  status.octave = keyboard_.octave();
  status.is_help_shown = is_help_shown_;
  status.messages = messages_;
  return status;
}

void Synth::show(std::int64_t now_ns) {
  const bool is_page_due = screen_->is_on() && now_ns >= next_page_ns_;
  const bool is_line_due = (options_.plain || options_.json_status) && now_ns >= next_line_ns_;
  if (!is_page_due && !is_line_due) return;
  const SynthStatus now = status(now_ns);
  if (is_page_due) {
    next_page_ns_ = now_ns + kPageNs;
    screen_->show(page(now, screen_->size()));
  }
  if (is_line_due) {
    next_line_ns_ = now_ns + kLineNs;
    show_line(now);
  }
}

void Synth::show_line(const SynthStatus& now) {
  if (options_.json_status) return write_line(json_line(now));
  const std::string line = plain_line(now);
  if (line == last_line_) return;
  last_line_ = line;
  write_line(clock_text(now.seconds) + " " + line);
}

/// Never waits for a reader that sleeps: lines it has no room for are left out.
void Synth::write_line(const std::string& line) {
  pollfd reader{STDOUT_FILENO, POLLOUT, 0};
  if (is_reader_gone_ || ::poll(&reader, 1, 0) <= 0) return;
  const std::string text = line + "\n";
  if (::write(STDOUT_FILENO, text.data(), text.size()) >= 0) return;
  is_reader_gone_ = true;
  tell("nobody reads standard output any more; playing on");
}

}  // namespace knotwave::synth
