// SPDX-License-Identifier: MIT
// Open Sound Control over UDP (OSC 1.0): numbers with the time they are meant for.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "knotwave/base/result.h"
#include "knotwave/io/osc_input.h"

namespace knotwave::io {

/// One message: an address and a float32.
struct OscNumber {
  std::string_view address;
  float number = 0;
};

/// Whether a message may be sent there: '/' first, then printable ASCII without # * , ? [ ] { } and
/// blanks, which are patterns of receivers (OSC 1.0). At most kMaxOscAddress characters. [any]
bool is_osc_address(std::string_view address) KNOTWAVE_RT;
inline constexpr std::size_t kMaxOscAddress = 255;

/// A socket that sends, and never waits. [control] One thread.
class OscOutput {
 public:
  /// Names are looked up here, once. Errors: value_out_of_range (port 0), io_failed (no such host).
  static Result<std::unique_ptr<OscOutput>> open(const OscPlace& to);
  virtual ~OscOutput() = default;

  /// One bundle of `numbers`, in order; several of one time where one packet of 1400 bytes does not
  /// hold them. `time_ns` is by the steady clock; the time tag is what the wall clock shows then,
  /// as far as is known now. Nobody may listen. Does not allocate. False: a packet was refused (no
  /// route, no room) or an address is none.
  virtual bool send(std::span<const OscNumber> numbers, std::int64_t time_ns) noexcept = 0;

  virtual std::int64_t messages() const noexcept = 0;  ///< sent
  virtual std::int64_t faults() const noexcept = 0;    ///< messages that were not
};

}  // namespace knotwave::io
