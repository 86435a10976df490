// SPDX-License-Identifier: MIT
#include "held_state.h"

#include <charconv>
#include <sstream>

namespace knotwave::synth {
namespace {

using engine::LiveMessage;
using Kind = engine::Event::Kind;

constexpr int kDataMsb = 6, kDataLsb = 38, kRpnLsb = 100, kRpnMsb = 101;
constexpr int kNrpnLsb = 98, kNrpnMsb = 99;
constexpr int kSoundOff = 120, kResetControllers = 121, kNotesOff = 123;

LiveMessage midi(int status, int first, int second) {
  LiveMessage message;
  message.bytes[0] = static_cast<std::uint8_t>(status);
  message.bytes[1] = static_cast<std::uint8_t>(first);
  message.bytes[2] = static_cast<std::uint8_t>(second);
  return message;
}

}  // namespace

HeldState::HeldState() {
  for (Channel& channel : channels_) channel.controllers.fill(-1);
}

void HeldState::add(const engine::JournalRecord& record) {
  switch (record.kind) {
    case Kind::midi:
      if (record.bytes[0] >= 0x80 && record.bytes[0] < 0xF0) add_midi(record.bytes);
      break;
    case Kind::tempo:
      tempo_ = record.number;
      break;
    case Kind::set_target: {
      auto& targets = channels_[record.bytes[0] & 15u].targets;
      if (record.index == engine::Event::kEverySlot) {
        targets.clear();
      } else {
        targets[static_cast<int>(record.index)] = record.number;
      }
      break;
    }
    case Kind::all_notes_off:
      for (Channel& channel : channels_) channel.keys.fill(0);
      break;
    case Kind::choke:
      choke(record);
      break;
    case Kind::install_bank:
    case Kind::position:  // every clock tells its own again
    case Kind::set_note:  // of a note that is gone with its engine
      break;
  }
}

/// A number says nothing here: keys are held, not notes.
void HeldState::choke(const engine::JournalRecord& record) {
  if (record.note >= 0) return;
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    if (!record.every_channel && channel != (record.bytes[0] & 15u)) continue;
    if (record.bytes[1] == engine::Event::kEveryKey) {
      channels_[channel].keys.fill(0);
    } else {
      channels_[channel].keys[record.bytes[1] & 127u] = 0;
    }
  }
}

void HeldState::add_midi(const std::uint8_t* bytes) {
  Channel& channel = channels_[bytes[0] & 15u];
  const std::size_t first = bytes[1] & 127u;
  switch (bytes[0] & 0xF0) {
    case 0x80:
      channel.keys[first] = 0;
      break;
    case 0x90:
      channel.keys[first] = bytes[2];
      break;
    case 0xB0:
      add_controller(channel, static_cast<int>(first), bytes[2]);
      break;
    case 0xC0:
      channel.program = bytes[1];
      break;
    case 0xD0:
      channel.pressure = bytes[1];
      break;
    case 0xE0:
      channel.bend = bytes[1] | bytes[2] << 7;
      break;
    default:
      break;
  }
}

void HeldState::add_controller(Channel& channel, int number, int value) {
  if (number == kResetControllers) return reset_controllers(channel);
  if (number == kSoundOff || number >= kNotesOff) channel.keys.fill(0);
  if (number >= kSoundOff) return;
  if (number == kRpnMsb || number == kRpnLsb) {
    const int old = channel.rpn < 0 ? 0x3FFF : channel.rpn;
    channel.rpn = number == kRpnMsb ? (old & 127) | value << 7 : (old & 127 << 7) | value;
    return;
  }
  if (number == kNrpnMsb || number == kNrpnLsb) channel.rpn = -1;
  if ((number == kDataMsb || number == kDataLsb) && channel.rpn >= 0) {
    auto& data = channel.registered.try_emplace(channel.rpn, -1, -1).first->second;
    (number == kDataMsb ? data.first : data.second) = value;
    return;
  }
  channel.controllers[static_cast<std::size_t>(number)] = static_cast<std::int16_t>(value);
}

/// MIDI 1.0, RP-015: bank, volume, pan, program and registered parameters stay.
void HeldState::reset_controllers(Channel& channel) {
  for (const int number : {1, 2, 4, 11, 64, 65, 66, 67, 68, 69}) {
    channel.controllers[static_cast<std::size_t>(number)] = -1;
  }
  channel.bend = channel.pressure = -1;
  channel.rpn = -1;
}

std::vector<LiveMessage> HeldState::messages() const {
  std::vector<LiveMessage> messages;
  if (tempo_ > 0) {
    LiveMessage tempo;
    tempo.kind = LiveMessage::Kind::tempo;
    tempo.number = tempo_;
    messages.push_back(tempo);
  }
  for (int number = 0; number < 16; ++number) add_channel(number, messages);
  return messages;
}

void HeldState::add_channel(int number, std::vector<LiveMessage>& messages) const {
  const Channel& channel = channels_[static_cast<std::size_t>(number)];
  const auto add = [&](int status, int first, int second) {
    messages.push_back(midi(status | number, first, second));
  };
  for (int i = 0; i < 128; ++i) {
    const int value = channel.controllers[static_cast<std::size_t>(i)];
    if (value >= 0) add(0xB0, i, value);
  }
  if (channel.program >= 0) add(0xC0, channel.program, 0);
  for (const auto& [rpn, data] : channel.registered) {
    add(0xB0, kRpnMsb, rpn >> 7);
    add(0xB0, kRpnLsb, rpn & 127);
    if (data.first >= 0) add(0xB0, kDataMsb, data.first);
    if (data.second >= 0) add(0xB0, kDataLsb, data.second);
  }
  if (channel.bend >= 0) add(0xE0, channel.bend & 127, channel.bend >> 7);
  if (channel.pressure >= 0) add(0xD0, channel.pressure, 0);
  for (const auto& [slot, value] : channel.targets) {
    LiveMessage target = midi(number, 0, 0);
    target.kind = LiveMessage::Kind::set_target;
    target.index = static_cast<std::uint16_t>(slot);
    target.number = value;
    messages.push_back(target);
  }
  for (int key = 0; key < 128; ++key) {
    const int velocity = channel.keys[static_cast<std::size_t>(key)];
    if (velocity > 0) add(0x90, key, velocity);
  }
}

std::string text_of(const std::vector<LiveMessage>& messages) {
  std::string text;
  for (const LiveMessage& message : messages) {
    char number[40];
    const auto end = std::to_chars(number, number + sizeof number, message.number);
    for (const int value : {static_cast<int>(message.kind), static_cast<int>(message.bytes[0]),
                            static_cast<int>(message.bytes[1]), static_cast<int>(message.bytes[2]),
                            static_cast<int>(message.index)}) {
      text += std::to_string(value) + " ";
    }
    text.append(number, end.ptr) += "\n";
  }
  return text;
}

std::vector<LiveMessage> messages_in(std::string_view text) {
  std::vector<LiveMessage> messages;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const char *at = line.data(), *const end = at + line.size();
    double values[6];
    bool is_good = true;
    for (double& value : values) {
      const auto read = std::from_chars(at, end, value);
      is_good = is_good && read.ec == std::errc() && value > -1e300 && value < 1e300;
      at = read.ptr + (read.ptr < end ? 1 : 0);
    }
    const bool is_known = values[0] == 0 || values[0] == 1 || values[0] == 2;
    for (int i = 1; i < 5; ++i) is_good = is_good && values[i] >= 0 && values[i] < 65536;
    if (!is_good || !is_known) continue;
    LiveMessage message =
        midi(static_cast<int>(values[1]), static_cast<int>(values[2]), static_cast<int>(values[3]));
    message.kind = static_cast<LiveMessage::Kind>(static_cast<int>(values[0]));
    message.index = static_cast<std::uint16_t>(values[4]);
    message.number = values[5];
    messages.push_back(message);
  }
  return messages;
}

}  // namespace knotwave::synth
