// SPDX-License-Identifier: MIT
// Open Sound Control over UDP (OSC 1.0): messages as they arrive, on a thread of their own.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "knotwave/base/result.h"

namespace knotwave::io {

/// i, h, f, d, c, T and F are numbers; s and S are texts; all other types are std::monostate.
using OscArgument = std::variant<std::monostate, double, std::string_view>;

class OscListener {
 public:
  virtual ~OscListener() = default;
  /// Called on the thread of the input. Texts are valid during the call and may hold any bytes;
  /// numbers may be NaN. `time_ns` is by the steady clock.
  virtual void message(std::string_view address, std::span<const OscArgument> arguments,
                       std::int64_t time_ns) noexcept = 0;
};

struct OscPlace {
  std::string host = "127.0.0.1";  ///< input: whose addresses may send (this machine only, or
                                   ///< 0.0.0.0); output: the receiver's
  int port = 0;                    ///< 1..65535; 0: any free one (input)
};
/// "9000", "0.0.0.0:9000", "[::1]:9000". Errors: usage.
Result<OscPlace> parse_osc_place(std::string_view text);

/// A socket that listens from open() to the destructor. [control]
class OscInput {
 public:
  /// `listener` must outlive it. Errors: io_failed (the port is in use, no such host), unsupported
  /// (built without liblo).
  static Result<std::unique_ptr<OscInput>> open(const OscPlace& place, OscListener& listener);
  /// No message() after it returns.
  virtual ~OscInput() = default;

  virtual int port() const = 0;
  virtual std::int64_t messages() const = 0;
  virtual std::int64_t faults() const = 0;  ///< packets that are no OSC
};

}  // namespace knotwave::io
