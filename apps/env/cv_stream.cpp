// SPDX-License-Identifier: MIT
#include "cv_stream.h"

#include <algorithm>
#include <numeric>

#include "knotwave/base/document.h"
#include "knotwave/base/file.h"

namespace knotwave::env {

Result<std::vector<engine::VoltageChannel>> read_calibration(const EnvOptions& options) {
  if (options.calibration.empty()) return std::vector<engine::VoltageChannel>();
  const auto text = base::read_file(options.calibration, base::kMaxDocumentBytes);
  if (!text) return text.error();
  return engine::parse_calibration(*text, options.calibration);
}

std::string highest_channel_text(const EnvInput& input) {
  std::string text;
  int highest = 0;
  const auto hear = [&](int channel, const char* what, std::size_t index, const std::string& name) {
    if (channel <= highest) return;
    highest = channel;
    text = what + std::to_string(index + 1) + " of '" + name + "' goes to channel " +
           std::to_string(channel);
  };
  for (const auto& program : input.programs) {
    const engine::EnvelopePatchSpec& spec = program->spec();
    for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
      const engine::OutputSpec& output = spec.outputs[i];
      if (output.kind != engine::OutputKind::voltage) continue;
      hear(output.number, "output ", i, spec.patch.name);
    }
    for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
      const engine::PlaceEventSpec& event = spec.place_events[i];
      if (event.kind != engine::PlaceEventSpec::Kind::voltage) continue;
      hear(event.voltage_channel, "event ", i, spec.patch.name);
    }
  }
  return text;
}

Result<std::unique_ptr<CvStream>> CvStream::open(const EnvOptions& options, const EnvInput& input) {
  std::unique_ptr<CvStream> cv(new CvStream(options, input));
  cv->voltage_.direct_current = options.direct_current;
  auto channels = read_calibration(options);
  if (!channels) return channels.error();
  cv->voltage_.channels = std::move(*channels);
  // The rate is the device's, which only an open stream knows.
  const auto probe = CvPlayer::create(cv->voltage_, options.seed, input.voltage_patches());
  if (!probe) return probe.error();
  io::AudioConfig& audio = cv->audio_;
  audio.api = options.audio_api;
  audio.device = options.audio_device;
  audio.client_name = "Knotwave-env-cv";
  audio.channels.resize(probe->channels());
  std::iota(audio.channels.begin(), audio.channels.end(), 1);
  auto stream = io::AudioStream::open(audio, *cv);
  if (!stream) {
    Error error = stream.error();
    if (error.code == ErrorCode::value_out_of_range) {
      error.message += "; " + highest_channel_text(input);
    }
    return error;
  }
  // The same way again if it is lost: another one might take the card from a server that returns.
  audio.api = (*stream)->format().api;
  if (const auto started = cv->start(std::move(*stream)); !started) return started.error();
  return cv;
}

Result<void> CvStream::make_player(double rate_hz) {
  voltage_.rate_hz = rate_hz;
  auto player = CvPlayer::create(voltage_, options_.seed, input_.voltage_patches());
  if (!player) return player.error();
  player_ = std::make_unique<CvPlayer>(std::move(*player));
  for (engine::MidiClock& clock : clocks_) clock.reset(rate_hz);
  rate_hz_ = rate_hz;
  has_front_ = false;
  while (ring_.pop(front_)) {
  }
  return {};
}

Result<void> CvStream::start(std::unique_ptr<io::AudioStream> stream) {
  const double rate_hz = stream->format().rate_hz;
  const bool is_other = player_ == nullptr || rate_hz != rate_hz_ || is_overrun_.exchange(false);
  if (is_other) {
    if (auto made = make_player(rate_hz); !made) return made;
  }
  player_->begin_again();
  stream_ = std::move(stream);
  return stream_->start();
}

CvStream::~CvStream() { stream_.reset(); }

void CvStream::heard(const base::MidiEvent& event, std::int64_t time_ns) noexcept {
  if (event.bytes[0] != 0xF0 && !ring_.push({event, time_ns})) is_overrun_ = true;
}

std::string CvStream::look() {
  constexpr std::int64_t kTryEveryNs = 1'000'000'000;
  if (!is_lost_) {
    const io::AudioStatus status = stream_->status();
    if (status.state != io::AudioStatus::State::lost) return {};
    is_lost_ = true;
    stream_.reset();
    return "control voltage: " + status.reason + "; it is looked for";
  }
  const std::int64_t now_ns = io::steady_clock_ns();
  if (auto opened = opener_.take(); opened && *opened) {
    if (start(**std::move(opened))) {
      is_lost_ = false;
      return "control voltage is back: " + device_text();
    }
    stream_.reset();
  }
  if (now_ns >= next_try_ns_ && !must_ramp_out_) {
    opener_.begin(audio_, *this);
    next_try_ns_ = now_ns + kTryEveryNs;
  }
  return {};
}

/// Clocks become tempo; everything is told at the sample that is played next.
void CvStream::handle(const Heard& heard) KNOTWAVE_RT {
  engine::Event event;
  event.midi = heard.event;
  event.midi.time = {player_->now(), 0};
  engine::MidiClock& clock = clocks_[heard.event.port % clocks_.size()];
  const std::uint8_t status = heard.event.bytes[0];
  if (status == 0xF8 || status == 0xF2 || (status >= 0xFA && status <= 0xFC)) {
    const engine::MidiClock::News news = clock.handle(event.midi);
    const auto tell = [&](engine::Event told) KNOTWAVE_RT {
      told.midi.time = event.midi.time;
      player_->handle(told);
    };
    if (news.tempo) tell(clock.tempo_event());
    if (news.position) tell(clock.position_event());
  }
  player_->handle(event);
}

void CvStream::play_until(std::size_t end, const io::AudioBlock& block) KNOTWAVE_RT {
  while (at_ < end) {
    const std::size_t n = std::min(end - at_, CvPlayer::kMostSamples);
    for (std::size_t c = 0; c < player_->channels(); ++c) out_[c] = block.outputs[c] + at_;
    player_->render(n, std::span<float* const>(out_.data(), player_->channels()));
    at_ += n;
  }
}

// What is heard at a time sounds one block and what the planner takes later, always.
void CvStream::process(const io::AudioBlock& block) KNOTWAVE_RT {
  const auto frames = static_cast<std::size_t>(block.frames);
  at_ = 0;
  if (must_ramp_out_.load(std::memory_order_relaxed) && !is_ramping_) {
    player_->ramp_out();
    is_ramping_ = true;
  }
  const double frame_ns = 1e9 / rate_hz_;
  const auto length_ns = static_cast<std::int64_t>(block.frames * frame_ns);
  for (std::size_t i = 0; i < kMostHeard; ++i) {
    if (!has_front_ && !(has_front_ = ring_.pop(front_))) break;
    const std::int64_t after_ns = front_.time_ns + length_ns + kPlannerNs - block.time_ns;
    if (after_ns >= length_ns) break;  // of a later block
    const double at = static_cast<double>(std::max<std::int64_t>(after_ns, 0)) / frame_ns;
    play_until(std::min(static_cast<std::size_t>(at), frames), block);
    handle(front_);
    has_front_ = false;
  }
  play_until(frames, block);
  if (is_ramping_ && player_->is_silent()) is_silent_.store(true, std::memory_order_relaxed);
}

std::string CvStream::device_text() const {
  const io::AudioFormat& format = stream_->format();
  return format.api + " '" + format.device + "', " + base::number_text(format.rate_hz) +
         " Hz, channels 1 to " + std::to_string(format.channels);
}

}  // namespace knotwave::env
