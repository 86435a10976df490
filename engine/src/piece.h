// SPDX-License-Identifier: MIT
// A piece of a block: what events interrupt. An event brings up to its sample only the voices that
// read what it changes; the others are rendered in one go when the piece ends. The samples are the
// same, since any split of a voice gives the same bits.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "knotwave/engine/engine.h"

#include "channel_bus.h"
#include "performance.h"
#include "workers.h"

namespace knotwave::engine {

/// All [audio] but the constructor and set_workers().
class Piece final : public VoiceUpkeep {
 public:
  /// The longest piece, in samples.
  static constexpr std::size_t kFrames = 256;

  Piece(const EngineConfig& config, Performance& performance);  ///< [control]
  void set_workers(std::unique_ptr<Workers> workers) { workers_ = std::move(workers); }

  /// Empty, from engine time 0.
  void reset() KNOTWAVE_RT;
  std::int64_t first() const KNOTWAVE_RT { return first_; }  ///< engine time it begins at
  std::int64_t now() const KNOTWAVE_RT { return first_ + static_cast<std::int64_t>(frames_); }
  /// Samples a longer piece would hold.
  std::size_t room() const KNOTWAVE_RT { return kFrames - frames_; }
  /// Makes it longer: what is played from here on is heard from there on.
  void extend(std::size_t frames) KNOTWAVE_RT { frames_ += frames; }

  /// An event at now(). Nothing it changes is left for samples before it to read.
  void play(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  /// Notes whose time has come go over to a new bank, at now().
  void carry_group_over() KNOTWAVE_RT;
  /// The samples, [its length] each; the next piece begins at now(). Stems as Engine::process().
  void close(std::span<float> left, std::span<float> right, std::span<const Engine::Stem> stems,
             std::size_t offset) KNOTWAVE_RT;

  void bring(int voice) KNOTWAVE_RT override;
  void add(int voice) KNOTWAVE_RT override;

 private:
  std::span<float> side_of(std::vector<float>& side, int voice) KNOTWAVE_RT {
    return std::span(side).subspan(static_cast<std::size_t>(voice) * kFrames, frames_);
  }
  void open() KNOTWAVE_RT;
  void free_ended() KNOTWAVE_RT;
  void prepare(const Performance::Reach& reach) KNOTWAVE_RT;
  void follow_buses() KNOTWAVE_RT;
  void render(int voice, VoiceScratch& scratch) KNOTWAVE_RT;
  void silence(int voice) KNOTWAVE_RT;
  void render_all() KNOTWAVE_RT;
  void render_share(int thread) KNOTWAVE_RT;
  void mix_bus(int bus) KNOTWAVE_RT;

  Performance& performance_;
  const double volume_lin_;
  std::unique_ptr<Workers> workers_;  ///< none: one thread renders all
  std::vector<VoiceScratch> scratches_;
  std::array<ChannelBus, kChannels> buses_;
  std::array<bool, kChannels> bus_sounds_{};
  std::uint32_t buses_used_ = 0;                     ///< bit c: by a voice of the piece
  std::array<std::size_t, kChannels> bus_frames_{};  ///< mixed so far
  std::vector<float> voice_left_, voice_right_;      ///< [voices][kFrames]
  std::vector<std::size_t> voice_frames_;            ///< rendered so far
  std::vector<int> voice_bus_;                       ///< what they are mixed into
  std::vector<int> voices_;                          ///< that sound in it, in order
  bool is_open_ = false;  ///< voices_ holds those that sounded at its first sample
  std::int64_t first_ = 0;
  std::size_t frames_ = 0;
  int sharing_ = 1;  ///< threads that take part
};

}  // namespace knotwave::engine
