// SPDX-License-Identifier: MIT
#include "osc_map.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "knotwave/base/suggest.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::synth {
namespace {

using Arguments = std::span<const io::OscArgument>;
using engine::LiveMessage;

constexpr std::array<std::string_view, 12> kAddresses = {
    "/note",  "/off",   "/cc",     "/bend",  "/pressure", "/program",
    "/panic", "/patch", "/volume", "/tempo", "/midi",     "/target"};

/// Takes arguments one after another and keeps the first fault.
class Reader {
 public:
  Reader(std::string_view address, Arguments arguments, std::string usage)
      : address_(address), arguments_(arguments), usage_(std::move(usage)) {}

  double number(double least, double most) {
    const double* value = at_ < arguments_.size() ? std::get_if<double>(&arguments_[at_]) : nullptr;
    ++at_;
    if (value == nullptr) return misused();
    if (!(*value >= least && *value <= most)) return beyond(*value, least, most);
    return *value;
  }
  int whole(int least, int most) { return static_cast<int>(std::lround(number(least, most))); }
  /// 1..16 becomes 0..15; the first where none is given.
  int channel() { return at_ < arguments_.size() ? whole(1, 16) - 1 : 0; }
  std::string text() {
    const auto* value =
        at_ < arguments_.size() ? std::get_if<std::string_view>(&arguments_[at_]) : nullptr;
    ++at_;
    if (value != nullptr && !value->empty()) return std::string(*value);
    misused();
    return {};
  }
  /// Nothing may be left.
  Result<void> end() {
    if (at_ < arguments_.size()) misused();
    if (fault_.message.empty()) return {};
    return fault_;
  }

 private:
  double misused() {
    if (fault_.message.empty()) {
      fault_ = fail(ErrorCode::usage, "OSC " + std::string(address_) + " takes " + usage_);
    }
    return 1;
  }
  double beyond(double value, double least, double most) {
    if (fault_.message.empty()) {
      fault_ = fail(ErrorCode::value_out_of_range, "OSC " + std::string(address_) + ": " +
                                                       text_of(value) + " is not in " +
                                                       text_of(least) + " to " + text_of(most));
    }
    return least;
  }
  static std::string text_of(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
  }

  std::string_view address_;
  Arguments arguments_;
  std::string usage_;
  std::size_t at_ = 0;
  Error fault_;
};

LiveMessage midi(int status, int first, int second, std::int64_t time_ns) {
  LiveMessage message;
  message.time_ns = time_ns;
  message.bytes[0] = static_cast<std::uint8_t>(status);
  message.bytes[1] = static_cast<std::uint8_t>(first);
  message.bytes[2] = static_cast<std::uint8_t>(second);
  return message;
}

/// Universal real-time system exclusive, device control, master volume (MIDI 1.0, 14 bits).
LiveMessage master_volume(double volume, std::int64_t time_ns) {
  const auto value = static_cast<int>(std::lround(volume * 16383));
  LiveMessage message = midi(0xF0, 0, 0, time_ns);
  const std::array<int, 6> bytes = {0x7F, 0x7F, 0x04, 0x01, value & 127, value >> 7};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    message.sysex[i] = static_cast<std::uint8_t>(bytes[i]);
  }
  message.sysex_size = bytes.size();
  return message;
}

template <class Value>
Result<OscCommand> checked(Reader& reader, Value value) {
  if (auto good = reader.end(); !good) return good.error();
  return OscCommand(std::move(value));
}

Result<OscCommand> channel_message(std::string_view address, Arguments arguments,
                                   std::int64_t time_ns) {
  if (address == "/note") {
    Reader in(address, arguments, "KEY VELOCITY [CHANNEL]");
    const int key = in.whole(0, 127), velocity = in.whole(0, 127);
    return checked(in, midi(0x90 | in.channel(), key, velocity, time_ns));
  }
  if (address == "/off") {
    Reader in(address, arguments, "KEY [CHANNEL]");
    const int key = in.whole(0, 127);
    return checked(in, midi(0x80 | in.channel(), key, 64, time_ns));
  }
  if (address == "/cc") {
    Reader in(address, arguments, "NUMBER VALUE [CHANNEL]");
    const int number = in.whole(0, 127), value = in.whole(0, 127);
    return checked(in, midi(0xB0 | in.channel(), number, value, time_ns));
  }
  if (address == "/program") {
    Reader in(address, arguments, "NUMBER [CHANNEL]");
    const int number = in.whole(0, 127);
    return checked(in, midi(0xC0 | in.channel(), number, 0, time_ns));
  }
  if (address == "/pressure") {
    Reader in(address, arguments, "VALUE [CHANNEL]");
    const int value = in.whole(0, 127);
    return checked(in, midi(0xD0 | in.channel(), value, 0, time_ns));
  }
  Reader in(address, arguments, "VALUE [CHANNEL]");  // /bend
  const double bend = in.number(-1, 1);
  const auto raw = static_cast<int>(std::lround(8192 + bend * (bend < 0 ? 8192 : 8191)));
  return checked(in, midi(0xE0 | in.channel(), raw & 127, raw >> 7, time_ns));
}

Result<OscCommand> program_message(std::string_view address, Arguments arguments,
                                   std::int64_t time_ns) {
  if (address == "/panic") {
    Reader in(address, arguments, "nothing");
    return checked(in, OscPanic{});
  }
  if (address == "/patch") {
    Reader in(address, arguments, "PATH");
    OscPatch patch{in.text()};
    return checked(in, std::move(patch));
  }
  if (address == "/volume") {
    Reader in(address, arguments, "VALUE");
    const double volume = in.number(0, 1);
    return checked(in, master_volume(volume, time_ns));
  }
  if (address == "/midi") {
    Reader in(address, arguments, "STATUS DATA1 DATA2");
    const int status = in.whole(0x80, 0xEF), first = in.whole(0, 127), second = in.whole(0, 127);
    return checked(in, midi(status, first, second, time_ns));
  }
  Reader in(address, arguments, "BPM");  // /tempo
  LiveMessage message;
  message.time_ns = time_ns;
  message.kind = LiveMessage::Kind::tempo;
  message.number = 60e6 / in.number(4, 1000);
  return checked(in, message);
}

Result<OscCommand> target_message(std::string_view address, Arguments arguments,
                                  std::int64_t time_ns, const TargetLookup& target) {
  const auto slot = target(address.substr(std::string_view("/target/").size()));
  if (!slot) {
    return fail(slot.error().code, "OSC " + std::string(address) + ": " + slot.error().message);
  }
  Reader in(address, arguments, "VALUE [CHANNEL]");
  LiveMessage message;
  message.time_ns = time_ns;
  message.kind = LiveMessage::Kind::set_target;
  message.index = *slot;
  message.number = in.number(-1e6, 1e6);
  message.bytes[0] = static_cast<std::uint8_t>(in.channel());
  return checked(in, message);
}

}  // namespace

Result<OscCommand> osc_command(std::string_view address, Arguments arguments, std::int64_t time_ns,
                               const TargetLookup& target) {
  if (address.starts_with("/target/")) return target_message(address, arguments, time_ns, target);
  for (const std::string_view known : {"/note", "/off", "/cc", "/program", "/pressure", "/bend"}) {
    if (address == known) return channel_message(address, arguments, time_ns);
  }
  for (const std::string_view known : {"/panic", "/patch", "/volume", "/midi", "/tempo"}) {
    if (address == known) return program_message(address, arguments, time_ns);
  }
  return fail(ErrorCode::unknown_name, "OSC " + std::string(address) + " means nothing here" +
                                           base::suggestion(address, kAddresses));
}

std::optional<std::string> OscFaults::told_once(std::string_view address, const Error& error) {
  ++count_;
  if (told_.size() >= kMostAddresses || !told_.emplace(address).second) return std::nullopt;
  return io::printable(error.message, 300);
}

}  // namespace knotwave::synth
