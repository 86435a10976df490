// SPDX-License-Identifier: MIT
// Bytes as numbers: what a fuzzer edits, read by structure. Past the end every byte is 0.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace knotwave::fuzz {

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool is_empty() const { return next_ >= bytes_.size(); }
  int byte() { return is_empty() ? 0 : bytes_[next_++]; }
  /// 0..n-1
  int below(int n) { return byte() % n; }
  bool one_in(int n) { return below(n) == 0; }

  /// Round numbers, near neighbours of the one before, and any eight bytes (NaN and infinity too).
  double number() {
    switch (below(8)) {
      case 0:
        last_ = 0;
        break;
      case 1:
        last_ = byte() - 128;
        break;
      case 2:
        last_ = (byte() - 128) / 64.0;
        break;
      case 3:
        last_ = std::ldexp(byte() - 128, byte() / 4 - 48);
        break;
      case 4:
        std::memcpy(&last_, raw(), sizeof last_);
        break;
      case 5:
        last_ = std::nextafter(last_, byte() < 128 ? -infinity() : infinity());
        break;
      case 6:
        last_ = -last_;
        break;
      default:
        last_ = (byte() + byte() / 256.0 + byte() / 65536.0 - 128) / 128;
    }
    return last_;
  }

  /// In 0..1, the ends included.
  double part() { return (byte() + byte() / 256.0) / 255.99609375; }

 private:
  static double infinity() { return std::numeric_limits<double>::infinity(); }
  const std::uint8_t* raw() {
    for (std::uint8_t& b : eight_) b = static_cast<std::uint8_t>(byte());
    return eight_;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  double last_ = 1;
  std::uint8_t eight_[8] = {};
};

}  // namespace knotwave::fuzz
