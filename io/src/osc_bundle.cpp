// SPDX-License-Identifier: MIT
#include "osc_bundle.h"

#include <algorithm>
#include <bit>

namespace knotwave::io {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kFrom1900To1970 = 2'208'988'800;  // seconds; RFC 5905, figure 4

constexpr bool is_in_address(char c) {
  constexpr std::string_view kPatterns("#*,?[]{}");
  return c > ' ' && c <= '~' && kPatterns.find(c) == std::string_view::npos;
}

}  // namespace

bool is_osc_address(std::string_view address) KNOTWAVE_RT {
  return address.size() > 1 && address.size() <= kMaxOscAddress && address.front() == '/' &&
         std::all_of(address.begin(), address.end(), is_in_address);
}

std::uint64_t osc_time_tag(std::int64_t wall_ns) KNOTWAVE_RT {
  const std::int64_t rest = (wall_ns % kSecond + kSecond) % kSecond;
  const auto seconds = static_cast<std::uint64_t>((wall_ns - rest) / kSecond + kFrom1900To1970);
  const std::uint64_t fraction = (static_cast<std::uint64_t>(rest) << 32) / kSecond;
  return seconds << 32 | fraction;
}

OscBundle::OscBundle(std::uint64_t time_tag) KNOTWAVE_RT {
  for (const char c : std::string_view("#bundle\0", 8)) put(static_cast<std::uint8_t>(c), 1);
  put(time_tag, 8);
}

void OscBundle::put(std::uint64_t number, int bytes) KNOTWAVE_RT {
  for (int i = bytes - 1; i >= 0; --i) {
    bytes_[size_++] = static_cast<std::byte>(number >> (8 * i) & 0xFF);
  }
}

/// Size, address with its zeros up to a multiple of 4, ",f", number.
bool OscBundle::add(const OscNumber& message) KNOTWAVE_RT {
  const std::size_t address = message.address.size() / 4 * 4 + 4;
  if (size_ + 4 + address + 8 > bytes_.size()) return false;
  put(address + 8, 4);
  for (const char c : message.address) put(static_cast<std::uint8_t>(c), 1);
  put(0, static_cast<int>(address - message.address.size()));
  put(std::uint32_t{','} << 24 | std::uint32_t{'f'} << 16, 4);
  put(std::bit_cast<std::uint32_t>(message.number), 4);
  ++messages_;
  return true;
}

}  // namespace knotwave::io
