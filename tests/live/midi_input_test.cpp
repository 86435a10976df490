// SPDX-License-Identifier: MIT
// MIDI inputs and outputs at a JACK server of the test's own: messages, cables pulled, servers
// lost.
#include "knotwave/io/midi_input.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include <RtMidi.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jack/jack.h>

#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_output.h"

#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

class Listener : public MidiListener {
 public:
  struct Heard {
    int port = 0;
    Bytes bytes;
    std::int64_t time_ns = 0;
  };
  void message(const base::MidiEvent& event, std::int64_t time_ns) noexcept override {
    const std::lock_guard lock(mutex_);
    Bytes bytes = {event.bytes[0]};
    if (event.sysex != nullptr) {
      bytes.insert(bytes.end(), event.sysex, event.sysex + event.sysex_size);
    } else {
      bytes.insert(bytes.end(), {event.bytes[1], event.bytes[2]});
    }
    heard_.push_back({event.port, bytes, time_ns});
  }
  void port_lost(int port) noexcept override {
    const std::lock_guard lock(mutex_);
    lost_.push_back(port);
  }
  std::vector<Heard> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  std::vector<int> lost() const {
    const std::lock_guard lock(mutex_);
    return lost_;
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    heard_.clear();
    lost_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Heard> heard_;
  std::vector<int> lost_;
};

/// Another program's keyboard: RtMidi's own class, which our inputs cannot know as ours.
class Keyboard {
 public:
  explicit Keyboard(const std::string& name) : out_(RtMidi::UNIX_JACK, name) {
    out_.openVirtualPort("keys");
  }
  void send(const Bytes& bytes) { out_.sendMessage(bytes.data(), bytes.size()); }

 private:
  RtMidiOut out_;
};

bool is_so_within(std::chrono::milliseconds limit, const std::function<bool()>& is_so) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

const MidiPortStatus* port_of(const std::vector<MidiPortStatus>& ports, const std::string& name) {
  const auto found = std::find_if(ports.begin(), ports.end(), [&](const MidiPortStatus& port) {
    return port.name.find(name) != std::string::npos;
  });
  return found == ports.end() ? nullptr : &*found;
}

/// Everything a test needs; `inputs` before `listener` goes.
class MidiInputsOnJack : public testing::Test {
 protected:
  void open(MidiInputConfig config = {}) {
    auto opened = MidiInputs::open(config, listener_);
    ASSERT_TRUE(opened.has_value()) << opened.error().to_string();
    inputs_ = std::move(*opened);
  }
  bool is_open(const std::string& name) {
    const auto ports = inputs_->ports();
    const MidiPortStatus* port = port_of(ports, name);
    return port != nullptr && port->is_open;
  }
  int number(const std::string& name) {
    const auto ports = inputs_->ports();
    const MidiPortStatus* port = port_of(ports, name);
    return port == nullptr ? -1 : port->port;
  }
  bool opens_within(std::chrono::milliseconds limit, const std::string& name) {
    return is_so_within(limit, [&] {
      inputs_->poll();
      return is_open(name);
    });
  }
  bool hears(std::size_t messages) {
    return is_so_within(3s, [&] { return listener_.heard().size() >= messages; });
  }

  support::JackServer server_;
  Listener listener_;
  std::unique_ptr<MidiInputs> inputs_;
};

TEST_F(MidiInputsOnJack, EveryMessageOfAnotherProgramArrivesWithItsTime) {
  ASSERT_TRUE(server_.runs()) << server_.log();
  Keyboard keyboard("board");
  open();
  ASSERT_TRUE(is_open("board:keys"));
  std::vector<Bytes> sent;
  for (std::uint8_t key = 40; key < 80; ++key) {
    sent.push_back({0x90, key, 100});
    sent.push_back({0x80, key, 64});
  }
  sent.push_back({0xB0, 74, 12});
  sent.push_back({0xF0, 0x7E, 0x7F, 9, 1, 0xF7});
  const std::int64_t begin_ns = steady_clock_ns();
  for (const Bytes& message : sent) {
    keyboard.send(message);
    std::this_thread::sleep_for(2ms);
  }
  ASSERT_TRUE(hears(sent.size())) << listener_.heard().size() << " of " << sent.size();
  const std::int64_t end_ns = steady_clock_ns();
  sent.back() = {0xF0, 0x7E, 0x7F, 9, 1};
  std::int64_t last_ns = begin_ns;
  const auto heard = listener_.heard();
  ASSERT_EQ(heard.size(), 82u);
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i].bytes, sent[i]) << i;
    EXPECT_EQ(heard[i].port, number("board:keys"));
    EXPECT_GE(heard[i].time_ns, last_ns);
    last_ns = heard[i].time_ns;
  }
  EXPECT_LE(last_ns, end_ns);
  const auto ports = inputs_->ports();
  EXPECT_EQ(port_of(ports, "board:keys")->messages, 82);
  EXPECT_EQ(port_of(ports, "board:keys")->faults, 0);
}

TEST_F(MidiInputsOnJack, RealTimeMessagesAndLongSystemExclusiveArriveToo) {
  Keyboard keyboard("board");
  open();
  Bytes longest = {0xF0};
  longest.insert(longest.end(), 2000, 0x55);
  longest.push_back(0xF7);
  for (const Bytes& message : {Bytes{0xF8}, {0xFA}, {0xFE}, {0xF2, 1, 2}, longest}) {
    keyboard.send(message);
  }
  ASSERT_TRUE(hears(5));
  EXPECT_EQ(listener_.heard()[0].bytes[0], 0xF8);
  EXPECT_EQ(listener_.heard()[2].bytes[0], 0xFE);
  EXPECT_EQ(listener_.heard()[4].bytes.size(), 2001u);
}

TEST_F(MidiInputsOnJack, ACablePulledWithinANoteIsToldAndKeepsItsNumberWhenItComesBack) {
  open();
  auto first = std::make_unique<Keyboard>("first");
  ASSERT_TRUE(opens_within(3s, "first:keys"));
  Keyboard second("second");
  ASSERT_TRUE(opens_within(3s, "second:keys"));
  const int port = number("first:keys");
  first->send({0x90, 60, 100});
  ASSERT_TRUE(hears(1));
  first.reset();
  EXPECT_TRUE(is_so_within(1s, [&] { return inputs_->poll(); }));
  EXPECT_THAT(listener_.lost(), ElementsAre(port));
  EXPECT_FALSE(is_open("first:keys"));
  EXPECT_TRUE(is_open("second:keys"));
  listener_.clear();
  Keyboard again("first");
  ASSERT_TRUE(opens_within(3s, "first:keys"));
  EXPECT_EQ(number("first:keys"), port);
  again.send({0x90, 61, 100});
  ASSERT_TRUE(hears(1));
  EXPECT_EQ(listener_.heard()[0].port, port);
  const auto ports = inputs_->ports();
  EXPECT_EQ(port_of(ports, "first:keys")->messages, 2);
}

TEST_F(MidiInputsOnJack, AServerKilledWithinANoteIsToldAndItsSuccessorIsFound) {
  auto keyboard = std::make_unique<Keyboard>("board");
  open();
  const int port = number("board:keys");
  keyboard->send({0x90, 60, 100});
  ASSERT_TRUE(hears(1));
  server_.kill();
  keyboard.reset();  // the next client would free it under RtMidi, in one process with it
  const std::int64_t killed_ns = steady_clock_ns();
  ASSERT_TRUE(is_so_within(1s, [&] { return inputs_->poll(); }));
  EXPECT_LT(steady_clock_ns() - killed_ns, 1'000'000'000);
  EXPECT_THAT(listener_.lost(), Contains(port));
  for (const MidiPortStatus& status : inputs_->ports()) EXPECT_FALSE(status.is_open);
  EXPECT_THAT(inputs_->notes(), Contains(HasSubstr("jack: ")));
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(inputs_->poll());
    std::this_thread::sleep_for(50ms);
  }
  ASSERT_TRUE(server_.restart()) << server_.log();
  ASSERT_TRUE(opens_within(3s, ":in"));
  Keyboard again("board");
  ASSERT_TRUE(opens_within(3s, "board:keys"));
  EXPECT_EQ(number("board:keys"), port);
  listener_.clear();
  again.send({0x90, 62, 100});
  EXPECT_TRUE(hears(1));
}

TEST_F(MidiInputsOnJack, AServerThatFreezesDoesNotStopPoll) {
  Keyboard keyboard("board");
  open();
  server_.pause();
  const std::int64_t begin_ns = steady_clock_ns();
  for (int i = 0; i < 10; ++i) inputs_->poll();
  EXPECT_LT(steady_clock_ns() - begin_ns, 1'000'000'000);
  server_.resume();
}

TEST_F(MidiInputsOnJack, AServerThatComesLaterIsFound) {
  server_.kill();
  open();
  EXPECT_THAT(inputs_->notes(), Contains(HasSubstr("jack: no server is running")));
  EXPECT_FALSE(is_open(":in"));
  ASSERT_TRUE(server_.restart());
  EXPECT_TRUE(opens_within(3s, ":in"));
}

TEST_F(MidiInputsOnJack, OutputsOfThisProgramAreLeftAlone) {
  open();
  auto own = MidiOutput::open({.api = "jack"});
  ASSERT_TRUE(own.has_value()) << own.error().to_string();
  EXPECT_THAT((*own)->name(), HasSubstr(":out"));
  Keyboard other("Knotwave");  // another copy of this program
  ASSERT_TRUE(opens_within(3s, ":keys"));
  EXPECT_FALSE(is_open(":out"));
  (*own)->send({{0x90, 60, 100}}).has_value();
  other.send({0x91, 60, 100});
  ASSERT_TRUE(hears(1));
  EXPECT_EQ(listener_.heard()[0].bytes[0], 0x91);
}

TEST_F(MidiInputsOnJack, WithAllWhatIsLeftOutIsToldAndHeardOnlyByItsName) {
  Keyboard another("Looper-1"), keyboard("board");
  open({.ports = {}, .left_out = "looper"});
  ASSERT_TRUE(opens_within(3s, "board:keys"));
  EXPECT_FALSE(is_open("Looper-1:keys"));
  EXPECT_THAT(inputs_->notes(), Contains(HasSubstr("'Looper-1:keys' is left out")));
  inputs_.reset();
  open({.ports = {"looper"}, .left_out = "looper"});
  EXPECT_TRUE(opens_within(3s, "Looper-1:keys"));
}

TEST_F(MidiInputsOnJack, OthersConnectToOurPortAndItsNotesEndWhenTheyGo) {
  open({.ports = {}, .client_name = "Synth"});
  ASSERT_TRUE(is_open("Synth"));
  auto output = MidiOutput::open({.api = "jack", .port = "synth", .client_name = "Player"});
  ASSERT_TRUE(output.has_value()) << output.error().to_string();
  ASSERT_TRUE((*output)->send(Bytes{0x90, 60, 100}).has_value());
  ASSERT_TRUE(hears(1));
  EXPECT_EQ(listener_.heard()[0].port, number("Synth"));
  inputs_->poll();
  EXPECT_THAT(listener_.lost(), ElementsAre());
  output->reset();
  EXPECT_TRUE(is_so_within(1s, [&] {
    inputs_->poll();
    return !listener_.lost().empty();
  }));
  EXPECT_THAT(listener_.lost(), ElementsAre(number("Synth")));
  EXPECT_TRUE(is_open("Synth"));
}

TEST_F(MidiInputsOnJack, ActiveSensingThatStopsEndsTheNotes) {
  Keyboard keyboard("board");
  open();
  keyboard.send({0x90, 60, 100});
  ASSERT_TRUE(hears(1));
  std::this_thread::sleep_for(400ms);
  inputs_->poll();
  EXPECT_THAT(listener_.lost(), ElementsAre());  // it never sensed
  keyboard.send({0xFE});
  ASSERT_TRUE(hears(2));
  EXPECT_TRUE(is_so_within(2s, [&] {
    inputs_->poll();
    return !listener_.lost().empty();
  }));
  EXPECT_GE(steady_clock_ns() - listener_.heard()[1].time_ns, 300'000'000);
  EXPECT_THAT(listener_.lost(), ElementsAre(number("board:keys")));
  EXPECT_TRUE(is_open("board:keys"));
}

TEST_F(MidiInputsOnJack, OnlyPortsAskedForAreOpened) {
  Keyboard wanted("wanted"), other("other");
  open({.ports = {"WANT"}, .virtual_port = false});
  EXPECT_TRUE(is_open("wanted:keys"));
  EXPECT_EQ(inputs_->ports().size(), 1u);
  const auto none = MidiInputs::open({.ports = {"piano"}}, listener_);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::unknown_name);
  EXPECT_THAT(none.error().message, HasSubstr("'piano'"));
  EXPECT_THAT(none.error().message, HasSubstr("'wanted:keys', 'other:keys'"));
}

TEST_F(MidiInputsOnJack, MorePortsThanThereIsRoomForAreTold) {
  jack_client_t* const many = jack_client_open("many", JackNoStartServer, nullptr);
  ASSERT_NE(many, nullptr);
  for (int i = 0; i <= kMaxMidiPorts; ++i) {
    jack_port_register(many, ("m" + std::to_string(i)).c_str(), JACK_DEFAULT_MIDI_TYPE,
                       JackPortIsOutput, 0);
  }
  open({.virtual_port = false});
  EXPECT_EQ(inputs_->ports().size(), static_cast<std::size_t>(kMaxMidiPorts));
  EXPECT_THAT(inputs_->notes(),
              Contains("'many:m16' is left out: 16 inputs are open, which is the most"));
  jack_client_close(many);
  EXPECT_TRUE(is_so_within(1s, [&] { return inputs_->poll(); }));
  Keyboard fresh("fresh");  // takes the number of one that has gone
  EXPECT_TRUE(opens_within(3s, "fresh:keys"));
  EXPECT_EQ(inputs_->ports().size(), static_cast<std::size_t>(kMaxMidiPorts));
}

TEST_F(MidiInputsOnJack, TheListNamesPortsAndWhyAnApiHasNone) {
  auto keyboard = std::make_unique<Keyboard>("board");
  const MidiPortList list = list_midi_ports();
  EXPECT_TRUE(std::any_of(list.inputs.begin(), list.inputs.end(), [](const MidiPortInfo& port) {
    return port.api == "jack" && port.name == "board:keys";
  }));
  server_.kill();
  keyboard.reset();
  EXPECT_THAT(list_midi_ports().notes, Contains("jack: no server is running"));
}

TEST_F(MidiInputsOnJack, OutputsRefuseWhatIsNoMessageAndWhatHasNoServer) {
  auto output = MidiOutput::open({.api = "jack"});
  ASSERT_TRUE(output.has_value());
  for (const Bytes& bytes : {Bytes{}, {60}, {0x90, 60}, {0x90, 60, 100, 61}, {0xF0, 1}, {0xF7}}) {
    const auto sent = (*output)->send(bytes);
    ASSERT_FALSE(sent.has_value());
    EXPECT_EQ(sent.error().code, ErrorCode::malformed);
  }
  Bytes longest(20000, 1);
  longest.front() = 0xF0;
  longest.back() = 0xF7;
  EXPECT_EQ((*output)->send(longest).error().code, ErrorCode::value_out_of_range);
  server_.kill();
  ASSERT_TRUE(is_so_within(1s, [&] { return !(*output)->send(Bytes{0xF8}).has_value(); }));
  EXPECT_EQ((*output)->send(Bytes{0xF8}).error().message, "the JACK server has gone");
  EXPECT_EQ(MidiOutput::open({.api = "midiman"}).error().code, ErrorCode::unknown_name);
}

}  // namespace
}  // namespace knotwave::io
