// SPDX-License-Identifier: MIT
#include "player.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

#include "wait_notice.h"

namespace knotwave::synth {
namespace {

constexpr std::int64_t kTryEveryNs = 500'000'000;
/// A call that hangs in a JACK server that stands still comes back with it, or when it is killed.
constexpr std::int64_t kJackPatienceNs = 10'000'000'000;
constexpr double kFadeSeconds = 0.05;
constexpr double kFadeStallSeconds = 0.3;
constexpr std::size_t kMostRecords = 2'000'000;                ///< some 130 MB
constexpr std::size_t kMostBankBytes = std::size_t{64} << 20;  ///< every save is another bank

std::string device_words(const io::AudioFormat& format) {
  return format.api + (format.device.empty() ? "" : ": " + format.device) + ", " +
         std::to_string(std::lround(format.rate_hz)) + " Hz";
}

bool is_device_chosen(const io::AudioConfig& config) {
  return !config.api.empty() || !config.device.empty();
}

}  // namespace

Result<std::unique_ptr<Player>> Player::open(const PlayerConfig& config, PlayableBank bank) {
  std::unique_ptr<Player> player(new Player);
  player->config_ = config;
  player->bank_ = std::move(bank);
  player->mono_.resize(io::kMaxAudioBlock);
  if (config.song) {
    player->song_ = std::make_unique<SongPlayer>(*config.song);
    player->exact_.reserve(SongPlayer::kMostEvents +
                           2 * (MidiEntry::kMostExact + PortNotes::kMostHeld));
  }
  if (auto good = player->open_stream(config); !good) return good.error();
  if (auto good = player->make_engine(config.song_position_s); !good) return good.error();
  io::MidiInputConfig midi_config = config.midi;
  player->share_inputs();
  midi_config.client_name = config.audio.client_name + "-midi";  // JACK gives each name once
  auto midi = io::MidiInputs::open(midi_config, *player);
  const bool is_midi_chosen = !config.midi.api.empty() || !config.midi.ports.empty();
  if (midi) {
    player->midi_ = *std::move(midi);
  } else if (is_midi_chosen) {
    return midi.error();
  } else {
    player->first_lines_.push_back("no MIDI: " + midi.error().message);
  }
  return player;
}

Result<void> Player::start() { return stream_->start(); }

/// What hangs is waited for once, not one after the other.
Player::~Player() {
  std::thread other;
  try {
    other = std::thread([this] { midi_.reset(); });
  } catch (const std::system_error&) {
    midi_.reset();
  }
  stream_.reset();
  if (other.joinable()) other.join();
  gate_.lead_to(nullptr);
}

Result<void> Player::open_stream(const PlayerConfig& config) {
  if (!config.lost_api.empty()) {  // it is looked for by the first tick, which waits for nothing
    is_lost_ = true;
    lost_reason_ = "the program was started anew";
    lost_format_.api = config.lost_api;
    lost_format_.rate_hz = config.lost_rate_hz;
    return open_substitute();
  }
  auto stream = [&] {
    const WaitNotice notice("waiting for the sound server, which does not answer yet");
    return io::AudioStream::open(config.audio, *this);
  }();
  if (stream) {
    stream_ = *std::move(stream);
    return {};
  }
  const bool may_do_without = config.plays_without_device && !is_device_chosen(config.audio);
  if (stream.error().code != ErrorCode::unsupported) return stream.error();
  if (!may_do_without) {
    Error error = stream.error();
    error.message += "; or record without one: --audio-api none --record FILE";
    return error;
  }
  first_lines_.push_back(stream.error().message + "; playing without a device");
  lost_format_.rate_hz = config.audio.rate_hz;
  return open_substitute();
}

/// Blocks by the clock, at the rate of lost_format_.
Result<void> Player::open_substitute() {
  io::AudioConfig none = config_.audio;
  none.api = "none";
  none.device.clear();
  none.rate_hz = lost_format_.rate_hz;
  if (lost_format_.block_frames != 0) {
    none.block_frames = std::clamp(lost_format_.block_frames, 16, io::kMaxAudioBlock);
  }
  auto substitute = io::AudioStream::open(none, *this);
  if (!substitute) return substitute.error();
  stream_ = *std::move(substitute);
  return {};
}

/// Of the stream's rate, playing the bank, and the song from a position on.
Result<void> Player::make_engine(double song_position_s) {
  auto program = std::move(bank_.input.program);
  if (!program) {
    auto again = engine::BankProgram::create(bank_.input.spec, bank_.input.waves);
    if (!again) return again.error();
    program = *std::move(again);
  }
  engine::LiveConfig config;
  config.engine = config_.engine;
  config.engine.rate_hz = rate_hz_ = stream_->format().rate_hz;
  auto live = engine::LiveEngine::create(config, std::move(program), bank_.source);
  if (!live) return live.error();
  gate_.lead_to(nullptr);
  live_ = *std::move(live);
  begin_journal();
  is_journal_whole_ = true;
  if (song_) song_->begin(rate_hz_, song_position_s);
  gate_.lead_to(live_.get());
  entry_.tell_again();
  return {};
}

void Player::begin_journal() {
  journal_ = {};
  records_held_ = banks_counted_ = bank_bytes_ = 0;
}

void Player::process(const io::AudioBlock& block) KNOTWAVE_RT {
  const auto frames = static_cast<std::size_t>(block.frames);
  const auto exact = exact_events(block);
  const std::span<float> left(block.outputs[0], frames);
  if (block.outputs.size() > 1) {
    live_->process(block.time_ns, exact, left, {block.outputs[1], frames});
    return;
  }
  const std::span<float> right = std::span(mono_).first(frames);
  live_->process(block.time_ns, exact, left, right);
  for (std::size_t i = 0; i < frames; ++i) left[i] = 0.5f * (left[i] + right[i]);
}

/// What the song plays in a block, and what the stream's own port heard.
std::span<const engine::Event> Player::exact_events(const io::AudioBlock& block) KNOTWAVE_RT {
  const auto heard = entry_.translated(block.midi, block.time_ns, rate_hz_);
  if (!song_) return heard;
  const auto played = song_->due(block.frames);
  const auto comes_first = [](const engine::Event& a, const engine::Event& b) {
    return a.time() < b.time();
  };
  exact_.clear();
  std::merge(played.begin(), played.end(), heard.begin(), heard.end(), std::back_inserter(exact_),
             comes_first);
  return exact_;
}

void Player::message(const base::MidiEvent& event, std::int64_t time_ns) noexcept {
  entry_.heard(event, time_ns);
}

void Player::port_lost(int port) noexcept { entry_.lost(port); }

void Player::tick(std::int64_t now_ns, std::vector<std::string>& told) {
  for (std::string& line : std::exchange(first_lines_, {})) told.push_back(std::move(line));
  live_->collect();
  journal();
  tell_midi(told);
  share_inputs();
  const io::AudioStatus status = stream_->status();
  if (is_leaving_) leave_device(told);
  if (!is_lost_ && status.state == io::AudioStatus::State::lost) lose(status.reason, told);
  follow_senders(status.midi_sources, told);
  follow_hang(now_ns);
  if (is_lost_ && !is_leaving_ && !wants_restart_) look_for_device(now_ns, told);
}

void Player::follow_hang(std::int64_t now_ns) {
  if (!is_lost_ || !io::AudioStream::is_poisoned()) {
    hangs_since_ns_ = 0;
    return;
  }
  if (hangs_since_ns_ == 0) hangs_since_ns_ = now_ns;
  const std::int64_t patience_ns = lost_format_.api == "jack" ? kJackPatienceNs : 0;
  wants_restart_ = wants_restart_ || now_ns - hangs_since_ns_ >= patience_ns;
}

/// What comes by JACK is exact to the sample in the stream's own port, so it is heard there and not
/// by RtMidi, and no port is listened to before it is known whose it is.
void Player::share_inputs() {
  if (!stream_->format().has_midi) return entry_.leave_out(0);
  std::vector<std::string> sources;
  std::uint32_t listened = 0;
  for (const auto& port : ports_) {
    if (!port.is_open) continue;
    if (port.api == "jack" && !port.is_own) {
      sources.push_back(port.name);
    } else {
      listened |= std::uint32_t{1} << port.port;
    }
  }
  entry_.leave_out(~listened);
  stream_->connect_midi(sources);
}

/// Whose of the notes are is not known, so all end; but what is held outlives the device.
void Player::follow_senders(const std::vector<std::string>& sources,
                            std::vector<std::string>& told) {
  const std::vector<std::string> before = std::exchange(senders_, sources);
  for (const std::string& name : sources) std::erase(unplugged_, name);
  if (is_lost_) return;
  for (const std::string& name : before) {
    if (std::find(sources.begin(), sources.end(), name) != sources.end()) continue;
    entry_.stream_sender_left();
    unplugged_.push_back(name);
    told.push_back("MIDI: '" + name + "' was unplugged; the notes of its port ended");
  }
}

/// What the stream's own port hears is told by follow_senders() when it goes, sooner or later.
bool Player::is_told_by_stream(const io::MidiPortStatus& port) const {
  const auto has = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), port.name) != names.end();
  };
  return port.api == "jack" && !port.is_own && !is_lost_ && (has(senders_) || has(unplugged_));
}

void Player::tell_midi(std::vector<std::string>& told) {
  if (!midi_) return;
  const bool is_changed = midi_->poll();
  const auto notes = midi_->notes();
  for (; notes_told_ < notes.size(); ++notes_told_) told.push_back("MIDI: " + notes[notes_told_]);
  if (!is_changed && !ports_.empty()) return;
  const auto ports = midi_->ports();
  for (const auto& port : ports) {
    const auto old = std::find_if(ports_.begin(), ports_.end(),
                                  [&](const auto& other) { return other.port == port.port; });
    const bool was_open = old != ports_.end() && old->is_open;
    if (was_open == port.is_open || (was_open && is_told_by_stream(port))) continue;
    told.push_back("MIDI input '" + port.name + "' (" + port.api + ") " +
                   (port.is_open ? "is open" : "has gone; its notes ended"));
  }
  ports_ = ports;
}

const engine::Journal& Player::journal() {
  live_->take_journal(journal_);
  for (; records_held_ < journal_.records.size(); ++records_held_) {
    held_.add(journal_.records[records_held_]);
  }
  for (; banks_counted_ < journal_.banks.size(); ++banks_counted_) {
    for (const engine::FileText& text : journal_.banks[banks_counted_].files) {
      bank_bytes_ += text.bytes.size();
    }
  }
  if (journal_.records.size() > kMostRecords || bank_bytes_ > kMostBankBytes) {
    begin_journal();
    is_journal_whole_ = false;
  }
  return journal_;
}

void Player::install(PlayableBank bank) {
  live_->install(std::move(bank.input.program), bank.source);
  bank_ = std::move(bank);
}

void Player::panic() {
  if (song_) song_->stop();
  live_->panic();
  entry_.forget();
}

/// Leaving it may take a while, so it is told first.
void Player::lose(const std::string& reason, std::vector<std::string>& told) {
  is_lost_ = is_leaving_ = true;
  lost_reason_ = reason;
  lost_format_ = stream_->format();
  told.push_back("the sound device is lost: " + reason +
                 "; patch and notes are kept until it comes back");
}

/// Without the device the engine goes on by the clock: notes are released, takes go on.
void Player::leave_device(std::vector<std::string>& told) {
  is_leaving_ = false;
  stream_.reset();
  auto good = open_substitute();
  if (good) good = stream_->start();
  if (!good) told.push_back(good.error().message);
}

void Player::look_for_device(std::int64_t now_ns, std::vector<std::string>& told) {
  if (auto opened = opener_.take(); opened && *opened) {
    take_device(**std::move(opened), told);
    return;
  }
  if (now_ns < next_try_ns_ || ending_) return;
  next_try_ns_ = now_ns + kTryEveryNs;
  io::AudioConfig config = config_.audio;
  // The same way as before: another one might take the card from the server that comes back.
  config.api = lost_format_.api;
  opener_.begin(config, *this);
}

void Player::take_device(std::unique_ptr<io::AudioStream> stream, std::vector<std::string>& told) {
  if (stream->format().rate_hz != rate_hz_) {
    ending_ = std::move(stream);
    return;
  }
  stream_.reset();
  stream_ = std::move(stream);
  start_found(told);
}

void Player::start_found(std::vector<std::string>& told) {
  if (auto good = stream_->start(); !good) {
    lose(good.error().message, told);
    return;
  }
  is_lost_ = false;
  told.push_back("the sound device is back: " + device_words(stream_->format()));
}

void Player::end_engine(std::vector<std::string>& told) {
  stream_ = std::move(ending_);
  journal();
  const auto held = held_.messages();
  if (auto good = make_engine(song_ ? song_->position_s() : 0); !good) {
    told.push_back(good.error().message);
    return;
  }
  held_ = {};
  play(held);
  start_found(told);
}

void Player::play(const std::vector<engine::LiveMessage>& messages) {
  for (const engine::LiveMessage& message : messages) gate_.push(kControlInput, message);
}

void Player::fade_out() {
  using std::chrono::steady_clock, std::chrono::duration;
  const io::AudioFormat& format = stream_->format();
  const std::int64_t end = live_->status().now + std::lround(kFadeSeconds * rate_hz_) +
                           std::int64_t{2} * format.block_frames;
  live_->fade(0, static_cast<float>(kFadeSeconds));
  const double block_s = format.block_frames / std::max(1.0, format.rate_hz);
  // On a busy machine blocks come late: it is over when it was rendered, or when none comes.
  const duration<double> stall(std::max(kFadeStallSeconds, 2 * block_s));
  auto moved = steady_clock::now();
  for (std::int64_t before = -1; steady_clock::now() - moved < stall;) {
    const std::int64_t now = live_->status().now;
    if (now >= end) break;
    if (std::exchange(before, now) != now) moved = steady_clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const double latency_s = is_lost_ ? 0 : std::clamp(format.latency_s, 0.0, 0.3);
  std::this_thread::sleep_for(duration<double>(latency_s + block_s));
}

void Player::describe(SynthStatus& status) {
  status.format = format();
  status.stream = stream_->status();
  status.is_lost = is_lost_;
  status.lost_reason = is_lost_ ? lost_reason_ : "";
  status.live = live_->status();
  if (midi_) status.midi = midi_->ports();
  if (song_ && !song_->is_over()) {
    status.song_s = song_->position_s();
    status.song_length_s = song_->length_s();
  }
  status.clock_bpm = entry_.clock_bpm();
  status.clock_jitter_ms = entry_.clock_jitter_ms();
  status.knobs_to_turn = entry_.to_turn();
  const auto& patches = bank_.input.spec.patches;
  const auto patch = static_cast<std::size_t>(std::max(0, status.live.envelope_patch));
  if (patch >= patches.size()) return;
  const engine::PatchSpec& spec = patches[patch];
  status.patch_name = spec.name;
  for (const auto& envelope : spec.envelopes) {
    if (envelope.name == "amp") status.envelope = spec.curves.find_curve(envelope.curve);
  }
}

}  // namespace knotwave::synth
