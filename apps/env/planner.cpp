// SPDX-License-Identifier: MIT
#include "planner.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <pthread.h>
#include <sched.h>

#include "knotwave/io/audio_device.h"

namespace knotwave::env {
namespace {

constexpr std::int64_t kStepNs = 500'000;
constexpr std::int64_t kStillStepNs = 10'000'000;  // what is caught up when a note comes
constexpr std::int64_t kShowNs = 250'000'000;
constexpr std::int64_t kStallNs = 200'000'000;
constexpr std::size_t kMostKept = 1 << 20;  // 5 minutes of a MIDI cable
constexpr int kPriority = 15;               // below the sender's

// 6 samples of 48 kHz are 125 us.
constexpr std::int64_t kPeriodNs = 125'000, kPeriodSamples = 6;
static_assert(kClockHz * kPeriodNs == kPeriodSamples * std::int64_t{1'000'000'000});

}  // namespace

base::SampleTime sample_time(std::int64_t time_ns, std::int64_t begin_ns) KNOTWAVE_RT {
  const std::int64_t passed = std::max<std::int64_t>(time_ns - begin_ns, 0);
  const auto rest = static_cast<std::uint64_t>(passed % kPeriodNs * kPeriodSamples);
  base::SampleTime time;
  time.sample = passed / kPeriodNs * kPeriodSamples + static_cast<std::int64_t>(rest / kPeriodNs);
  time.fraction = static_cast<std::uint32_t>((rest % kPeriodNs << 32) / kPeriodNs);
  return time;
}

std::int64_t steady_time(base::SampleTime time, std::int64_t begin_ns) KNOTWAVE_RT {
  const std::int64_t periods = time.sample / kPeriodSamples, rest = time.sample % kPeriodSamples;
  const auto fraction =
      static_cast<std::int64_t>((std::uint64_t{time.fraction} * kPeriodNs / kPeriodSamples) >> 32);
  return begin_ns + periods * kPeriodNs + rest * kPeriodNs / kPeriodSamples + fraction;
}

Planner::Planner(const Config& config, engine::EnvelopeGenerator& generator, io::MidiSender& sender,
                 io::OscOutput* osc, PlannerListener* listener, SentNames names)
    : config_(config),
      generator_(generator),
      sender_(sender),
      osc_(osc),
      listener_(listener),
      names_(std::move(names)),
      kept_(kMostKept),
      begin_ns_(io::steady_clock_ns()),
      stepped_ns_(begin_ns_) {}

Planner::~Planner() {
  must_end_ = true;
  sleeper_.wake();
  if (thread_.joinable()) thread_.join();
}

void Planner::start() {
  thread_ = std::thread([this] { run(); });
}

void Planner::message(const base::MidiEvent& event, std::int64_t time_ns) noexcept {
  Input& input = inputs_[event.port % inputs_.size()];
  input.notes.heard(event);
  if (!input.queue.push(event, time_ns)) dropped_in_.fetch_add(1, std::memory_order_relaxed);
  sleeper_.wake();
}

void Planner::port_lost(int port) noexcept {
  Input& input = inputs_[static_cast<std::size_t>(port) % inputs_.size()];
  input.notes.release([&](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    base::MidiEvent event;
    event.bytes[0] = status;
    event.bytes[1] = first;
    event.bytes[2] = second;
    event.port = static_cast<std::uint8_t>(port);
    input.queue.push(event, io::steady_clock_ns());
  });
  sleeper_.wake();
}

void Planner::run() {
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);  // the sender says if not
  std::int64_t next_ns = io::steady_clock_ns(), show_ns = next_ns;
  bool is_resting = false;
  while (!must_end_) {
    const std::int64_t now_ns = io::steady_clock_ns();
    step(now_ns);
    if (must_rest_ && !is_resting) {
      generator_.go_to_rest();
      is_resting = true;
    }
    if (is_resting && generator_.is_at_rest()) is_at_rest_ = true;
    if (now_ns >= show_ns) {
      if (const std::unique_lock lock(mutex_, std::try_to_lock); lock) {
        routes_ = generator_.routes();
      }
      show_ns = now_ns + kShowNs;
    }
    if (generator_.is_still()) {
      sleeper_.sleep_until(now_ns + kStillStepNs);
      next_ns = io::steady_clock_ns();
    } else {
      next_ns = std::max(next_ns + kStepNs, now_ns);
      io::sleep_through(next_ns);
    }
  }
}

/// All that was heard until now, of all inputs, in order; then the time that passed. While the
/// process was stopped none passed: what it would have sent would all go at once.
void Planner::step(std::int64_t now_ns) {
  const std::int64_t passed_ns = now_ns - std::exchange(stepped_ns_, now_ns);
  if (passed_ns > kStallNs) begin_ns_ += passed_ns;
  take_inputs(now_ns);
  const std::uint32_t again = again_ports_.exchange(0);
  for (int port = 0; again >> port != 0; ++port) {
    if ((again >> port & 1) != 0) generator_.say_again(port);
  }
  generator_.advance(sample_time(now_ns, begin_ns_).sample, *this);
  flush_osc();
  if (std::exchange(has_sent_, false)) sender_.wake();
}

void Planner::take_inputs(std::int64_t now_ns) {
  for (;;) {
    Input* first = nullptr;
    std::int64_t first_ns = now_ns;
    for (Input& input : inputs_) {
      const io::MidiQueue::Message* message = input.queue.front();
      if (message == nullptr || message->due_ns >= first_ns) continue;
      first = &input;
      first_ns = message->due_ns;
    }
    if (first == nullptr) return;
    base::MidiEvent event = first->queue.front()->event;
    event.time = sample_time(first_ns, begin_ns_);
    // What was stamped before the step that should have heard it is heard now.
    event.time = std::max(event.time, base::SampleTime{generator_.now(), 0});
    if (event.sysex != nullptr) keep_sysex(event);
    generator_.advance(event.time.sample, *this);
    generator_.handle(event);
    if (listener_ != nullptr) listener_->heard(event, first_ns);
    first->queue.drop_front();
  }
}

/// The generator refers to it until it is sent.
void Planner::keep_sysex(base::MidiEvent& event) {
  if (kept_end_ + event.sysex_size > kept_.size()) kept_end_ = 0;
  std::uint8_t* const to = kept_.data() + kept_end_;
  std::copy_n(event.sysex, event.sysex_size, to);
  event.sysex = to;
  kept_end_ += event.sysex_size;
}

void Planner::show(const Shown& shown) noexcept {
  if (config_.monitor) shown_.push(shown);  // what nobody reads in time is not shown
}

void Planner::midi(int port, const base::MidiEvent& event) KNOTWAVE_RT {
  has_sent_ = true;
  sender_.push(port, event, steady_time(event.time, begin_ns_) + config_.latency_ns);
  Shown shown{.time = event.time, .port = port};
  std::copy_n(event.bytes, 3, shown.bytes);
  show(shown);
}

void Planner::osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT {
  show({.time = time, .patch = patch, .output = output, .number = value});
  if (osc_ == nullptr) return;
  if (bundled_ > 0 && (time != bundle_time_ || bundled_ == bundle_.size())) flush_osc();
  const auto& address =
      names_.addresses[static_cast<std::size_t>(patch)][static_cast<std::size_t>(output)];
  bundle_time_ = time;
  bundle_[bundled_++] = {address, static_cast<float>(value)};
}

void Planner::flush_osc() noexcept {
  if (bundled_ == 0) return;
  osc_->send(std::span(bundle_).first(bundled_),
             steady_time(bundle_time_, begin_ns_) + config_.latency_ns);
  bundled_ = 0;
}

std::vector<engine::RouteStatus> Planner::routes() const {
  const std::lock_guard lock(mutex_);
  return routes_;
}

std::vector<Planner::Shown> Planner::take_shown() {
  std::vector<Shown> all;
  Shown shown;
  while (shown_.pop(shown)) all.push_back(shown);
  return all;
}

}  // namespace knotwave::env
