// SPDX-License-Identifier: MIT
// Private to io: a file descriptor that closes itself, and what a failed call becomes.
#pragma once
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "knotwave/base/result.h"

namespace knotwave::io {

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  int value() const { return value_; }

 private:
  int value_;
};

/// `what: No space left on device`, as disk_full or io_failed.
inline Error system_error(int number, const std::string& what) {
  const bool is_full = number == ENOSPC || number == EDQUOT;
  return fail(is_full ? ErrorCode::disk_full : ErrorCode::io_failed,
              what + ": " + std::generic_category().message(number));
}

}  // namespace knotwave::io
