// SPDX-License-Identifier: MIT
// knotwave-env at a JACK server of the test's own: what it sends and when, and how it ends.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "knotwave/engine/envelope_generator.h"

#include "jack_receiver.h"
#include "live_clients.h"
#include "support/background_program.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"
#include "support/program.h"

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr const char* kPatch = R"(
format = 1
kind = "envelope"
name = "swell"
mode = "mono"
notes = "thru"
[ports.synth]
wire = "din"
[curves.swell]
degree = 2
points = [0, 1, 0.6, 0.1, 0]
[envelopes.swell]
curve = "swell"
seconds = 0.8
[[outputs]]
from = "swell"
to = "cc74"
port = "synth"
channel = 3
rest = 33
)";

/// The program in the background, with this patch.
class EnvProcess {
 public:
  explicit EnvProcess(std::vector<std::string> words) {
    std::ofstream(folder_.file("swell.toml")) << kPatch;
    words.insert(words.begin(),
                 {std::string(KNOTWAVE_BIN_DIR) + "/knotwave-env", folder_.file("swell.toml")});
    program_ = std::make_unique<support::BackgroundProgram>(words, folder_.file("log"));
  }
  support::BackgroundProgram& program() { return *program_; }
  std::string log() const {
    std::ifstream file(folder_.file("log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  support::ScratchFolder folder_;
  std::unique_ptr<support::BackgroundProgram> program_;
};

/// Samples of the virtual clock at which a generator sends what, the patch played by one note.
class Computed final : public engine::GeneratorSink {
 public:
  struct Message {
    double sample = 0;
    std::vector<int> bytes;
  };
  Computed() {
    const auto spec = engine::parse_envelope_patch(kPatch, "swell.toml");
    EXPECT_TRUE(spec.has_value()) << spec.error().to_string();
    const auto program = engine::EnvelopePatchProgram::create(*spec);
    EXPECT_TRUE(program.has_value()) << program.error().to_string();
    const engine::EnvelopePatchProgram* const patches[] = {program->get()};
    const auto generator = engine::EnvelopeGenerator::create({}, patches);
    EXPECT_TRUE(generator.has_value()) << generator.error().to_string();
    base::MidiEvent note;
    note.time = {4800, 0};
    note.bytes[0] = 0x90;
    note.bytes[1] = 60;
    note.bytes[2] = 100;
    (*generator)->advance(4800, *this);
    (*generator)->handle(note);
    (*generator)->advance(4800 + 2 * 48000, *this);
  }
  const std::vector<Message>& messages() const { return messages_; }

 private:
  void midi(int, const base::MidiEvent& event) KNOTWAVE_RT override {
    const double sample =
        static_cast<double>(event.time.sample) + static_cast<double>(event.time.fraction) * 0x1p-32;
    messages_.push_back({sample, {event.bytes, event.bytes + 3}});
  }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  std::vector<Message> messages_;
};

class EnvOnJack : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }
  /// The board hears what the program sends.
  bool is_connected(JackReceiver& board) {
    return seconds_until([&] { return board.connect("Knotwave-env:synth"); }, 15) < 15;
  }
  support::JackServer server_{256};
};

std::ptrdiff_t note_on(const std::vector<JackReceiver::Heard>& heard) {
  const auto at = std::find_if(heard.begin(), heard.end(),
                               [](const auto& message) { return message.bytes[0] == 0x90; });
  return at - heard.begin();
}

TEST_F(EnvOnJack, SendsEachValueWhenTheVirtualClockSaysAndRestsAtTheEnd) {
  EnvProcess env({"--midi-api", "jack", "--monitor"});
  JackReceiver board("board");
  ASSERT_TRUE(is_connected(board)) << env.log();
  ASSERT_LT(seconds_until([&] { return env.log().find("\nIN ") != std::string::npos; }, 15), 15);
  const Computed computed;
  const std::size_t wanted = computed.messages().size();
  ASSERT_GT(wanted, 50u);
  // The program connects every source that comes by itself; two seconds are plenty for it.
  const support::JackMidiSender keys("", {{96000, {0x90, 60, 100}}});
  const auto values_of = [&board] {
    std::vector<JackReceiver::Heard> all;
    for (std::size_t i = 0; i < board.count(); ++i) all.push_back(board.heard(i));
    return all;
  };
  EXPECT_LT(seconds_until([&] { return board.count() >= wanted; }, 20), 20) << env.log();
  const auto heard = values_of();
  const auto first = note_on(heard);
  ASSERT_LT(first, static_cast<std::ptrdiff_t>(heard.size())) << env.log();
  // Times from the note on: of what was heard, and of the same values as computed.
  const auto& right = computed.messages();
  const auto right_first =
      std::find_if(right.begin(), right.end(), [](const auto& m) { return m.bytes[0] == 0x90; });
  ASSERT_NE(right_first, right.end());
  std::vector<double> errors;
  auto next = heard.begin() + first;
  for (auto message = right_first; message != right.end(); ++message) {
    next =
        std::find_if(next, heard.end(), [&](const auto& h) { return h.bytes == message->bytes; });
    if (next == heard.end()) break;
    const double at = static_cast<double>(next->frame) -
                      static_cast<double>(heard[static_cast<std::size_t>(first)].frame);
    errors.push_back(std::abs(at - (message->sample - right_first->sample)));
  }
  ASSERT_GT(errors.size(), wanted / 2) << env.log();
  std::sort(errors.begin(), errors.end());
  std::printf("%zu of %zu messages; error in frames: median %.2f, 99 %% %.2f, most %.2f\n",
              errors.size(), static_cast<std::size_t>(right.end() - right_first),
              errors[errors.size() / 2], errors[errors.size() * 99 / 100], errors.back());
  EXPECT_LE(errors[errors.size() / 2], 2);
  env.program().end(SIGINT);
  EXPECT_LT(seconds_until(
                [&] {
                  const auto all = values_of();  // the note ends as well, in any order
                  const auto last = std::find_if(all.rbegin(), all.rend(), [](const auto& message) {
                    return message.bytes[0] == 0xB2;
                  });
                  return last->bytes == (std::vector<int>{0xB2, 74, 33});
                },
                5),
            5)
      << env.log();
  EXPECT_THAT(env.log(), HasSubstr("CC 74 = "));
}

TEST_F(EnvOnJack, NamesThePortsThereAreWhereOneIsWrong) {
  JackReceiver board("board");
  const support::ProgramRun run = support::run_program(
      {"knotwave-env", std::string(KNOTWAVE_SOURCE_DIR) + "/examples/envelopes/filter-swell.toml",
       "--midi-api", "jack", "--midi-out", "bored"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no MIDI output of jack has 'bored' in its name; there is: "
                                 "'board:in'"));
}

}  // namespace
}  // namespace knotwave::io
