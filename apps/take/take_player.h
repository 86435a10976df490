// SPDX-License-Identifier: MIT
// Plays a journal again, from engine time 0.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "knotwave/engine/engine.h"
#include "knotwave/engine/journal.h"

namespace knotwave::take {

/// Banks are compiled when they are due and freed when they sound no more.
class TakePlayer {
 public:
  /// `journal` must outlive it. Errors: those of Engine::create() and read_kept(); missing_key (a
  /// journal without a bank).
  static Result<std::unique_ptr<TakePlayer>> create(const engine::Journal& journal, int threads);

  std::int64_t now() const { return engine_->now(); }
  const engine::EngineCounters& counters() const { return engine_->counters(); }
  const std::vector<std::string>& warnings() const { return warnings_; }  ///< of the banks
  /// The next samples. Errors: those of read_kept().
  Result<void> play(std::span<float> left, std::span<float> right);

 private:
  explicit TakePlayer(const engine::Journal& journal) : journal_(journal) {}
  Result<const engine::BankProgram*> compile(std::uint32_t index);
  void free_banks();

  const engine::Journal& journal_;
  std::vector<std::unique_ptr<const engine::BankProgram>> banks_;  ///< those that may sound
  std::unique_ptr<engine::Engine> engine_;
  std::vector<engine::Event> events_;
  std::size_t next_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace knotwave::take
