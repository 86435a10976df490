// SPDX-License-Identifier: MIT
// The socket is our own, so that it listens where it is told to and a port in use is refused (a
// server of liblo's listens on every address); liblo reads what is in a packet.
#include "knotwave/io/osc_input.h"

#include <charconv>

namespace knotwave::io {

Result<OscPlace> parse_osc_place(std::string_view text) {
  OscPlace place;
  const std::size_t colon = text.rfind(':');
  std::string_view digits = text;
  if (colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
      host = host.substr(1, host.size() - 2);
    }
    place.host = host;
    digits = text.substr(colon + 1);
  }
  const char* end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, place.port);
  const bool is_port = read.ec == std::errc() && read.ptr == end;
  if (!is_port || place.port < 1 || place.port > 65535 || place.host.empty()) {
    return fail(ErrorCode::usage,
                "'" + std::string(text) + "' is neither a port from 1 to 65535 nor HOST:PORT");
  }
  return place;
}

}  // namespace knotwave::io

#if KNOTWAVE_HAVE_LIBLO
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>
#include <vector>

#include <lo/lo.h>
#include <netdb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "descriptor.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kMaxPacket = 65536;
constexpr int kMaxBundleDepth = 8;

std::int64_t now_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

OscArgument argument_of(char type, const lo_arg& arg) {
  switch (type) {
    case LO_INT32:
      return static_cast<double>(arg.i);
    case LO_INT64:
      return static_cast<double>(arg.h);
    case LO_FLOAT:
      return static_cast<double>(arg.f);
    case LO_DOUBLE:
      return arg.d;
    case LO_CHAR:
      return static_cast<double>(arg.c);
    case LO_TRUE:
      return 1.0;
    case LO_FALSE:
      return 0.0;
    case LO_STRING:
      return std::string_view(&arg.s);
    case LO_SYMBOL:
      return std::string_view(&arg.S);
    default:
      return std::monostate{};
  }
}

Result<Descriptor> bound_socket(const OscPlace& place) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string where = place.host + ":" + std::to_string(place.port);
  const int code =
      ::getaddrinfo(place.host.c_str(), std::to_string(place.port).c_str(), &hints, &found);
  if (code != 0) return fail(ErrorCode::io_failed, "OSC at " + where + ": " + ::gai_strerror(code));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, ::freeaddrinfo);
  Descriptor socket(::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.value() >= 0 && ::bind(socket.value(), found->ai_addr, found->ai_addrlen) == 0) {
    return socket;
  }
  if (errno != EADDRINUSE) return system_error(errno, "OSC at " + where);
  return fail(
      ErrorCode::io_failed,
      "OSC at " + where + ": the port is in use; choose another one, or end what listens there");
}

int port_of(const Descriptor& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(socket.value(), reinterpret_cast<sockaddr*>(&address), &size);
  std::array<char, 16> port{};
  ::getnameinfo(reinterpret_cast<sockaddr*>(&address), size, nullptr, 0, port.data(), port.size(),
                NI_NUMERICSERV | NI_DGRAM);
  return std::atoi(port.data());
}

class LibloInput : public OscInput {
 public:
  LibloInput(Descriptor socket, Descriptor wake, OscListener& listener)
      : socket_(std::move(socket)), wake_(std::move(wake)), listener_(listener) {
    port_ = port_of(socket_);
    thread_ = std::thread([this] { listen(); });
  }
  ~LibloInput() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto count = ::write(wake_.value(), &one, sizeof one);
    thread_.join();
  }

  int port() const override { return port_; }
  std::int64_t messages() const override { return messages_.load(std::memory_order_relaxed); }
  std::int64_t faults() const override { return faults_.load(std::memory_order_relaxed); }

 private:
  void listen() {
    std::vector<char> packet(kMaxPacket);
    for (;;) {
      pollfd ready[2] = {{wake_.value(), POLLIN, 0}, {socket_.value(), POLLIN, 0}};
      ::poll(ready, 2, -1);
      if (ready[0].revents != 0) return;
      const ssize_t size = ::recv(socket_.value(), packet.data(), packet.size(), 0);
      if (size > 0) read_packet({packet.data(), static_cast<std::size_t>(size)}, now_ns(), 0);
    }
  }

  /// OSC 1.0: a bundle is "#bundle", a time tag, and elements with their size in front. Time tags
  /// are for senders that know our clock; what arrives is played.
  void read_packet(std::span<char> packet, std::int64_t time_ns, int depth) {
    constexpr std::string_view kBundle("#bundle\0", 8);
    if (!std::string_view(packet.data(), packet.size()).starts_with(kBundle)) {
      read_message(packet, time_ns);
      return;
    }
    if (packet.size() < 16 || depth == kMaxBundleDepth) return count_fault();
    std::span<char> rest = packet.subspan(16);
    while (!rest.empty()) {
      if (rest.size() < 4) return count_fault();
      std::uint32_t size = 0;
      for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<std::uint8_t>(rest[i]);
      rest = rest.subspan(4);
      if (size > rest.size() || size % 4 != 0) return count_fault();
      if (size > 0) read_packet(rest.first(size), time_ns, depth + 1);
      rest = rest.subspan(size);
    }
  }

  void read_message(std::span<char> packet, std::int64_t time_ns) {
    const void* end = std::memchr(packet.data(), 0, packet.size());
    int code = 0;
    const lo_message message = packet.front() == '/' && end != nullptr
                                   ? ::lo_message_deserialise(packet.data(), packet.size(), &code)
                                   : nullptr;
    if (message == nullptr) return count_fault();
    const auto count = static_cast<std::size_t>(::lo_message_get_argc(message));
    const char* types = ::lo_message_get_types(message);
    lo_arg** argv = ::lo_message_get_argv(message);
    arguments_.clear();
    for (std::size_t i = 0; i < count; ++i) arguments_.push_back(argument_of(types[i], *argv[i]));
    messages_.fetch_add(1, std::memory_order_relaxed);
    listener_.message(packet.data(), arguments_, time_ns);
    ::lo_message_free(message);
  }

  void count_fault() { faults_.fetch_add(1, std::memory_order_relaxed); }

  Descriptor socket_, wake_;
  OscListener& listener_;
  int port_ = 0;
  std::atomic<std::int64_t> messages_{0}, faults_{0};
  std::vector<OscArgument> arguments_;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<OscInput>> OscInput::open(const OscPlace& place, OscListener& listener) {
  auto socket = bound_socket(place);
  if (!socket) return socket.error();
  Descriptor wake(::eventfd(0, EFD_CLOEXEC));
  if (wake.value() < 0) return system_error(errno, "OSC");
  try {
    return {std::make_unique<LibloInput>(std::move(socket).value(), std::move(wake), listener)};
  } catch (const std::system_error& fault) {
    return fail(ErrorCode::io_failed, "no thread for OSC: " + fault.code().message());
  }
}

}  // namespace knotwave::io
#else
namespace knotwave::io {
Result<std::unique_ptr<OscInput>> OscInput::open(const OscPlace&, OscListener&) {
  return fail(ErrorCode::unsupported,
              "this Knotwave was built without OSC: install liblo-dev and build it anew "
              "(KNOTWAVE_WITH_LIBLO)");
}
}  // namespace knotwave::io
#endif
