// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_sender.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_queue.h"
#include "knotwave/io/sleeper.h"

namespace knotwave::io {
namespace {

constexpr std::int64_t kTryAgainNs = 500'000'000;
constexpr std::int64_t kLongestSleepNs = 100'000'000;
constexpr std::chrono::milliseconds kThreadEndsWithin{150};
constexpr int kPriority = 20;        // above JACK's own threads by default, 5 to 10
constexpr int kMostInOneTurn = 256;  // of a port, before the next one has its turn

struct Port {
  Port(MidiOutputConfig config_, const MidiSenderConfig& sender)
      : config(std::move(config_)), queue(sender.waiting, sender.waiting_sysex_bytes) {
    config.lateness = lateness;
  }

  std::shared_ptr<Lateness> lateness = std::make_shared<Lateness>();
  MidiOutputConfig config;
  MidiQueue queue;
  std::atomic<std::int64_t> sent{0}, dropped{0};
  std::atomic<bool> has_failed{false};

  /// Held by the thread while it sends, by poll() while it puts another output here.
  std::mutex mutex;
  std::unique_ptr<MidiOutput> output;

  // Of the control thread:
  std::string api, name, fault;
  std::int64_t reopened = 0, next_try_ns = 0;
};

/// Sends what is due. Returns when to come again, `idle_ns` where nothing waits.
std::int64_t serve(Port& port, std::int64_t idle_ns) {
  const std::lock_guard lock(port.mutex);
  MidiOutput* const output = port.output.get();
  const bool is_timed = output != nullptr && output->is_timed();
  for (int i = 0; i < kMostInOneTurn; ++i) {
    const MidiQueue::Message* const message = port.queue.front();
    const std::int64_t now_ns = steady_clock_ns();
    if (message == nullptr) return idle_ns;
    if (!is_timed && message->due_ns > now_ns) return message->due_ns;
    bool is_sent = false;
    if (is_timed) {
      is_sent = output->send_at(message->event, message->due_ns);
      if (!is_sent) return now_ns + MidiSender::kWakeNs;
    } else if (output != nullptr) {
      port.lateness->add(now_ns - message->due_ns);
      const auto done = output->send(message->bytes);
      is_sent = done.has_value();
      if (!is_sent && done.error().code == ErrorCode::io_failed) port.has_failed = true;
    }
    (is_sent ? port.sent : port.dropped).fetch_add(1, std::memory_order_relaxed);
    port.queue.drop_front();
  }
  return 0;
}

}  // namespace

struct MidiSender::State {
  std::function<Result<std::unique_ptr<MidiOutput>>(const MidiOutputConfig&)> open;
  std::vector<std::unique_ptr<Port>> ports;
  bool is_woken = false;
  Sleeper sleeper;
  std::thread thread;
  std::atomic<bool> must_end{false};
  std::mutex mutex;
  std::condition_variable changed;
  bool has_begun = false, has_ended = false;
  std::string why_not_realtime;  ///< written before has_begun

  void run();
  void be_realtime();
  Result<void> try_open(Port& port);
};

void MidiSender::State::be_realtime() {
  ::prctl(PR_SET_TIMERSLACK, 1UL);  // else ordinary threads are woken 50 us late
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  const int fault = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  if (fault != 0) {
    why_not_realtime = std::generic_category().message(fault) +
                       ": let your user have rtprio 20 or more in /etc/security/limits.conf";
  }
}

void MidiSender::State::run() {
  be_realtime();
  {
    const std::lock_guard lock(mutex);
    has_begun = true;
    changed.notify_all();
  }
  while (!must_end.load(std::memory_order_relaxed)) {
    const std::int64_t idle_ns = steady_clock_ns() + (is_woken ? kLongestSleepNs : kWakeNs);
    std::int64_t next_ns = idle_ns;
    for (const auto& port : ports) next_ns = std::min(next_ns, serve(*port, idle_ns));
    sleeper.sleep_until(next_ns);
  }
  const std::lock_guard lock(mutex);
  has_ended = true;
  changed.notify_all();
}

Result<void> MidiSender::State::try_open(Port& port) {
  auto output = open(port.config);
  if (!output) {
    port.fault = output.error().message;
    return output.error();
  }
  port.api = (*output)->api();
  port.name = (*output)->name();
  port.fault.clear();
  port.has_failed = false;
  const std::lock_guard lock(port.mutex);
  port.output = std::move(*output);
  return {};
}

MidiSender::MidiSender(std::shared_ptr<State> state) : state_(std::move(state)) {}

Result<std::unique_ptr<MidiSender>> MidiSender::open(MidiSenderConfig config) {
  auto state = std::make_shared<State>();
  state->open = config.open;
  state->is_woken = config.is_woken;
  for (MidiOutputConfig& port : config.ports) {
    state->ports.push_back(std::make_unique<Port>(std::move(port), config));
    if (const auto opened = state->try_open(*state->ports.back()); !opened) return opened.error();
  }
  try {
    state->thread = std::thread([state] { state->run(); });
  } catch (const std::system_error& error) {
    return fail(ErrorCode::io_failed, std::string("no thread to send MIDI with: ") + error.what());
  }
  std::unique_lock lock(state->mutex);
  state->changed.wait(lock, [&] { return state->has_begun; });
  return std::unique_ptr<MidiSender>(new MidiSender(state));
}

MidiSender::~MidiSender() {
  state_->must_end = true;
  wake();
  std::unique_lock lock(state_->mutex);
  const bool has_ended =
      state_->changed.wait_for(lock, kThreadEndsWithin, [this] { return state_->has_ended; });
  lock.unlock();
  if (has_ended) {
    state_->thread.join();
  } else {
    state_->thread.detach();  // what it hangs in stays with it
  }
}

bool MidiSender::push(int port, const base::MidiEvent& event, std::int64_t due_ns) KNOTWAVE_RT {
  if (port < 0 || static_cast<std::size_t>(port) >= state_->ports.size()) return false;
  Port& to = *state_->ports[static_cast<std::size_t>(port)];
  if (to.queue.push(event, due_ns)) return true;
  to.dropped.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void MidiSender::wake() noexcept { state_->sleeper.wake(); }

// All that has gone is closed first: while a client of a dead server is open, none can be opened.
bool MidiSender::poll() {
  bool has_changed = false;
  for (const auto& port : state_->ports) {
    if (!port->output || (!port->has_failed && port->output->exists())) continue;
    std::unique_ptr<MidiOutput> gone;
    if (std::unique_lock lock(port->mutex, std::try_to_lock); lock) gone = std::move(port->output);
    if (!gone) continue;  // the thread hangs in it
    gone.reset();
    port->fault = "it has gone";
    port->next_try_ns = steady_clock_ns() + kTryAgainNs;
    has_changed = true;
  }
  for (const auto& port : state_->ports) {
    if (port->output || steady_clock_ns() < port->next_try_ns) continue;
    if (state_->try_open(*port)) {
      ++port->reopened;
      has_changed = true;
    }
    port->next_try_ns = steady_clock_ns() + kTryAgainNs;
  }
  return has_changed;
}

std::vector<MidiSenderPort> MidiSender::ports() const {
  std::vector<MidiSenderPort> all;
  for (const auto& port : state_->ports) {
    MidiSenderPort& shown = all.emplace_back();
    shown.api = port->api;
    shown.name = port->name;
    shown.is_open = port->output != nullptr;
    shown.fault = port->fault;
    shown.sent = port->sent.load(std::memory_order_relaxed);
    shown.dropped = port->dropped.load(std::memory_order_relaxed);
    shown.reopened = port->reopened;
    shown.lateness = port->lateness->figures();
  }
  return all;
}

bool MidiSender::is_done() const {
  return std::all_of(state_->ports.begin(), state_->ports.end(), [](const auto& port) {
    return port->queue.is_empty() && (port->output == nullptr || port->output->is_done());
  });
}

std::string MidiSender::why_not_realtime() const { return state_->why_not_realtime; }

}  // namespace knotwave::io
