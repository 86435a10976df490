// SPDX-License-Identifier: MIT
// SHA-256 as FIPS 180-4 section 6.2 writes it.
#include "knotwave/base/sha256.h"

#include <algorithm>
#include <bit>

#include "sha256_blocks.h"

namespace knotwave::base {
namespace {

/// First 32 bits of the fractional parts of the square roots of the first 8 primes (5.3.3).
constexpr std::array<std::uint32_t, 8> kInitialState = {
    0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

}  // namespace

Sha256::Sha256() : state_(kInitialState), buffer_{} {}

void Sha256::update(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  std::size_t left = bytes.size();
  std::size_t filled = size_bytes_ % 64;
  size_bytes_ += left;
  if (filled > 0) {
    const std::size_t taken = std::min(left, 64 - filled);
    std::copy_n(data, taken, buffer_.begin() + static_cast<std::ptrdiff_t>(filled));
    data += taken;
    left -= taken;
    filled += taken;
    if (filled < 64) return;
    sha256_blocks(state_, buffer_.data(), 1);
  }
  const std::size_t blocks = left / 64;
  sha256_blocks(state_, data, blocks);
  std::copy_n(data + 64 * blocks, left % 64, buffer_.begin());
}

void Sha256::update(std::span<const float> samples) {
  if constexpr (std::endian::native == std::endian::little) {
    update(std::as_bytes(samples));
  } else {
    for (const float sample : samples) {
      const auto bits = std::bit_cast<std::uint32_t>(sample);
      const std::array<std::byte, 4> bytes = {std::byte(bits), std::byte(bits >> 8),
                                              std::byte(bits >> 16), std::byte(bits >> 24)};
      update(bytes);
    }
  }
}

std::string Sha256::finish_hex() {
  const std::uint64_t size_bits = size_bytes_ * 8;
  constexpr std::array<std::byte, 64> kPadding = {std::byte{0x80}};
  const std::size_t filled = size_bytes_ % 64;
  update(std::span(kPadding).first(filled < 56 ? 56 - filled : 120 - filled));
  std::array<std::byte, 8> length;
  for (std::size_t i = 0; i < 8; ++i) length[i] = std::byte(size_bits >> (56 - 8 * i));
  update(length);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) hex += kDigits[(word >> shift) & 15];
  }
  return hex;
}

}  // namespace knotwave::base
