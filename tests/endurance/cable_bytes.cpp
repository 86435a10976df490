// SPDX-License-Identifier: MIT
#include "cable_bytes.h"

#include <array>

#include "knotwave/engine/channel_state.h"

namespace knotwave::endurance {
namespace {

using namespace engine;  // NOLINT: controllers by their names

using Bytes = std::vector<std::uint8_t>;
/// General MIDI on and off, Roland GS reset, Yamaha XG on, master volume.
const std::array<Bytes, 5> kKnownSysex = {{{0x7E, 0x7F, 0x09, 0x01},
                                           {0x7E, 0x7F, 0x09, 0x02},
                                           {0x41, 0x10, 0x42, 0x12, 0x40, 0x00, 0x7F, 0x00, 0x41},
                                           {0x43, 0x10, 0x4C, 0x00, 0x00, 0x7E, 0x00},
                                           {0x7F, 0x7F, 0x04, 0x01, 0x00, 0x60}}};

}  // namespace

void CableBytes::add_phrase(Bytes& bytes) {
  out_ = &bytes;
  const int what = below(100);
  if (what < 45) return notes();
  if (what < 65) return expression();
  if (what < 73) return pedals();
  if (what < 80) return program();
  if (what < 88) return registered_parameter();
  if (what < 91) return mode();
  if (what < 94) return sysex();
  if (what < 96) return system_common();
  noise();
}

/// Real-time bytes stand wherever they like.
void CableBytes::put(int byte) {
  if (chance(60)) out_->push_back(static_cast<std::uint8_t>(0xF8 + below(7)));
  if (chance(20000)) out_->push_back(0xFF);
  out_->push_back(static_cast<std::uint8_t>(byte));
}

void CableBytes::channel_message(int status, int one, int two) {
  if (status != running_ || chance(4)) put(status);
  running_ = status;
  put(one);
  if ((status & 0xE0) != 0xC0) put(two);
}

void CableBytes::notes() {
  const int channel = below(16);
  for (int i = 1 + below(5); i > 0; --i) {
    const int key = below(128);
    const int status = chance(8) ? 0x80 | channel : 0x90 | channel;
    channel_message(status, key, chance(3) ? 0 : below(128));
  }
}

void CableBytes::expression() {
  constexpr std::array<int, 4> kStatus = {0xA0, 0xB0, 0xD0, 0xE0};
  const int status = kStatus[static_cast<std::size_t>(below(4))] | below(16);
  for (int i = 1 + below(4); i > 0; --i) channel_message(status, below(120), below(128));
}

void CableBytes::pedals() {
  constexpr std::array<int, 4> kPedals = {kSustain, kSostenuto, kSoft, kPortamento};
  const int status = 0xB0 | below(16);
  for (int i = 1 + below(3); i > 0; --i) {
    channel_message(status, kPedals[static_cast<std::size_t>(below(4))], chance(2) ? 0 : 127);
  }
}

void CableBytes::program() {
  const int channel = below(16);
  if (chance(4)) {
    channel_message(0xB0 | channel, kBankMsb, chance(2) ? 0 : below(128));
    channel_message(0xB0 | channel, kBankLsb, chance(2) ? 0 : below(128));
  }
  channel_message(0xC0 | channel, below(128), 0);
}

void CableBytes::registered_parameter() {
  constexpr std::array<int, 7> kParameters = {0, 1, 2, 3, 5, 6, 127};
  const int status = 0xB0 | below(16);
  const bool is_registered = !chance(5);
  channel_message(status, is_registered ? kRpnMsb : kNrpnMsb, chance(10) ? below(128) : 0);
  channel_message(status, is_registered ? kRpnLsb : kNrpnLsb,
                  kParameters[static_cast<std::size_t>(below(7))]);
  constexpr std::array<int, 4> kEntries = {kDataEntryMsb, kDataEntryLsb, kDataIncrement,
                                           kDataDecrement};
  for (int i = below(4); i > 0; --i) {
    channel_message(status, kEntries[static_cast<std::size_t>(below(4))], below(128));
  }
}

void CableBytes::mode() {
  channel_message(0xB0 | below(16), 120 + below(8), chance(2) ? 0 : below(128));
}

/// Known, of any length up to one that no cable keeps, and cut off by whatever comes next.
void CableBytes::sysex() {
  running_ = 0;
  put(0xF0);
  if (chance(2)) {
    for (const std::uint8_t byte : kKnownSysex[static_cast<std::size_t>(below(5))]) put(byte);
  } else {
    for (int i = chance(400) ? 64000 + below(6000) : below(60); i > 0; --i) put(below(128));
  }
  if (!chance(5)) put(0xF7);
}

void CableBytes::system_common() {
  running_ = 0;
  const int status = 0xF1 + below(7);
  put(status);
  if (status == 0xF7 || chance(8)) return;
  for (int i = status == 0xF2 ? 2 : status < 0xF4 ? 1 : 0; i > 0; --i) put(below(128));
}

void CableBytes::noise() {
  running_ = 0;
  for (int i = 1 + below(40); i > 0; --i) out_->push_back(static_cast<std::uint8_t>(bits()));
}

}  // namespace knotwave::endurance
