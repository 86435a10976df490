// SPDX-License-Identifier: MIT
// SHA-256 (FIPS 180-4), for the hash a render prints. [control]
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace knotwave::base {

class Sha256 {
 public:
  Sha256();
  /// Adds bytes. Any split gives the same digest.
  void update(std::span<const std::byte> bytes);
  /// Adds floats as 32-bit little-endian.
  void update(std::span<const float> samples);
  /// The digest of all that was added, 64 lower-case hex digits. The object is used up.
  std::string finish_hex();

 private:
  std::array<std::uint32_t, 8> state_;
  std::array<std::uint8_t, 64> buffer_;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace knotwave::base
