// SPDX-License-Identifier: MIT
#include "take/take_player.h"

#include <algorithm>
#include <utility>

#include "take/take.h"

namespace knotwave::take {

Result<std::unique_ptr<TakePlayer>> TakePlayer::create(const engine::Journal& journal,
                                                       int threads) {
  if (journal.banks.empty()) return fail(ErrorCode::missing_key, "the journal holds no bank");
  std::unique_ptr<TakePlayer> player(new TakePlayer(journal));
  const auto first = player->compile(0);
  if (!first) return first.error();
  auto engine = engine::Engine::create({.rate_hz = journal.rate_hz,
                                        .max_voices = journal.max_voices,
                                        .seed = journal.seed,
                                        .threads = threads,
                                        .volume_db = journal.volume_db},
                                       *first);
  if (!engine) return std::move(engine).error();
  player->engine_ = *std::move(engine);
  player->events_ = engine::journal_events(journal);
  return player;
}

// Anew each time, as the player's program did, even where the text is the same.
Result<const engine::BankProgram*> TakePlayer::compile(std::uint32_t index) {
  auto input = read_kept(journal_.banks[index]);
  if (!input) return std::move(input).error();
  for (auto& warning : input->warnings) {
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) {
      warnings_.push_back(std::move(warning));
    }
  }
  banks_.push_back(std::move(input->program));
  return banks_.back().get();
}

void TakePlayer::free_banks() {
  std::erase_if(banks_, [this](const auto& bank) { return !engine_->is_playing(bank.get()); });
}

Result<void> TakePlayer::play(std::span<float> left, std::span<float> right) {
  const std::int64_t end = now() + static_cast<std::int64_t>(left.size());
  const std::size_t first = next_;
  for (; next_ < events_.size() && events_[next_].time().sample < end; ++next_) {
    if (events_[next_].kind != engine::Event::Kind::install_bank) continue;
    const auto program = compile(journal_.records[next_].index);
    if (!program) return program.error();
    events_[next_].bank = *program;
  }
  engine_->process(std::span(events_).subspan(first, next_ - first), left, right);
  if (banks_.size() > 1) free_banks();
  return {};
}

}  // namespace knotwave::take
