// SPDX-License-Identifier: MIT
// Our bundles against liblo's bytes, a server of liblo's, and our own input.
#include "knotwave/io/osc_output.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <lo/lo.h>

#include "knotwave/io/audio_device.h"

#include "osc_bundle.h"
#include "support/seed.h"

namespace knotwave::io {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

/// What liblo makes of the same.
std::vector<std::byte> liblo_bytes(std::span<const OscNumber> numbers, std::uint64_t tag) {
  lo_bundle bundle =
      lo_bundle_new({static_cast<std::uint32_t>(tag >> 32), static_cast<std::uint32_t>(tag)});
  for (const OscNumber& number : numbers) {
    lo_message message = lo_message_new();
    lo_message_add_float(message, number.number);
    lo_bundle_add_message(bundle, std::string(number.address).c_str(), message);
  }
  std::size_t size = 0;
  void* const bytes = lo_bundle_serialise(bundle, nullptr, &size);
  const auto* const first = static_cast<const std::byte*>(bytes);
  std::vector<std::byte> all(first, first + size);
  std::free(bytes);
  lo_bundle_free_recursive(bundle);
  return all;
}

TEST(OscBundles, HaveTheBytesThatLibloWrites) {
  std::mt19937_64 random(support::test_seed());
  for (int i = 0; i < support::test_count(300); ++i) {
    const std::uint64_t tag = random();
    std::vector<std::string> addresses;
    std::vector<OscNumber> numbers;
    for (std::uint64_t k = 0; k < 1 + random() % 12; ++k) {
      addresses.push_back("/" + std::string(1 + random() % 40, static_cast<char>('a' + k)));
    }
    OscBundle bundle(tag);
    for (const std::string& address : addresses) {
      const auto unit = static_cast<float>(random() >> 40) * 0x1p-24F;
      numbers.push_back({address, (unit - 0.5F) * 1e4F});
      ASSERT_TRUE(bundle.add(numbers.back()));
    }
    EXPECT_THAT(bundle.bytes(), ElementsAreArray(liblo_bytes(numbers, tag)));
  }
}

TEST(OscBundles, AreFullBeforeAFrameIsAndKeepWhatTheyHave) {
  OscBundle bundle(7);
  const OscNumber number{"/seven", 7};
  while (bundle.add(number)) {
  }
  EXPECT_EQ(bundle.messages(), 69);  // 16 + 69 * 20 = 1396
  EXPECT_EQ(bundle.bytes().size(), 1396u);
  EXPECT_THAT(bundle.bytes(), ElementsAreArray(liblo_bytes(std::vector<OscNumber>(69, number), 7)));
}

TEST(OscTimeTags, CountFrom1900InPartsOfASecond) {
  constexpr std::uint64_t k1970 = std::uint64_t{0x83AA7E80} << 32;  // RFC 868: 2,208,988,800
  EXPECT_EQ(osc_time_tag(0), k1970);
  EXPECT_EQ(osc_time_tag(500'000'000), k1970 + 0x80000000);
  EXPECT_EQ(osc_time_tag(1'250'000'000), k1970 + 0x140000000);
  EXPECT_EQ(osc_time_tag(1), k1970 + 4);  // 4.29 parts
  EXPECT_EQ(osc_time_tag(999'999'999), k1970 + 0xFFFFFFFB);
  EXPECT_EQ(osc_time_tag(-1), k1970 - 5);
  EXPECT_EQ(osc_time_tag(2'085'978'496'000'000'000), 0u);  // 2036-02-07 06:28:16, era 1 begins
}

TEST(OscAddresses, AreWhatNoReceiverTakesForAPattern) {
  for (const char* good : {"/a", "/filter/cutoff", "/1/fader3", "/a.b-c_d~!"}) {
    EXPECT_TRUE(is_osc_address(good)) << good;
  }
  for (const char* wrong : {"", "/", "a", "/a b", "/a*", "/a?", "/#", "/[a]", "/{a}", "/a,b",
                            "/\x7f", "/\xc3\xa4", "/a\nb"}) {
    EXPECT_FALSE(is_osc_address(wrong)) << wrong;
  }
  EXPECT_TRUE(is_osc_address("/" + std::string(254, 'a')));
  EXPECT_FALSE(is_osc_address("/" + std::string(255, 'a')));
}

/// A server of liblo's, read by the test's own thread.
class LibloServer {
 public:
  LibloServer() : server_(lo_server_new(nullptr, nullptr)) {
    lo_server_enable_queue(server_, 0, 1);  // hand over at once, whatever the tag
    lo_server_add_method(server_, nullptr, nullptr, &LibloServer::hear, this);
  }
  ~LibloServer() { lo_server_free(server_); }
  LibloServer(const LibloServer&) = delete;
  LibloServer& operator=(const LibloServer&) = delete;

  struct Heard {
    std::string address, types;
    float number = 0;
    std::uint64_t tag = 0;
  };
  std::vector<Heard> wait_for(std::size_t count) {
    while (heard_.size() < count && lo_server_recv_noblock(server_, 5000) > 0) {
    }
    return heard_;
  }
  int port() const { return lo_server_get_port(server_); }

 private:
  static int hear(const char* address, const char* types, lo_arg** values, int, lo_message message,
                  void* to) {
    const lo_timetag tag = lo_message_get_timestamp(message);
    static_cast<LibloServer*>(to)->heard_.push_back(
        {address, types, values[0]->f, std::uint64_t{tag.sec} << 32 | tag.frac});
    return 0;
  }
  lo_server server_;
  std::vector<Heard> heard_;
};

std::int64_t wall_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

TEST(OscOutputs, ReachLibloWithTheWallTimeTheyAreMeantFor) {
  LibloServer server;
  const auto output = OscOutput::open({"127.0.0.1", server.port()});
  ASSERT_TRUE(output.has_value()) << output.error().to_string();
  constexpr std::int64_t kAhead = 20'000'000;
  const std::uint64_t earliest = osc_time_tag(wall_ns() + kAhead - 1'000'000);
  const OscNumber numbers[] = {{"/filter/cutoff", 0.25F}, {"/q", -3}};
  EXPECT_TRUE((*output)->send(numbers, steady_clock_ns() + kAhead));
  const std::uint64_t latest = osc_time_tag(wall_ns() + kAhead + 1'000'000);
  const auto heard = server.wait_for(2);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].address, "/filter/cutoff");
  EXPECT_EQ(heard[0].types, "f");
  EXPECT_EQ(heard[0].number, 0.25F);
  EXPECT_EQ(heard[1].address, "/q");
  EXPECT_EQ(heard[1].number, -3);
  EXPECT_EQ(heard[0].tag, heard[1].tag);
  EXPECT_GE(heard[0].tag, earliest);  // that the wall clock is set meanwhile is left to chance
  EXPECT_LE(heard[0].tag, latest);
  EXPECT_EQ((*output)->messages(), 2);
  EXPECT_EQ((*output)->faults(), 0);
}

TEST(OscOutputs, SplitWhatOneFrameDoesNotHold) {
  LibloServer server;
  const auto output = OscOutput::open({"127.0.0.1", server.port()});
  ASSERT_TRUE(output.has_value()) << output.error().to_string();
  std::vector<OscNumber> numbers;
  for (int i = 0; i < 200; ++i) numbers.push_back({"/many", static_cast<float>(i)});
  EXPECT_TRUE((*output)->send(numbers, steady_clock_ns()));
  const auto heard = server.wait_for(numbers.size());
  ASSERT_EQ(heard.size(), numbers.size());
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i].number, numbers[i].number);
    EXPECT_EQ(heard[i].tag, heard[0].tag);
  }
  EXPECT_EQ((*output)->messages(), 200);
}

class Heard : public OscListener {
 public:
  void message(std::string_view address, std::span<const OscArgument> arguments,
               std::int64_t) noexcept override {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::string(address) + " " + std::to_string(std::get<double>(arguments[0])));
  }
  std::vector<std::string> wait_for(std::size_t count) {
    for (int i = 0; i < 5000; ++i) {
      if (const std::lock_guard lock(mutex_); lines_.size() >= count) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

TEST(OscOutputs, ReachOurOwnInputOverBothProtocols) {
  for (const char* host : {"127.0.0.1", "::1"}) {
    Heard heard;
    const auto input = OscInput::open({host, 0}, heard);
    if (!input && std::string_view(host) == "::1") {
      std::puts("no IPv6 here: left out");
      continue;
    }
    ASSERT_TRUE(input.has_value()) << input.error().to_string();
    const auto output = OscOutput::open({host, (*input)->port()});
    ASSERT_TRUE(output.has_value()) << output.error().to_string();
    const OscNumber numbers[] = {{"/a", 0.5F}, {"/b", 2}};
    EXPECT_TRUE((*output)->send(numbers, steady_clock_ns()));
    EXPECT_THAT(heard.wait_for(2), ElementsAre("/a 0.500000", "/b 2.000000")) << host;
    EXPECT_EQ((*input)->faults(), 0);
  }
}

TEST(OscOutputs, NeedNoListener) {
  int port = 0;
  {
    Heard heard;
    port = (*OscInput::open({}, heard))->port();
  }
  const auto output = OscOutput::open({"127.0.0.1", port});
  ASSERT_TRUE(output.has_value());
  const OscNumber number{"/nobody", 1};
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE((*output)->send({&number, 1}, steady_clock_ns()));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // for the refusal to come back
  }
  EXPECT_EQ((*output)->messages(), 50);
}

TEST(OscOutputs, CountWhatIsNotSent) {
  const auto nowhere = OscOutput::open({"255.255.255.255", 9});  // broadcast, which is not allowed
  ASSERT_TRUE(nowhere.has_value());
  const OscNumber numbers[] = {{"/a", 1}, {"no address", 1}, {"/b", 1}};
  EXPECT_FALSE((*nowhere)->send(numbers, steady_clock_ns()));
  EXPECT_EQ((*nowhere)->faults(), 3);
  EXPECT_EQ((*nowhere)->messages(), 0);
  EXPECT_TRUE((*nowhere)->send({}, steady_clock_ns()));
}

TEST(OscOutputs, SayWhichHostThereIsNot) {
  const auto none = OscOutput::open({"no-such-host.invalid", 9000});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::io_failed);
  EXPECT_THAT(none.error().message, HasSubstr("OSC to no-such-host.invalid:9000: "));
  EXPECT_EQ(OscOutput::open({"127.0.0.1", 0}).error().code, ErrorCode::value_out_of_range);
}

}  // namespace
}  // namespace knotwave::io
