// SPDX-License-Identifier: MIT
// A MIDI output as a client of JACK: messages are placed at their frames.
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <vector>

#include <jack/jack.h>
#include <jack/midiport.h>

#include "knotwave/io/midi_queue.h"

#include "complete_midi.h"
#include "jack_cycle.h"
#include "jack_devices.h"
#include "library_silence.h"
#include "midi_backend.h"
#include "midi_placement.h"
#include "patient_call.h"
#include "rtmidi_port.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::milliseconds kServerAnswersWithin{1000};
constexpr std::chrono::milliseconds kClosesWithin{800};
constexpr std::size_t kMostMessages = 4096;
constexpr std::size_t kMostSysexBytes = 65536;

/// The client's part in the graph; its address is what JACK calls back with.
class JackMidiGraph {
 public:
  explicit JackMidiGraph(std::shared_ptr<Lateness> lateness) : lateness_(std::move(lateness)) {}

  Result<void> enter(const MidiOutputConfig& config);

  MidiQueue& queue() noexcept { return queue_; }
  /// The cycle of the last message is over, so whoever is connected has it.
  bool is_done() const noexcept { return queue_.is_empty() && has_rested_; }
  bool is_alive() const noexcept { return !has_gone_ && !JackTicket::has_server_gone(); }
  /// What its messages go to, or our own port. Valid after enter().
  const std::string& name() const noexcept { return name_; }
  const std::string& own_name() const noexcept { return own_name_; }
  bool has(const std::string& port) const {
    return jack_port_by_name(client_.get(), port.c_str()) != nullptr;
  }

 private:
  int process(jack_nframes_t frames) KNOTWAVE_RT;
  bool place(void* buffer, const MidiQueue::Message& message) KNOTWAVE_RT;
  void set_callbacks();
  Result<void> connect(const MidiOutputConfig& config);

  std::shared_ptr<Lateness> lateness_;
  MidiQueue queue_{kMostMessages, kMostSysexBytes};
  CycleClock clock_;
  MidiPlacement placement_;
  jack_port_t* port_ = nullptr;
  std::string name_, own_name_;
  std::atomic<bool> has_gone_{false};
  std::atomic<bool> has_rested_{true};  ///< the last cycle began with nothing to send
  JackClient client_;  ///< the last member: closed before what its callbacks use goes
};

Result<void> JackMidiGraph::enter(const MidiOutputConfig& config) {
  std::string why;
  client_ = JackClient::open(config.client_name, why);
  if (!client_) return fail(ErrorCode::unsupported, why);
  port_ = jack_port_register(client_.get(), config.own_name.c_str(), JACK_DEFAULT_MIDI_TYPE,
                             JackPortIsOutput, 0);
  if (port_ == nullptr) return fail(ErrorCode::io_failed, "the JACK server has no ports left");
  name_ = own_name_ = jack_port_name(port_);
  set_callbacks();
  if (jack_activate(client_.get()) != 0) {
    return fail(ErrorCode::io_failed, "the JACK server does not let us in");
  }
  return config.port.empty() ? Result<void>() : connect(config);
}

void JackMidiGraph::set_callbacks() {
  jack_set_process_callback(
      client_.get(),
      [](jack_nframes_t frames, void* us) {
        return static_cast<JackMidiGraph*>(us)->process(frames);
      },
      this);
  jack_on_shutdown(
      client_.get(),
      [](void* us) {
        static_cast<JackMidiGraph*>(us)->has_gone_ = true;
        JackTicket::server_has_gone();
      },
      this);
}

Result<void> JackMidiGraph::connect(const MidiOutputConfig& config) {
  const char** const sinks =
      jack_get_ports(client_.get(), nullptr, JACK_DEFAULT_MIDI_TYPE, JackPortIsInput);
  std::vector<std::string> names;
  for (const char* const* name = sinks; name != nullptr && *name != nullptr; ++name) {
    names.emplace_back(*name);
  }
  jack_free(sinks);
  auto name = one_output("jack", names, config.port);
  if (!name) return name.error();
  name_ = std::move(*name);
  const int fault = jack_connect(client_.get(), own_name_.c_str(), name_.c_str());
  if (fault == 0 || fault == EEXIST) return {};
  return fail(ErrorCode::io_failed, "JACK does not connect " + own_name_ + " to " + name_);
}

int JackMidiGraph::process(jack_nframes_t frames) KNOTWAVE_RT {
  void* const buffer = jack_port_get_buffer(port_, frames);
  jack_midi_clear_buffer(buffer);
  has_rested_ = queue_.is_empty();
  follow_cycle(client_.get(), frames, clock_);
  placement_.advance(clock_.frame(), clock_.time_ns(), frames);
  while (const MidiQueue::Message* message = queue_.front()) {
    if (!placement_.is_due(message->due_ns) || !place(buffer, *message)) break;
    queue_.drop_front();
  }
  return 0;
}

/// False: the buffer is full, the rest waits for the next cycle. What an empty buffer does not hold
/// no buffer will.
bool JackMidiGraph::place(void* buffer, const MidiQueue::Message& message) KNOTWAVE_RT {
  const auto offset = static_cast<jack_nframes_t>(placement_.offset(message.due_ns));
  jack_midi_data_t* const to = jack_midi_event_reserve(buffer, offset, message.bytes.size());
  if (to == nullptr) return jack_midi_get_event_count(buffer) == 0;
  std::memcpy(to, message.bytes.data(), message.bytes.size());
  if (lateness_) lateness_->add(placement_.late_ns(message.due_ns));
  return true;
}

using Graph = std::shared_ptr<JackMidiGraph>;

/// Clients that could not be closed while the server hung; the next call that gets through does it,
/// or they would keep everyone from a server that comes after.
class LeftBehind {
 public:
  void add(Graph graph) {
    const std::lock_guard lock(mutex_);
    graphs_.push_back(std::move(graph));
  }
  void close() {
    for (;;) {
      std::vector<Graph> graphs;
      const std::unique_lock lock(mutex_);
      graphs.swap(graphs_);
      if (graphs.empty()) return;
    }
  }

 private:
  std::mutex mutex_;
  std::vector<Graph> graphs_;
};

LeftBehind& left_behind() {
  static auto* const graphs = new LeftBehind;  // outlives calls that hang
  return *graphs;
}

class JackMidiOutput : public MidiOutput {
 public:
  explicit JackMidiOutput(Graph graph)
      : graph_(std::move(graph)), own_("jack", graph_->own_name()), name_(graph_->name()) {}
  // Whoever is refused leaves its client to the call that hangs: that closes all when it goes on.
  ~JackMidiOutput() override {
    left_behind().add(std::move(graph_));
    jack_calls().run(kClosesWithin, [] { left_behind().close(); });
  }
  JackMidiOutput(const JackMidiOutput&) = delete;
  JackMidiOutput& operator=(const JackMidiOutput&) = delete;

  Result<void> send(std::span<const std::uint8_t> message) override {
    base::MidiEvent event;
    if (message.size() > kLongestMidi) return too_long(message.size());
    if (!read_complete_midi(message, event)) return no_message();
    if (!graph_->is_alive()) return fail(ErrorCode::io_failed, "the JACK server has gone");
    if (send_at(event, steady_clock_ns())) return {};
    return fail(ErrorCode::io_failed, "the JACK server does not take what is sent");
  }
  bool is_timed() const noexcept override { return true; }
  bool send_at(const base::MidiEvent& event, std::int64_t due_ns) KNOTWAVE_RT override {
    return graph_->queue().push(event, due_ns);
  }
  bool is_done() const noexcept override { return graph_->is_done(); }
  bool exists() override { return graph_->is_alive() && graph_->has(name_); }
  const std::string& api() const override { return api_; }
  const std::string& name() const override { return name_; }

 private:
  Graph graph_;
  OwnOutput own_;
  std::string api_ = "jack", name_;
};

struct Attempt {
  Graph graph;
  Result<void> outcome;
};

}  // namespace

Result<std::unique_ptr<MidiOutput>> open_jack_midi_output(const MidiOutputConfig& config) {
  silence_jack();
  const auto attempt = std::make_shared<Attempt>();
  attempt->graph = std::make_shared<JackMidiGraph>(config.lateness);
  const auto call = jack_calls().run(kServerAnswersWithin, [attempt, config] {
    left_behind().close();
    attempt->outcome = attempt->graph->enter(config);
    if (!attempt->outcome) attempt->graph.reset();
  });
  if (call != PatientCall::Outcome::done) {
    return fail(ErrorCode::unsupported, "the server does not answer");
  }
  if (!attempt->outcome) return attempt->outcome.error();
  return std::unique_ptr<MidiOutput>(new JackMidiOutput(std::move(attempt->graph)));
}

}  // namespace knotwave::io
