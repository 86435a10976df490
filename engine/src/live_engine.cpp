// SPDX-License-Identifier: MIT
// What the calls of the control thread do; blocks are in live_block.cpp.
#include "knotwave/engine/live_engine.h"

#include <algorithm>
#include <utility>

#include "knotwave/base/document.h"

#include "live_state.h"

namespace knotwave::engine {
namespace {

constexpr int kMostMessages = 1 << 20;
constexpr int kMostRecords = 1 << 24;
constexpr double kLongestTapSeconds = 60;

Result<void> check(const LiveConfig& config) {
  const auto outside = [](const char* what, double value, double low, double high) {
    return fail(ErrorCode::value_out_of_range,
                std::string(what) + " is " + base::number_text(value) + "; it must be in " +
                    base::number_text(low) + " to " + base::number_text(high));
  };
  if (config.input_messages < 1 || config.input_messages > kMostMessages)
    return outside("an input's room for messages", config.input_messages, 1, kMostMessages);
  if (config.journal_records < 1 || config.journal_records > kMostRecords)
    return outside("the journal's room for records", config.journal_records, 1, kMostRecords);
  if (!(config.tap_s >= 0 && config.tap_s <= kLongestTapSeconds))
    return outside("the tap's room in seconds", config.tap_s, 0, kLongestTapSeconds);
  return {};
}

bool is_same(const JournalBank& a, const JournalBank& b) {
  return a.path == b.path &&
         std::equal(a.files.begin(), a.files.end(), b.files.begin(), b.files.end(),
                    [](const FileText& x, const FileText& y) {
                      return x.path == y.path && x.bytes == y.bytes;
                    }) &&
         std::equal(a.sounds.begin(), a.sounds.end(), b.sounds.begin(), b.sounds.end(),
                    [](const JournalBank::Sound& x, const JournalBank::Sound& y) {
                      return x.path == y.path && x.sha256 == y.sha256;
                    });
}

std::uint32_t index_in(Journal& journal, JournalBank bank) {
  const auto known = std::find_if(journal.banks.begin(), journal.banks.end(),
                                  [&](const JournalBank& other) { return is_same(other, bank); });
  if (known != journal.banks.end()) {
    return static_cast<std::uint32_t>(known - journal.banks.begin());
  }
  journal.banks.push_back(std::move(bank));
  return static_cast<std::uint32_t>(journal.banks.size() - 1);
}

}  // namespace

LiveEngine::State::State(const LiveConfig& live_config)
    : config(live_config),
      clock(config.engine.rate_hz),
      journal(static_cast<std::size_t>(config.journal_records)),
      tap(static_cast<std::size_t>(config.tap_s * config.engine.rate_hz)),
      events(kEventsAtOnce),
      sysex(kEventsAtOnce),
      ended(2 * Engine::kMostNotesAtOnce) {
  for (auto& input : inputs) input = std::make_unique<LiveInput>(config.input_messages);
}

LiveEngine::State::~State() {
  engine.reset();
  for (int i = 0; i < outgoing_count; ++i) banks.release(outgoing[static_cast<std::size_t>(i)]);
  if (playing != nullptr) banks.release(playing);
}

LiveEngine::LiveEngine(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveEngine::~LiveEngine() = default;

std::span<const EndedNote> LiveEngine::ended_notes() const KNOTWAVE_RT {
  return std::span(state_->ended).first(state_->ended_count);
}
bool LiveEngine::is_idle() const KNOTWAVE_RT { return state_->engine->is_idle(); }
double LiveEngine::rate_hz() const KNOTWAVE_RT { return state_->config.engine.rate_hz; }

Result<std::unique_ptr<LiveEngine>> LiveEngine::create(const LiveConfig& config,
                                                       std::unique_ptr<const BankProgram> bank,
                                                       JournalBank source) {
  if (auto ok = check(config); !ok) return ok.error();
  auto engine = Engine::create(config.engine, bank.get());
  if (!engine) return std::move(engine).error();
  auto state = std::make_unique<State>(config);
  state->engine = std::move(engine).value();
  state->sources.emplace(0, std::move(source));
  state->banks.publish(std::make_unique<const LiveBank>(LiveBank{std::move(bank), 0}));
  state->playing = state->banks.acquire();
  state->published.publish(state->status);
  return std::unique_ptr<LiveEngine>(new LiveEngine(std::move(state)));
}

bool LiveEngine::push(int input, const LiveMessage& message) KNOTWAVE_RT {
  if (input < 0 || input >= kLiveInputs) return false;
  return state_->inputs[static_cast<std::size_t>(input)]->push(message);
}

void LiveEngine::panic() KNOTWAVE_RT { state_->panic.store(true, std::memory_order_relaxed); }

void LiveEngine::fade(float gain_lin, float seconds) KNOTWAVE_RT {
  state_->fade.set(gain_lin, seconds);
}

bool LiveEngine::install(std::unique_ptr<const BankProgram> bank, JournalBank source) {
  if (bank == nullptr) return true;
  State& s = *state_;
  s.sources.emplace(++s.last_number, std::move(source));
  return s.banks.publish(
      std::make_unique<const LiveBank>(LiveBank{std::move(bank), s.last_number}));
}

void LiveEngine::collect() { state_->banks.collect(); }

LiveStatus LiveEngine::status() {
  State& s = *state_;
  LiveStatus status = s.published.read();
  status.peak_left = s.peak_left.take();
  status.peak_right = s.peak_right.take();
  for (const auto& input : s.inputs) status.messages_dropped += input->dropped();
  return status;
}

void LiveEngine::take_journal(Journal& journal) {
  State& s = *state_;
  const EngineConfig& engine = s.config.engine;
  journal.rate_hz = engine.rate_hz;
  journal.max_voices = engine.max_voices;
  journal.seed = engine.seed;
  journal.volume_db = engine.volume_db;
  const auto add_bank = [&](std::uint32_t number) {
    const auto found = s.sources.find(number);
    const std::uint32_t index =
        index_in(journal, found == s.sources.end() ? JournalBank{} : std::move(found->second));
    s.sources.erase(s.sources.begin(), s.sources.upper_bound(number));
    return index;
  };
  if (s.sources.contains(0)) add_bank(0);
  JournalRecord record;
  while (s.journal.pop(record)) {
    if (record.kind == Event::Kind::install_bank) record.index = add_bank(record.index);
    journal.records.push_back(record);
  }
}

void LiveEngine::set_tap(bool on) { state_->tap.set_on(on); }

LiveEngine::Tap LiveEngine::take_tap(std::span<float> interleaved) {
  return state_->tap.read(interleaved);
}

void LiveEngine::process(std::int64_t time_ns, std::span<const Event> exact, std::span<float> left,
                         std::span<float> right) KNOTWAVE_RT {
  const std::size_t frames = std::min(left.size(), right.size());
  if (frames > 0) state_->process(time_ns, exact, left.first(frames), right.first(frames));
}

}  // namespace knotwave::engine
