// SPDX-License-Identifier: MIT
// liblo's own sender against our input, and bytes that are no OSC.
#include "knotwave/io/osc_input.h"

#include <condition_variable>
#include <mutex>
#include <random>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <lo/lo.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/seed.h"

namespace knotwave::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Keeps what it hears as text.
class Heard : public OscListener {
 public:
  void message(std::string_view address, std::span<const OscArgument> arguments,
               std::int64_t time_ns) noexcept override {
    const std::lock_guard lock(mutex_);
    std::string line(address);
    for (const OscArgument& argument : arguments) {
      if (const auto* number = std::get_if<double>(&argument)) {
        line += " " + std::to_string(*number);
      } else if (const auto* text = std::get_if<std::string_view>(&argument)) {
        line += " '" + std::string(*text) + "'";
      } else {
        line += " ?";
      }
    }
    lines_.push_back(line);
    is_time_good_ = is_time_good_ && time_ns >= last_ns_;
    last_ns_ = time_ns;
    more_.notify_all();
  }
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    more_.wait_for(lock, std::chrono::seconds(10), [&] { return lines_.size() >= count; });
    EXPECT_TRUE(is_time_good_);
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable more_;
  std::vector<std::string> lines_;
  std::int64_t last_ns_ = 0;
  bool is_time_good_ = true;
};

/// An input on any free port, and liblo's address of it.
class OscInputs : public testing::Test {
 protected:
  OscInputs() {
    auto opened = OscInput::open({}, heard_);
    EXPECT_TRUE(opened.has_value()) << opened.error().to_string();
    input_ = std::move(opened).value();
    to_ = lo_address_new("127.0.0.1", std::to_string(input_->port()).c_str());
  }
  ~OscInputs() override { lo_address_free(to_); }

  void send_bytes(std::string_view bytes) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(input_->port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
    ::close(socket);
  }

  Heard heard_;
  std::unique_ptr<OscInput> input_;
  lo_address to_ = nullptr;
};

TEST_F(OscInputs, EveryTypeOfTheStandardArrives) {
  lo_send(to_, "/numbers", "ifhdcTF", 60, 0.5f, std::int64_t{-3}, 0.25, 'A');
  lo_send(to_, "/texts", "sS", "a b", "symbol");
  lo_send(to_, "/others", "NI");
  lo_send(to_, "/nothing", "");
  EXPECT_THAT(heard_.wait_for(4),
              ElementsAre("/numbers 60.000000 0.500000 -3.000000 0.250000 65.000000 1.000000 "
                          "0.000000",
                          "/texts 'a b' 'symbol'", "/others ? ?", "/nothing"));
  EXPECT_EQ(input_->messages(), 4);
}

TEST_F(OscInputs, ABundleIsItsMessagesInOrder) {
  lo_bundle inner = lo_bundle_new(LO_TT_IMMEDIATE);
  lo_message second = lo_message_new();
  lo_message_add_int32(second, 2);
  lo_bundle_add_message(inner, "/second", second);
  lo_bundle bundle = lo_bundle_new(LO_TT_IMMEDIATE);
  lo_bundle_add_message(bundle, "/first", lo_message_new());
  lo_bundle_add_bundle(bundle, inner);
  lo_bundle_add_message(bundle, "/third", lo_message_new());
  lo_send_bundle(to_, bundle);
  lo_bundle_free_recursive(bundle);
  EXPECT_THAT(heard_.wait_for(3), ElementsAre("/first", "/second 2.000000", "/third"));
}

TEST_F(OscInputs, BytesThatAreNoOscAreCountedAndNothingElse) {
  using namespace std::string_view_literals;
  send_bytes("no osc");
  send_bytes("/open");
  send_bytes("/x\0\0,i\0\0\0"sv);
  send_bytes("/x\0\0,s\0\0abcd"sv);
  send_bytes("#bundle\0"sv);
  send_bytes("#bundle\0\0\0\0\0\0\0\0\1\xff\xff\xff\xff"sv);
  lo_send(to_, "/end", "");
  EXPECT_THAT(heard_.wait_for(1), ElementsAre("/end"));
  EXPECT_EQ(input_->faults(), 6);
}

TEST_F(OscInputs, RandomBytesDoNoHarm) {
  std::mt19937_64 random(support::test_seed());
  constexpr std::string_view kLetters("/#,ifsb\0\0\0\0\1\xff", 13);
  for (int i = 0; i < support::test_count(2000); ++i) {
    std::string bytes = i % 2 == 0 ? std::string("/a\0\0,", 5) : std::string("#bundle\0", 8);
    const auto size = random() % 60;
    for (std::uint64_t k = 0; k < size; ++k) bytes += kLetters[random() % kLetters.size()];
    send_bytes(bytes);
  }
  lo_send(to_, "/end", "");
  for (;;) {
    const auto lines = heard_.wait_for(1);
    if (!lines.empty() && lines.back() == "/end") break;
    ASSERT_LT(input_->messages() + input_->faults(), 4000 * 16) << "the end was lost";
    lo_send(to_, "/end", "");
    ::usleep(1000);
  }
}

TEST_F(OscInputs, APortInUseIsRefusedWithItsNumber) {
  const auto other = OscInput::open({"127.0.0.1", input_->port()}, heard_);
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, ErrorCode::io_failed);
  EXPECT_EQ(other.error().message, "OSC at 127.0.0.1:" + std::to_string(input_->port()) +
                                       ": the port is in use; choose another one, or end what "
                                       "listens there");
}

TEST_F(OscInputs, ListensOnTheAddressGivenAndNoOther) {
  Heard other;
  const auto second = OscInput::open({"127.0.0.2", input_->port()}, other);
  ASSERT_TRUE(second.has_value()) << second.error().to_string();
  lo_send(to_, "/mine", "");
  EXPECT_THAT(heard_.wait_for(1), ElementsAre("/mine"));
  EXPECT_EQ((*second)->messages(), 0);
}

TEST(OscPlaces, AreAPortOrAHostAndAPort) {
  EXPECT_EQ(parse_osc_place("9000")->host, "127.0.0.1");
  EXPECT_EQ(parse_osc_place("9000")->port, 9000);
  EXPECT_EQ(parse_osc_place("0.0.0.0:7")->host, "0.0.0.0");
  EXPECT_EQ(parse_osc_place("[::1]:7")->host, "::1");
  for (const char* wrong : {"", "0", "65536", "x", "9000x", ":9000", "host:", "-1"}) {
    const auto place = parse_osc_place(wrong);
    ASSERT_FALSE(place.has_value()) << wrong;
    EXPECT_THAT(place.error().message, HasSubstr("is neither a port from 1 to 65535"));
  }
}

}  // namespace
}  // namespace knotwave::io
