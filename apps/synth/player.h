// SPDX-License-Identifier: MIT
// An engine under a sound device and MIDI inputs, and what becomes of them when the device goes.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "knotwave/engine/live_engine.h"
#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_input.h"

#include "bank_loader.h"
#include "engine_gate.h"
#include "held_state.h"
#include "midi_entry.h"
#include "song_player.h"
#include "status.h"
#include "stream_opener.h"

namespace knotwave::synth {

struct PlayerConfig {
  io::AudioConfig audio;
  io::MidiInputConfig midi;
  engine::EngineConfig engine;        ///< the rate comes from the device
  bool plays_without_device = false;  ///< where none is chosen and none is there
  std::optional<io::Song> song;       ///< is played from the first sample on
  double song_position_s = 0;         ///< where it begins
  /// Not empty: a device of this API was lost, and is looked for where it is not there.
  std::string lost_api;
  double lost_rate_hz = 0;
};

/// [control] unless said otherwise; one thread.
class Player final : private io::AudioClient, private io::MidiListener {
 public:
  /// Errors: of the device, the MIDI inputs and the engine.
  static Result<std::unique_ptr<Player>> open(const PlayerConfig& config, PlayableBank bank);
  ~Player() override;
  /// Sounds when it returns; before that nothing moves. Errors: those of the device.
  Result<void> start();

  /// Looks after everything: some 20 times a second. Lines worth telling are added to `told`.
  void tick(std::int64_t now_ns, std::vector<std::string>& told);

  /// Another bank, at the next block.
  void install(PlayableBank bank);
  const engine::BankSpec& bank() const { return bank_.input.spec; }
  void panic();
  const SongPlayer* song() const { return song_.get(); }
  EngineGate& gate() { return gate_; }
  MidiEntry& entry() { return entry_; }
  engine::LiveEngine& live() { return *live_; }
  /// All that happened since engine time 0, or since memory for it had an end.
  const engine::Journal& journal();
  bool is_journal_whole() const { return is_journal_whole_; }

  /// Device, engine and MIDI of a status.
  void describe(SynthStatus& status);
  double rate_hz() const { return stream_->format().rate_hz; }

  /// Of the device that plays, or that was lost.
  const io::AudioFormat& format() const { return is_lost_ ? lost_format_ : stream_->format(); }

  /// The device's library hangs: only a program started anew can use it. What is held is then
  /// played into that one.
  bool wants_restart() const { return wants_restart_; }
  std::vector<engine::LiveMessage> held() const { return held_.messages(); }
  void play(const std::vector<engine::LiveMessage>& messages);

  /// A device with another rate needs an engine of that rate, and a take ends with its engine: asks
  /// before the engine goes.
  bool is_engine_ending() const { return ending_ != nullptr; }
  void end_engine(std::vector<std::string>& told);

  /// The sound goes down in 50 ms; returns when it has been heard.
  void fade_out();

 private:
  Player() = default;
  void process(const io::AudioBlock& block) KNOTWAVE_RT override;
  void message(const base::MidiEvent& event, std::int64_t time_ns) noexcept override;
  void port_lost(int port) noexcept override;

  Result<void> open_stream(const PlayerConfig& config);
  Result<void> make_engine(double song_position_s);
  std::span<const engine::Event> exact_events(const io::AudioBlock& block) KNOTWAVE_RT;
  void begin_journal();
  Result<void> open_substitute();
  void lose(const std::string& reason, std::vector<std::string>& told);
  void leave_device(std::vector<std::string>& told);
  void follow_hang(std::int64_t now_ns);
  void look_for_device(std::int64_t now_ns, std::vector<std::string>& told);
  void take_device(std::unique_ptr<io::AudioStream> stream, std::vector<std::string>& told);
  void start_found(std::vector<std::string>& told);
  void tell_midi(std::vector<std::string>& told);
  bool is_told_by_stream(const io::MidiPortStatus& port) const;
  void share_inputs();
  void follow_senders(const std::vector<std::string>& sources, std::vector<std::string>& told);

  PlayerConfig config_;
  PlayableBank bank_;
  EngineGate gate_;
  MidiEntry entry_{gate_};
  std::unique_ptr<engine::LiveEngine> live_;
  std::unique_ptr<SongPlayer> song_;
  std::vector<engine::Event> exact_;  ///< of a block: song and stream
  engine::Journal journal_;
  bool is_journal_whole_ = true;
  std::size_t records_held_ = 0;                    ///< of the journal, which held_ knows
  std::size_t banks_counted_ = 0, bank_bytes_ = 0;  ///< of the journal
  HeldState held_;
  std::unique_ptr<io::AudioStream> stream_;
  std::unique_ptr<io::AudioStream> ending_;  ///< of another rate, waits for end_engine()
  std::unique_ptr<io::MidiInputs> midi_;
  StreamOpener opener_;
  io::AudioFormat lost_format_;
  double rate_hz_ = 48000;  ///< of the engine
  bool is_lost_ = false, is_leaving_ = false, wants_restart_ = false;
  std::int64_t hangs_since_ns_ = 0;  ///< 0: nothing hangs
  std::string lost_reason_;
  std::int64_t next_try_ns_ = 0;
  std::vector<io::MidiPortStatus> ports_;  ///< as they were told
  std::vector<std::string> senders_;       ///< connected to the stream's own port
  std::vector<std::string> unplugged_;     ///< told to be, and not connected again
  std::size_t notes_told_ = 0;
  std::vector<std::string> first_lines_;
  std::vector<float> mono_;  ///< of a single channel the other side
};

}  // namespace knotwave::synth
