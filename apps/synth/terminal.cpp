// SPDX-License-Identifier: MIT
#include "terminal.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace knotwave::synth {
namespace {

// For signal handlers: set before the flags beside them.
termios usual_keys, single_keys;
std::atomic<bool> are_keys_taken{false};
std::atomic<int> page_descriptor{-1};
std::atomic<bool> is_page_stale{false};

// The other screen (so that what was on this one comes back), no cursor.
constexpr std::string_view kTakePage = "\x1b[?1049h\x1b[?25l";
constexpr std::string_view kLeavePage = "\x1b[0m\x1b[?25h\x1b[?1049l";

void write_all(int descriptor, std::string_view text) noexcept {
  [[maybe_unused]] const auto count = ::write(descriptor, text.data(), text.size());
}

/// Whether the terminal is ours to read from: not while another job has it.
bool is_foreground() { return ::tcgetpgrp(STDIN_FILENO) == ::getpgrp(); }

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

void restore_terminal() noexcept {
  if (const int page = page_descriptor.load(); page >= 0) write_all(page, kLeavePage);
  if (are_keys_taken) ::tcsetattr(STDIN_FILENO, TCSANOW, &usual_keys);
}

void retake_terminal() noexcept {
  if (are_keys_taken) ::tcsetattr(STDIN_FILENO, TCSANOW, &single_keys);
  if (const int page = page_descriptor.load(); page >= 0) write_all(page, kTakePage);
  is_page_stale = true;
}

KeyInput::KeyInput() {
  if (::isatty(STDIN_FILENO) == 0 || !is_foreground()) return;
  if (::tcgetattr(STDIN_FILENO, &usual_keys) != 0) return;
  single_keys = usual_keys;
  single_keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  single_keys.c_cc[VMIN] = 0;
  single_keys.c_cc[VTIME] = 0;
  if (::tcsetattr(STDIN_FILENO, TCSANOW, &single_keys) != 0) return;
  are_keys_taken = true;
  is_on_ = true;
}

KeyInput::~KeyInput() {
  if (!are_keys_taken.exchange(false)) return;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &usual_keys);
}

int KeyInput::descriptor() const { return is_on_ && is_foreground() ? STDIN_FILENO : -1; }

std::string KeyInput::read() {
  std::array<char, 256> bytes;
  pollfd ready{descriptor(), POLLIN, 0};
  if (ready.fd < 0 || ::poll(&ready, 1, 0) <= 0) return {};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count > 0) return {bytes.data(), static_cast<std::size_t>(count)};
  const bool is_gone = (ready.revents & (POLLHUP | POLLERR)) != 0;
  if (is_gone || (count < 0 && errno != EINTR && errno != EAGAIN)) is_on_ = false;
  return {};
}

Screen::Screen(bool is_wanted) {
  const char* kind = std::getenv("TERM");
  const bool can_move = kind != nullptr && *kind != '\0' && std::string_view(kind) != "dumb";
  if (!is_wanted || !can_move || ::isatty(STDOUT_FILENO) == 0) return;
  // Opened anew, so that not to wait for it is our affair alone and not that of the shell.
  std::array<char, 256> name{};
  if (::ttyname_r(STDOUT_FILENO, name.data(), name.size()) != 0) return;
  descriptor_ = ::open(name.data(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return;
  has_colour_ = !is_set("NO_COLOR");  // https://no-color.org
  page_descriptor = descriptor_;
  write_all(descriptor_, kTakePage);
}

Screen::~Screen() {
  if (descriptor_ < 0) return;
  page_descriptor = -1;
  write_all(descriptor_, kLeavePage);
  ::close(descriptor_);
}

PageSize Screen::size() const {
  winsize window{};
  if (::ioctl(descriptor_, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 || window.ws_row == 0) {
    return {};
  }
  return {window.ws_col, window.ws_row};
}

void Screen::show(const std::vector<PageLine>& lines) {
  if (descriptor_ < 0) return;
  std::string out;
  const PageSize now = size();
  if (!(now == drawn_size_) || is_page_stale.exchange(false)) {
    drawn_.clear();
    out = "\x1b[0m\x1b[2J";
  }
  const bool is_shorter = lines.size() < drawn_.size();
  drawn_.resize(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] == drawn_[i]) continue;
    out +=
        "\x1b[" + std::to_string(i + 1) + ";1H" + terminal_text(lines[i], has_colour_) + "\x1b[K";
  }
  if (is_shorter) out += "\x1b[" + std::to_string(lines.size() + 1) + ";1H\x1b[J";
  drawn_ = lines;
  drawn_size_ = now;
  if (out.empty()) return;
  const ssize_t count = ::write(descriptor_, out.data(), out.size());
  if (count != static_cast<ssize_t>(out.size())) drawn_size_ = {0, 0};
}

}  // namespace knotwave::synth
