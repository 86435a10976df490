// SPDX-License-Identifier: MIT
// A build without RtMidi says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/midi_input.h"
#include "knotwave/io/midi_output.h"

namespace knotwave::io {
namespace {

class Deaf : public MidiListener {
 public:
  void message(const base::MidiEvent&, std::int64_t) noexcept override {}
  void port_lost(int) noexcept override {}
};

TEST(WithoutRtMidi, EveryWaySaysWhatToInstall) {
  Deaf listener;
  const auto inputs = MidiInputs::open({}, listener);
  ASSERT_FALSE(inputs.has_value());
  EXPECT_EQ(inputs.error().code, ErrorCode::unsupported);
  EXPECT_THAT(inputs.error().message, testing::HasSubstr("librtmidi-dev"));
  EXPECT_EQ(MidiOutput::open({}).error().code, ErrorCode::unsupported);
  EXPECT_EQ(list_midi_ports().notes.size(), 1u);
}

}  // namespace
}  // namespace knotwave::io
