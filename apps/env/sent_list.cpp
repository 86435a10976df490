// SPDX-License-Identifier: MIT
#include "sent_list.h"

#include <algorithm>
#include <bit>

#include "knotwave/base/sha256.h"

namespace knotwave::env {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

/// Bytes of a channel message, or of a system message that is not exclusive.
std::size_t message_bytes(std::uint8_t status) {
  if (status >= 0xF0) return status == 0xF2 ? 3 : status == 0xF1 || status == 0xF3 ? 2 : 1;
  return (status & 0xE0) == 0xC0 ? 2 : 3;
}

/// Little-endian, whatever the machine.
class Digest {
 public:
  void add(std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const auto byte = static_cast<std::byte>(number >> (8 * i) & 0xFF);
      hash_.update(std::span(&byte, 1));
    }
  }
  void add(std::span<const std::uint8_t> bytes) { hash_.update(std::as_bytes(bytes)); }
  std::string hex() { return hash_.finish_hex(); }

 private:
  base::Sha256 hash_;
};

}  // namespace

std::vector<std::uint8_t> SentMessage::wire() const {
  if (port < 0) return {};
  if (bytes[0] != 0xF0) return {bytes, bytes + message_bytes(bytes[0])};
  std::vector<std::uint8_t> all = {0xF0};
  all.insert(all.end(), sysex.begin(), sysex.end());
  all.push_back(0xF7);
  return all;
}

std::string seconds_text(base::SampleTime time, int rate_hz) {
  // In 2^-32 samples; what goes out before the first event that causes it is below 0.
  const __int128 moment =
      static_cast<__int128>(time.sample) * (std::int64_t{1} << 32) + time.fraction;
  const bool is_negative = moment < 0;
  const auto size = static_cast<unsigned __int128>(is_negative ? -moment : moment);
  const auto ns = static_cast<std::int64_t>(size * kNanoseconds /
                                            (static_cast<unsigned __int128>(rate_hz) << 32));
  const std::string digits = std::to_string(kNanoseconds + ns % kNanoseconds).substr(1);
  return (is_negative ? "-" : "") + std::to_string(ns / kNanoseconds) + "." + digits;
}

void SentList::midi(int port, const base::MidiEvent& event) KNOTWAVE_RT {
  SentMessage& message = messages_.emplace_back();
  message.time = event.time;
  message.port = port;
  std::copy_n(event.bytes, 3, message.bytes);
  if (event.sysex != nullptr) message.sysex.assign(event.sysex, event.sysex + event.sysex_size);
}

void SentList::osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT {
  SentMessage& message = messages_.emplace_back();
  message.time = time;
  message.patch = patch;
  message.output = output;
  message.number = value;
}

void SentList::sort() {
  std::stable_sort(messages_.begin(), messages_.end(),
                   [](const SentMessage& a, const SentMessage& b) {
                     if (a.time != b.time) return a.time < b.time;
                     return a.port < b.port;
                   });
}

std::string SentList::sha256() const {
  Digest digest;
  for (const SentMessage& message : messages_) {
    digest.add(static_cast<std::uint64_t>(message.time.sample), 8);
    digest.add(message.time.fraction, 4);
    digest.add(static_cast<std::uint64_t>(message.port + 1), 1);
    if (message.port < 0) {
      digest.add(static_cast<std::uint64_t>(message.patch), 4);
      digest.add(static_cast<std::uint64_t>(message.output), 4);
      digest.add(std::bit_cast<std::uint64_t>(message.number), 8);
    } else {
      const auto bytes = message.wire();
      digest.add(bytes.size(), 4);
      digest.add(bytes);
    }
  }
  return digest.hex();
}

}  // namespace knotwave::env
