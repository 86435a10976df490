// SPDX-License-Identifier: MIT
#include "synth.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "take_files.h"

namespace knotwave::synth {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kTickNs = 50 * kMs;
constexpr double kTakeWaitSeconds = 5;  ///< servers of a busy machine stand still for a while

PlayerConfig player_config(const SynthOptions& o) {
  PlayerConfig config;
  config.audio.api = o.audio_api;
  config.audio.device = o.audio_device;
  config.audio.rate_hz = o.rate_hz;
  config.audio.block_frames = o.block_frames;
  config.audio.latency_s = o.latency_ms / 1000;
  config.audio.channels = o.channels;
  config.midi.api = o.midi_api;
  config.midi.ports = o.midi_in;
  config.engine.seed = o.seed;
  config.engine.threads = o.threads;
  config.engine.volume_db = o.volume_db;
  config.plays_without_device = !o.record.empty();
  return config;
}

std::string joined(const std::vector<std::string>& names) {
  std::string line;
  for (const std::string& name : names) line += (line.empty() ? "" : ", ") + name;
  return line;
}

engine::LiveMessage channel_message(int status, int first, int second, std::int64_t now_ns) {
  engine::LiveMessage message;
  message.time_ns = now_ns;
  message.bytes[0] = static_cast<std::uint8_t>(status);
  message.bytes[1] = static_cast<std::uint8_t>(first);
  message.bytes[2] = static_cast<std::uint8_t>(second);
  return message;
}

}  // namespace

Synth::Synth(const SynthOptions& options)
    : options_(options),
      screen_(std::make_unique<Screen>(!options.plain && !options.json_status)),
      start_ns_(io::steady_clock_ns()) {}

Result<std::unique_ptr<Synth>> Synth::open(const SynthOptions& options, Performance performance,
                                           const Resume& resume) {
  auto watch = std::make_unique<PatchWatch>(performance.bank);
  const std::vector<std::string> warnings = performance.bank.input.warnings;
  PlayerConfig config = player_config(options);
  config.lost_api = resume.api;
  config.lost_rate_hz = resume.rate_hz;
  if (performance.song) {
    config.song = std::move(performance.song->song);
    config.song_position_s = std::max(0.0, resume.song_s);
  }
  auto player = Player::open(config, std::move(performance.bank));
  if (!player) return player.error();
  std::unique_ptr<OscDoor> osc;
  if (options.osc) {
    auto door = OscDoor::open(*options.osc, (*player)->gate());
    if (!door) return door.error();
    osc = *std::move(door);
  }
  std::unique_ptr<Synth> synth(new Synth(options));
  synth->player_ = *std::move(player);
  synth->watch_ = std::move(watch);
  synth->osc_ = std::move(osc);
  synth->name_ = performance.name;
  synth->song_name_ = performance.song_name;
  synth->first_path_ = synth->watch_->path();
  synth->takes_ = resume.takes;
  if (auto good = synth->open_learn(); !good) return good.error();
  synth->choose_entry(static_cast<std::size_t>(resume.program_entry));
  synth->tell_all(warnings);
  if (performance.song) synth->tell_all(performance.song->warnings);
  synth->player_->play(resume.held);
  if (!options.record.empty()) {
    if (auto good = synth->begin_take(); !good) return good.error();
  }
  if (auto good = synth->player_->start(); !good) return good.error();
  synth->start_ns_ = io::steady_clock_ns();
  return synth;
}

Synth::~Synth() {
  screen_.reset();
  for (const std::string& line : told_later_) std::fprintf(stderr, "%s\n", line.c_str());
}

Resume Synth::resume() const {
  Resume resume;
  resume.patch = watch_->path();
  resume.program_entry = static_cast<int>(program_entry_);
  const SongPlayer* song = player_->song();
  if (song != nullptr && !song->is_over()) resume.song_s = song->position_s();
  resume.takes = takes_;
  resume.api = player_->format().api;
  resume.rate_hz = player_->rate_hz();
  resume.held = player_->held();
  return resume;
}

Synth::End Synth::run(const std::atomic<int>& signals) {
  bool is_over = false;
  for (;;) {
    const std::int64_t now_ns = io::steady_clock_ns();
    read_keys(now_ns);
    if (now_ns >= next_tick_ns_) tick(now_ns);
    is_over = is_time_over(now_ns);
    if (signals > 0 || is_quitting_ || is_over || player_->wants_restart()) break;
    wait(now_ns);
  }
  const bool is_restart = player_->wants_restart() && signals == 0 && !is_quitting_ && !is_over;
  if (!player_->wants_restart()) player_->fade_out();
  end_take();
  if (is_restart) return End::restart;
  return signals > 0 ? End::signal : End::asked;
}

/// A take that is to be as long is waited for: its device has a clock of its own.
bool Synth::is_time_over(std::int64_t now_ns) const {
  if (options_.duration_s <= 0) return false;
  const double over_s = static_cast<double>(now_ns - start_ns_) * 1e-9 - options_.duration_s;
  return over_s >= (recorder_ && recorder_->has_length() ? kTakeWaitSeconds : 0);
}

/// Until the next tick, or until a key is typed or a note of the keyboard ends.
void Synth::wait(std::int64_t now_ns) const {
  std::int64_t until = next_tick_ns_;
  if (const std::int64_t end = keyboard_.next_end_ns(); end >= 0) until = std::min(until, end);
  const auto ms =
      static_cast<int>(std::clamp<std::int64_t>((until - now_ns + kMs - 1) / kMs, 1, 50));
  pollfd typed{keys_.descriptor(), POLLIN, 0};
  ::poll(&typed, 1, ms);
}

void Synth::tick(std::int64_t now_ns) {
  next_tick_ns_ = now_ns + kTickNs;
  std::vector<std::string> told;
  player_->tick(now_ns, told);
  tell_all(told);
  if (player_->is_engine_ending()) {
    end_take();
    std::vector<std::string> more;
    player_->end_engine(more);
    tell_all(more);
  }
  follow_patch();
  follow_network();
  follow_take();
  follow_song();
  follow_learn();
  show(now_ns);
}

void Synth::follow_patch() {
  const std::string before = watch_->path();
  PatchWatch::News news = watch_->poll(io::steady_clock_ns());
  if (news.bank) {
    player_->install(*std::move(news.bank));
    if (watch_->path() != first_path_) name_.clear();
    choose_entry(watch_->path() == before ? program_entry_ : 0);
  }
  tell_all(news.lines);
}

void Synth::follow_network() {
  if (!osc_) return;
  OscDoor::Wishes wishes = osc_->take();
  if (wishes.panic) player_->panic();
  if (!wishes.patch.empty()) watch_->load(wishes.patch);
  tell_all(wishes.lines);
}

void Synth::follow_take() {
  if (recorder_ && recorder_->is_over()) end_take();
}

void Synth::follow_song() {
  const SongPlayer* song = player_->song();
  if (song == nullptr || is_song_told_ || !song->is_over()) return;
  is_song_told_ = true;
  tell("the song is over: " + song_name_);
}

void Synth::read_keys(std::int64_t now_ns) {
  if (!keys_.is_on()) return;
  for (const KeyAction& action : keyboard_.type(keys_.read(), now_ns)) act(action, now_ns);
  for (const KeyAction& action : keyboard_.expire(now_ns)) act(action, now_ns);
}

void Synth::act(const KeyAction& action, std::int64_t now_ns) {
  using Kind = KeyAction::Kind;
  switch (action.kind) {
    case Kind::note_on:
      player_->gate().push(kKeyboardInput,
                           channel_message(0x90, action.key, Keyboard::kVelocity, now_ns));
      break;
    case Kind::note_off:
      player_->gate().push(kKeyboardInput, channel_message(0x80, action.key, 64, now_ns));
      break;
    case Kind::octave:
      break;
    case Kind::panic:
      player_->panic();
      break;
    case Kind::record:
      if (recorder_) {
        end_take();
      } else if (auto good = begin_take(); !good) {
        has_failed_ = true;
        tell("not recording: " + good.error().message);
      }
      break;
    case Kind::next_patch:
      next_patch();
      break;
    case Kind::learn:
      learn_next();
      break;
    case Kind::help:
      is_help_shown_ = !is_help_shown_;
      if (!screen_->is_on()) tell_all(keyboard_help());
      break;
    case Kind::quit:
      is_quitting_ = true;
      break;
  }
}

void Synth::next_patch() {
  if (next_program()) return;
  const auto next = watch_->next_in_folder();
  if (!next) return tell("there is no other patch in the folder of " + watch_->path());
  watch_->load(*next);
}

/// Of a bank with more than one. False: it has no other.
bool Synth::next_program() {
  const auto& entries = player_->bank().entries;
  const auto is_melodic = [](const engine::BankEntry& entry) { return entry.key < 0; };
  if (std::count_if(entries.begin(), entries.end(), is_melodic) < 2) return false;
  do {
    program_entry_ = (program_entry_ + 1) % entries.size();
  } while (!is_melodic(entries[program_entry_]));
  choose_entry(program_entry_);
  const engine::BankEntry& entry = entries[program_entry_];
  player_->play({channel_message(0xB0, 0, std::max(0, entry.bank_msb), 0),
                 channel_message(0xB0, 32, std::max(0, entry.bank_lsb), 0),
                 channel_message(0xC0, entry.program_low, 0, 0)});
  tell("channel 1 plays program " + std::to_string(entry.program_low) + ": " + entry.patch_file);
  return true;
}

/// Its names are what OSC knows, and tab goes on from there.
void Synth::choose_entry(std::size_t entry) {
  const auto& patches = player_->bank().entry_patch;
  program_entry_ = entry < patches.size() ? entry : 0;
  follow_targets(program_entry_ < patches.size() ? static_cast<std::size_t>(patches[program_entry_])
                                                 : 0);
}

Result<void> Synth::begin_take() {
  ++takes_;
  const std::string wanted = options_.record.empty() ? "take.wav" : options_.record;
  const bool is_named = !options_.record.empty() && takes_ == 1;
  const std::string path = is_named ? wanted : free_take_path(wanted, takes_);
  const bool is_there = !take_files_there(path).empty();
  auto recorder = Recorder::start(player_->live(), path, player_->rate_hz(),
                                  is_named ? options_.duration_s : 0);
  if (!recorder) return recorder.error();
  recorder_ = *std::move(recorder);
  tell("recording " + path + (is_there ? "; the take that is there stays until it ends" : ""));
  return {};
}

/// What went wrong with the files beside the sound.
std::vector<std::string> Synth::write_beside(const Recorder::Take& take) {
  const engine::Journal& journal = player_->journal();
  if (!player_->is_journal_whole() || player_->live().status().journal_dropped > 0) {
    return {
        "more was played since the start than a journal holds: this take has none, and cannot "
        "be rendered again"};
  }
  std::vector<std::string> faults = write_take_files(take, journal);
  has_failed_ = has_failed_ || !faults.empty();
  return faults;
}

void Synth::end_take() {
  if (!recorder_) return;
  const std::unique_ptr<Recorder> recorder = std::move(recorder_);
  const std::vector<std::string> replaced = take_files_there(recorder->path());
  const auto take = recorder->finish();
  if (!take) {
    has_failed_ = true;
    return tell("the take is lost: " + take.error().to_string());
  }
  const std::vector<std::string> faults = write_beside(*take);
  tell_all(faults);
  if (faults.empty() && !replaced.empty()) tell(joined(replaced) + ": replaced");
  if (!take->fault.empty()) {
    has_failed_ = true;
    tell("the take ends here: " + take->fault);
  }
  tell(take->path + ": " + clock_text(static_cast<double>(take->frames) / player_->rate_hz()) +
       (take->sha256.empty() ? ", with gaps" : ", sha256 " + take->sha256));
}

}  // namespace knotwave::synth
