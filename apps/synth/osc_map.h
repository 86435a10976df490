// SPDX-License-Identifier: MIT
// What OSC addresses mean: docs/live.md has the table. Knows no socket.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "knotwave/base/result.h"
#include "knotwave/engine/live_message.h"
#include "knotwave/io/osc_input.h"

namespace knotwave::synth {

struct OscPanic {};
struct OscPatch {
  std::string path;
};
/// A message for the engine, or something for the program.
using OscCommand = std::variant<engine::LiveMessage, OscPanic, OscPatch>;

/// The slot of a target's name, as `/target/NAME` has it.
using TargetLookup = std::function<Result<std::uint16_t>(std::string_view name)>;

/// Errors: unknown_name (an address that means nothing), usage (arguments of other kinds),
/// value_out_of_range. The message begins with the address.
Result<OscCommand> osc_command(std::string_view address, std::span<const io::OscArgument> arguments,
                               std::int64_t time_ns, const TargetLookup& target);

/// Tells every address that was not understood once, as senders repeat themselves.
class OscFaults {
 public:
  /// The line to tell; none if that address was told of already, or too many were.
  std::optional<std::string> told_once(std::string_view address, const Error& error);
  std::int64_t count() const { return count_; }

 private:
  static constexpr std::size_t kMostAddresses = 100;
  std::set<std::string, std::less<>> told_;
  std::int64_t count_ = 0;
};

}  // namespace knotwave::synth
