// SPDX-License-Identifier: MIT
// The sending thread against outputs that write down what they get, vanish, fail and hang.
#include "knotwave/io/midi_sender.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kMs = 1'000'000;

base::MidiEvent control(int number, int value) {
  base::MidiEvent event;
  event.bytes[0] = 0xB0;
  event.bytes[1] = static_cast<std::uint8_t>(number);
  event.bytes[2] = static_cast<std::uint8_t>(value);
  return event;
}

/// A cable, its outputs and what came out of them.
struct Cable {
  struct Sent {
    Bytes bytes;
    std::int64_t time_ns = 0, due_ns = 0;  ///< due_ns: of send_at()
  };
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::vector<Sent> all;
  bool is_there = true, fails = false, hangs = false, is_timed = false;
  int opened = 0;

  void keep(std::span<const std::uint8_t> bytes, std::int64_t due_ns) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return !hangs; });
    all.push_back({{bytes.begin(), bytes.end()}, steady_clock_ns(), due_ns});
  }
  void set(bool Cable::*what, bool value) {
    const std::lock_guard lock(mutex);
    this->*what = value;
    changed.notify_all();
  }
  bool is(bool Cable::*what) const {
    const std::lock_guard lock(mutex);
    return this->*what;
  }
  std::vector<Sent> sent() const {
    const std::lock_guard lock(mutex);
    return all;
  }
};

class CableOutput : public MidiOutput {
 public:
  explicit CableOutput(std::shared_ptr<Cable> cable) : cable_(std::move(cable)) {}
  Result<void> send(std::span<const std::uint8_t> message) override {
    if (cable_->is(&Cable::fails)) return fail(ErrorCode::io_failed, "broken");
    cable_->keep(message, 0);
    return {};
  }
  bool is_timed() const noexcept override { return cable_->is_timed; }
  bool send_at(const base::MidiEvent& event, std::int64_t due_ns) noexcept override {
    cable_->keep(event.bytes, due_ns);
    return true;
  }
  bool exists() override { return cable_->is(&Cable::is_there); }
  const std::string& api() const override { return api_; }
  const std::string& name() const override { return name_; }

 private:
  std::shared_ptr<Cable> cable_;
  std::string api_ = "test", name_ = "cable";
};

class MidiSenders : public testing::Test {
 protected:
  /// One port for each of `cables_`.
  void open(std::size_t ports = 1, std::size_t waiting = 8192) {
    MidiSenderConfig config;
    config.waiting = waiting;
    config.ports.resize(ports);
    for (std::size_t i = 0; i < ports; ++i) {
      config.ports[i].port = std::to_string(i);
      if (cables_.size() == i) cables_.push_back(std::make_shared<Cable>());
    }
    config.open =
        [cables = cables_](const MidiOutputConfig& port) -> Result<std::unique_ptr<MidiOutput>> {
      const auto& cable = cables[static_cast<std::size_t>(std::stoi(port.port))];
      if (!cable->is(&Cable::is_there)) return fail(ErrorCode::unknown_name, "nobody has it");
      ++cable->opened;
      return std::unique_ptr<MidiOutput>(new CableOutput(cable));
    };
    auto opened = MidiSender::open(config);
    ASSERT_TRUE(opened.has_value()) << opened.error().to_string();
    sender_ = std::move(*opened);
  }
  bool is_so(const std::function<bool()>& is_so) {
    for (int i = 0; i < 5000; ++i) {
      if (is_so()) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
  bool is_sent(std::size_t messages, std::size_t port = 0) {
    return is_so([&] { return cables_[port]->sent().size() >= messages; });
  }

  std::vector<std::shared_ptr<Cable>> cables_;
  std::unique_ptr<MidiSender> sender_;
};

TEST_F(MidiSenders, SendInOrderAndNeverBeforeTheTime) {
  open();
  const std::int64_t begin_ns = steady_clock_ns() + 2 * kMs;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sender_->push(0, control(74, i), begin_ns + i * kMs / 2));
  }
  ASSERT_TRUE(is_sent(100));
  const auto sent = cables_[0]->sent();
  for (int i = 0; i < 100; ++i) {
    EXPECT_THAT(sent[static_cast<std::size_t>(i)].bytes, ElementsAre(0xB0, 74, i));
    EXPECT_GE(sent[static_cast<std::size_t>(i)].time_ns, begin_ns + i * kMs / 2);
  }
  ASSERT_TRUE(is_so([&] { return sender_->is_done(); }));
  const MidiSenderPort port = sender_->ports()[0];
  EXPECT_EQ(port.sent, 100);
  EXPECT_EQ(port.dropped, 0);
  EXPECT_EQ(port.lateness.count, 100);
  EXPECT_GT(port.lateness.max_ns, 0);
  EXPECT_EQ(port.api, "test");
  EXPECT_EQ(port.name, "cable");
  EXPECT_TRUE(port.is_open);
}

TEST_F(MidiSenders, CopySystemExclusive) {
  open();
  Bytes data = {1, 2, 3};
  base::MidiEvent event;
  event.bytes[0] = 0xF0;
  event.sysex = data.data();
  event.sysex_size = 3;
  ASSERT_TRUE(sender_->push(0, event, steady_clock_ns() + 20 * kMs));
  data = {9, 9, 9};
  ASSERT_TRUE(is_sent(1));
  EXPECT_THAT(cables_[0]->sent()[0].bytes, ElementsAre(0xF0, 1, 2, 3, 0xF7));
}

TEST_F(MidiSenders, WaitForEachPortByItself) {
  open(3);
  const std::int64_t now_ns = steady_clock_ns();
  EXPECT_TRUE(sender_->push(0, control(1, 1), now_ns + 3'600'000 * kMs));  // in an hour
  EXPECT_TRUE(sender_->push(1, control(2, 2), now_ns));
  EXPECT_TRUE(sender_->push(2, control(3, 3), now_ns + 5 * kMs));
  EXPECT_TRUE(is_sent(1, 1));
  EXPECT_TRUE(is_sent(1, 2));
  EXPECT_EQ(cables_[0]->sent().size(), 0u);
  EXPECT_FALSE(sender_->is_done());
  for (const int none : {-1, 3}) EXPECT_FALSE(sender_->push(none, control(1, 1), now_ns));
}

TEST_F(MidiSenders, HandOverEarlyWhereTheOutputPlacesThem) {
  cables_.push_back(std::make_shared<Cable>());
  cables_[0]->is_timed = true;
  open();
  const std::int64_t due_ns = steady_clock_ns() + 3'600'000 * kMs;
  EXPECT_TRUE(sender_->push(0, control(1, 2), due_ns));
  ASSERT_TRUE(is_sent(1));
  EXPECT_EQ(cables_[0]->sent()[0].due_ns, due_ns);
  EXPECT_THAT(cables_[0]->sent()[0].bytes, ElementsAre(0xB0, 1, 2));
}

TEST_F(MidiSenders, DropWhatIsForAPortThatVanishedAndOpenItAgain) {
  open(2);
  EXPECT_FALSE(sender_->poll());
  cables_[0]->set(&Cable::is_there, false);
  EXPECT_TRUE(sender_->poll());
  EXPECT_FALSE(sender_->ports()[0].is_open);
  EXPECT_EQ(sender_->ports()[0].fault, "it has gone");
  EXPECT_TRUE(sender_->ports()[1].is_open);
  for (int i = 0; i < 5; ++i) sender_->push(0, control(1, i), steady_clock_ns());
  EXPECT_TRUE(is_so([&] { return sender_->ports()[0].dropped == 5; }));
  EXPECT_TRUE(is_so([&] { return sender_->poll() || sender_->ports()[0].fault != "it has gone"; }));
  EXPECT_EQ(sender_->ports()[0].fault, "nobody has it");
  cables_[0]->set(&Cable::is_there, true);
  EXPECT_TRUE(is_so([&] { return sender_->poll(); }));
  EXPECT_TRUE(sender_->ports()[0].is_open);
  EXPECT_EQ(sender_->ports()[0].reopened, 1);
  EXPECT_EQ(sender_->ports()[1].reopened, 0);
  sender_->push(0, control(1, 99), steady_clock_ns());
  ASSERT_TRUE(is_sent(1));
  EXPECT_THAT(cables_[0]->sent()[0].bytes, ElementsAre(0xB0, 1, 99));
}

TEST_F(MidiSenders, TakeAPortThatFailsForOneThatVanished) {
  open();
  cables_[0]->set(&Cable::fails, true);
  sender_->push(0, control(1, 1), steady_clock_ns());
  EXPECT_TRUE(is_so([&] { return sender_->ports()[0].dropped == 1; }));
  EXPECT_TRUE(sender_->poll());
  EXPECT_FALSE(sender_->ports()[0].is_open);
  cables_[0]->set(&Cable::fails, false);
  EXPECT_TRUE(is_so([&] { return sender_->poll(); }));
  EXPECT_EQ(sender_->ports()[0].reopened, 1);
  EXPECT_EQ(cables_[0]->opened, 2);
}

TEST_F(MidiSenders, CountWhatTheyHaveNoRoomFor) {
  open(1, 64);
  const std::int64_t later_ns = steady_clock_ns() + 200 * kMs;
  int taken = 0;
  for (int i = 0; i < 1'000'000; ++i) taken += sender_->push(0, control(1, i % 128), later_ns);
  EXPECT_GE(taken, 64);
  EXPECT_TRUE(is_so([&] { return sender_->is_done(); }));
  const MidiSenderPort port = sender_->ports()[0];
  EXPECT_EQ(port.sent, taken);
  EXPECT_EQ(port.sent + port.dropped, 1'000'000);
}

TEST_F(MidiSenders, EndEvenWhereAnOutputHangs) {
  open();
  cables_[0]->set(&Cable::hangs, true);
  sender_->push(0, control(1, 1), steady_clock_ns());
  std::this_thread::sleep_for(20ms);
  EXPECT_FALSE(sender_->poll());
  const std::int64_t begin_ns = steady_clock_ns();
  sender_.reset();
  EXPECT_LT(steady_clock_ns() - begin_ns, 1000 * kMs);
  cables_[0]->set(&Cable::hangs, false);
  EXPECT_TRUE(is_sent(1));  // the thread that was left behind ends by itself
}

TEST_F(MidiSenders, SayWhichPortThereIsNot) {
  MidiSenderConfig config;
  config.ports.resize(1);
  config.open = [](const MidiOutputConfig&) -> Result<std::unique_ptr<MidiOutput>> {
    return fail(ErrorCode::unknown_name, "no such port");
  };
  const auto none = MidiSender::open(config);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().message, "no such port");
}

}  // namespace
}  // namespace knotwave::io
