// SPDX-License-Identifier: MIT
// The bytes of a bundle of numbers (OSC 1.0): no memory is asked for.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "knotwave/io/osc_output.h"

namespace knotwave::io {

/// What a time since 1970 is as a time tag: seconds since 1900 and their fraction in 2^-32, rounded
/// down. [any]
std::uint64_t osc_time_tag(std::int64_t wall_ns) KNOTWAVE_RT;

class OscBundle {
 public:
  /// One Ethernet frame holds it, so no network cuts it up.
  static constexpr std::size_t kMostBytes = 1400;

  explicit OscBundle(std::uint64_t time_tag) KNOTWAVE_RT;

  /// False: it has no room, and is as it was. [any]
  bool add(const OscNumber& message) KNOTWAVE_RT;
  int messages() const KNOTWAVE_RT { return messages_; }
  std::span<const std::byte> bytes() const KNOTWAVE_RT { return std::span(bytes_).first(size_); }

 private:
  void put(std::uint64_t number, int bytes) KNOTWAVE_RT;

  std::array<std::byte, kMostBytes> bytes_{};
  std::size_t size_ = 0;
  int messages_ = 0;
};

}  // namespace knotwave::io
