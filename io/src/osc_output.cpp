// SPDX-License-Identifier: MIT
// The socket is our own, so that it never blocks and tells what was refused; a receiver that is
// missing is not told of (UDP), so it may come later.
#include "knotwave/io/osc_output.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>

#include <netdb.h>
#include <sys/socket.h>

#include "descriptor.h"
#include "osc_bundle.h"

namespace knotwave::io {
namespace {

template <class Clock>
std::int64_t now_ns() {
  const auto now = Clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

class UdpOutput : public OscOutput {
 public:
  UdpOutput(Descriptor socket, const addrinfo& to)
      : socket_(std::move(socket)), to_size_(to.ai_addrlen) {
    std::memcpy(&to_, to.ai_addr, to.ai_addrlen);
  }

  bool send(std::span<const OscNumber> numbers, std::int64_t time_ns) noexcept override {
    using std::chrono::steady_clock, std::chrono::system_clock;
    const std::int64_t wall_ns = time_ns + now_ns<system_clock>() - now_ns<steady_clock>();
    const std::uint64_t tag = osc_time_tag(wall_ns);
    const std::int64_t faults_before = faults();
    OscBundle bundle(tag);
    for (const OscNumber& number : numbers) {
      if (!is_osc_address(number.address)) {
        faults_.fetch_add(1, std::memory_order_relaxed);
      } else if (!bundle.add(number)) {
        send(bundle);
        bundle = OscBundle(tag);
        bundle.add(number);
      }
    }
    send(bundle);
    return faults() == faults_before;
  }
  std::int64_t messages() const noexcept override {
    return messages_.load(std::memory_order_relaxed);
  }
  std::int64_t faults() const noexcept override { return faults_.load(std::memory_order_relaxed); }

 private:
  void send(const OscBundle& bundle) noexcept {
    if (bundle.messages() == 0) return;
    const auto bytes = bundle.bytes();
    const ssize_t sent = ::sendto(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                  reinterpret_cast<const sockaddr*>(&to_), to_size_);
    auto& count = sent == static_cast<ssize_t>(bytes.size()) ? messages_ : faults_;
    count.fetch_add(bundle.messages(), std::memory_order_relaxed);
  }

  Descriptor socket_;
  sockaddr_storage to_{};
  socklen_t to_size_;
  std::atomic<std::int64_t> messages_{0}, faults_{0};
};

}  // namespace

Result<std::unique_ptr<OscOutput>> OscOutput::open(const OscPlace& to) {
  const std::string port = std::to_string(to.port), where = "OSC to " + to.host + ":" + port;
  if (to.port < 1 || to.port > 65535) {
    return fail(ErrorCode::value_out_of_range, where + ": a port is from 1 to 65535");
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int code = ::getaddrinfo(to.host.c_str(), port.c_str(), &hints, &found);
  if (code != 0) return fail(ErrorCode::io_failed, where + ": " + ::gai_strerror(code));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, ::freeaddrinfo);
  int fault = 0;
  for (const addrinfo* next = found; next != nullptr; next = next->ai_next) {
    Descriptor socket(::socket(next->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (socket.value() >= 0) return {std::make_unique<UdpOutput>(std::move(socket), *next)};
    fault = errno;
  }
  return system_error(fault, where);
}

}  // namespace knotwave::io
