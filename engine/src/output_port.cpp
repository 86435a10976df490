// SPDX-License-Identifier: MIT
// Which of what waits goes out next.
#include "knotwave/engine/output_port.h"

#include <tuple>
#include <utility>
#include <vector>

#include "cable.h"
#include "lane_curve.h"
#include "note_admission.h"
#include "output_lane.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;
using base::MidiStatus;

/// A controller that waits for longer goes before the next bend or pressure, so that one which runs
/// faster than the cable does not keep it from ever being sent.
constexpr double kPatienceSeconds = 0.01;
constexpr int kSlack = 3;  ///< samples that a parabola reaches ahead, and one for rounding up

struct Waiting {
  MidiEvent event;
  OutputPriority priority = OutputPriority::note;
  bool is_thru = false;
};

/// A ring of messages in the order in which they came.
class Queue {
 public:
  Queue() : ring_(OutputPort::kMostWaiting + OutputPort::kEndings + OutputPort::kNoteOffs) {}
  std::size_t size() const KNOTWAVE_RT { return size_; }
  const Waiting& operator[](std::size_t i) const KNOTWAVE_RT {
    return ring_[(begin_ + i) % ring_.size()];
  }
  void push(const Waiting& waiting) KNOTWAVE_RT {
    ring_[(begin_ + size_++) % ring_.size()] = waiting;
  }
  Waiting pop() KNOTWAVE_RT {
    const Waiting waiting = ring_[begin_];
    begin_ = (begin_ + 1) % ring_.size();
    --size_;
    return waiting;
  }

 private:
  std::vector<Waiting> ring_;
  std::size_t begin_ = 0, size_ = 0;
};

/// What can be sent next: whatever is ready first, then by priority, then what waits longest.
struct Candidate {
  enum class Kind : std::uint8_t { none, clock, message, rest_of_group, lane, nrpn_null };
  Kind kind = Kind::none;
  int rank = 0;   ///< of priority
  int index = 0;  ///< a lane, a channel
  Ticks ready = kNever;
  Ticks since = 0;  ///< it waits since then

  bool goes_before(const Candidate& other) const KNOTWAVE_RT {
    return std::tie(ready, rank, since) < std::tie(other.ready, other.rank, other.since);
  }
};

int rank_of(OutputPriority priority) {
  switch (priority) {
    case OutputPriority::clock:
      return 0;
    case OutputPriority::note:
      return 1;
    case OutputPriority::expression:
      return 4;
    case OutputPriority::control:
      return 5;
  }
  return 5;
}
constexpr int kRestOfGroupRank = 2, kImpatientRank = 3;

bool is_control_change(const MidiEvent& event) {
  return event.status() == MidiStatus::control_change;
}

}  // namespace

struct OutputPort::State {
  explicit State(const OutputPortConfig& config)
      : cable(config),
        rate_hz(config.rate_hz),
        patience(static_cast<Ticks>(kPatienceSeconds * config.rate_hz * 0x1p20)) {
    lanes.reserve(kMostLanes);
    lane_bytes.reserve(kMostLanes);
  }

  void begin_block(std::int64_t first, std::size_t n,
                   std::span<const LaneValues> values) KNOTWAVE_RT;
  Candidate next(Ticks now) KNOTWAVE_RT;
  void offer(Candidate& best, const Candidate& other, Ticks now) const KNOTWAVE_RT;
  Candidate message_candidate(Ticks now) const KNOTWAVE_RT;
  bool send(const Candidate& candidate, PortSink& sink) KNOTWAVE_RT;
  void send_posted(Queue& queue, Ticks time, PortSink& sink) KNOTWAVE_RT;
  bool send_lane(int index, Ticks time, PortSink& sink) KNOTWAVE_RT;
  void start_group(const MessageGroup& group, int lane, Ticks time, PortSink& sink) KNOTWAVE_RT;
  void send_group_message(Ticks time, PortSink& sink) KNOTWAVE_RT;
  void notice(const MidiEvent& event, Ticks time) KNOTWAVE_RT;

  Cable cable;
  double rate_hz;
  Ticks patience;
  std::size_t ahead = 0;
  std::vector<OutputLane> lanes;
  std::vector<std::int64_t> lane_bytes;
  Selections selections;
  Queue clocks, messages;
  NoteAdmission admission;
  std::int64_t waiting_thru_bytes = 0;
  // A group on its way.
  MessageGroup group;
  int group_sent = 0, group_lane = -1;
  Ticks decided = 0;                  ///< nothing is begun before the last decision
  Ticks until = 0;                    ///< values are known up to here
  bool expression_went_last = false;  ///< of lanes and controllers
  bool must_say_again = false;
};

void OutputPort::State::begin_block(std::int64_t first, std::size_t n,
                                    std::span<const LaneValues> values) KNOTWAVE_RT {
  until = sample_ticks(first + static_cast<std::int64_t>(n + ahead) - kSlack);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    lanes[i].begin_block(first, i < values.size() ? values[i] : LaneValues{}, until);
  }
  const bool all = std::exchange(must_say_again, false);
  if (all) selections = {};
  const Ticks now = sample_ticks(first);
  for (OutputLane& lane : lanes) {
    if (!lane.must_say_again() && !all) continue;
    lane.forget(now - 1, std::max(now, cable.free_at()), until);
  }
}

void OutputPort::State::offer(Candidate& best, const Candidate& other,
                              Ticks now) const KNOTWAVE_RT {
  if (other.kind == Candidate::Kind::none || other.ready == kNever) return;
  Candidate offered = other;
  offered.ready = std::max({other.ready, now, cable.free_at()});
  const bool is_control = other.rank == rank_of(OutputPriority::control);
  if (is_control && expression_went_last && offered.ready - other.since >= patience) {
    offered.rank = kImpatientRank;
  }
  if (offered.goes_before(best)) best = offered;
}

/// The oldest posted message, with the priority of the most urgent one that waits behind it.
Candidate OutputPort::State::message_candidate(Ticks now) const KNOTWAVE_RT {
  if (messages.size() == 0) return {};
  const Ticks time = ticks_at_or_after(messages[0].event.time);
  const Ticks ready = std::max({time, now, cable.free_at()});
  int rank = rank_of(messages[0].priority);
  for (std::size_t i = 1; i < messages.size() && rank > 1; ++i) {
    if (ticks_at_or_after(messages[i].event.time) > ready) break;
    rank = std::min(rank, rank_of(messages[i].priority));
  }
  return {Candidate::Kind::message, rank, -1, time, time};
}

Candidate OutputPort::State::next(Ticks now) KNOTWAVE_RT {
  using Kind = Candidate::Kind;
  Candidate best;
  if (clocks.size() != 0) {
    const Ticks time = ticks_at_or_after(clocks[0].event.time);
    offer(best, {Kind::clock, 0, -1, time, time}, now);
  }
  const bool is_in_group = group_sent < group.count;
  if (!is_in_group || (messages.size() != 0 && !is_control_change(messages[0].event))) {
    offer(best, message_candidate(now), now);
  }
  if (is_in_group) {
    offer(best, {Kind::rest_of_group, kRestOfGroupRank, -1, cable.free_at(), 0}, now);
    return best;
  }
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const OutputLane& lane = lanes[i];
    if (lane.left_at() == kNever) continue;
    const int rank =
        rank_of(lane.is_expression() ? OutputPriority::expression : OutputPriority::control);
    offer(best,
          {Kind::lane, rank, static_cast<int>(i), lane.due(cable, selections), lane.left_at()},
          now);
  }
  for (std::size_t i = 0; i < selections.size(); ++i) {
    const Ticks time = selections[i].null_at;
    offer(best,
          {Kind::nrpn_null, rank_of(OutputPriority::control), static_cast<int>(i), time, time},
          now);
  }
  return best;
}

bool OutputPort::State::send(const Candidate& candidate, PortSink& sink) KNOTWAVE_RT {
  using Kind = Candidate::Kind;
  if (candidate.rank > kRestOfGroupRank && candidate.kind != Kind::lane) {
    expression_went_last = false;
  }
  switch (candidate.kind) {
    case Kind::clock:
      send_posted(clocks, candidate.ready, sink);
      return true;
    case Kind::message:
      send_posted(messages, candidate.ready, sink);
      return true;
    case Kind::rest_of_group:
      send_group_message(candidate.ready, sink);
      return true;
    case Kind::lane:
      return send_lane(candidate.index, candidate.ready, sink);
    case Kind::nrpn_null: {
      MessageGroup null;
      null.add(0xB0, candidate.index + 1, 101, 127);
      null.add(0xB0, candidate.index + 1, 100, 127);
      selections[static_cast<std::size_t>(candidate.index)] = {};
      start_group(null, -1, candidate.ready, sink);
      return true;
    }
    case Kind::none:
      break;
  }
  return true;
}

void OutputPort::State::send_posted(Queue& queue, Ticks time, PortSink& sink) KNOTWAVE_RT {
  const Waiting waiting = queue.pop();
  MidiEvent event = waiting.event;
  const Ticks came = ticks_at_or_after(event.time);
  if (time != came) event.time = time_of(time);
  if (waiting.is_thru) {
    waiting_thru_bytes -= message_bytes(event);
    cable.count_wait(time - came);
  }
  cable.send(event, time, waiting.is_thru);
  sink.send(event);
  notice(event, time);
}

/// Controllers of others that change what our receivers hold.
void OutputPort::State::notice(const MidiEvent& event, Ticks time) KNOTWAVE_RT {
  if (!is_control_change(event)) return;
  const int number = event.bytes[1], channel = event.channel();
  constexpr int kResetAllControllers = 121;
  const bool is_reset = number == kResetAllControllers;
  const bool is_entry = number == 6 || number == 38 || (number >= 96 && number <= 101);
  if (is_entry || is_reset) selections[static_cast<std::size_t>(channel)] = {};
  for (OutputLane& lane : lanes) {
    if (lane.spec().channel != channel + 1) continue;
    if (is_reset) lane.forget(time, cable.free_at(), until);
    const int own = lane.spec().number;
    if (lane.spec().kind == OutputKind::control && (own == number || own + 32 == number)) {
      lane.forget_halves();
    }
  }
}

bool OutputPort::State::send_lane(int index, Ticks time, PortSink& sink) KNOTWAVE_RT {
  OutputLane& lane = lanes[static_cast<std::size_t>(index)];
  const Ticks left_at = lane.left_at();
  const auto plan = lane.plan(time, until, cable, selections);
  if (!plan) {
    const bool is_later = lane.left_at() != left_at || lane.due(cable, selections) > time;
    if (!is_later) lane.pass_over(until);
    return false;
  }
  expression_went_last = lane.is_expression();
  const MessageGroup said = lane.messages(plan->step, selections);
  lane.begin(*plan, time, until, cable);
  if (lane.spec().kind == OutputKind::nrpn) {
    ParameterSelection& selection = selections[static_cast<std::size_t>(lane.spec().channel - 1)];
    selection.nrpn = lane.spec().number;
    selection.null_at = time + static_cast<Ticks>(kNrpnNullSeconds * rate_hz * 0x1p20);
  }
  start_group(said, index, time, sink);
  return true;
}

void OutputPort::State::start_group(const MessageGroup& said, int lane, Ticks time,
                                    PortSink& sink) KNOTWAVE_RT {
  group = said;
  group_sent = 0;
  group_lane = lane;
  send_group_message(time, sink);
}

void OutputPort::State::send_group_message(Ticks time, PortSink& sink) KNOTWAVE_RT {
  MidiEvent& event = group.messages[static_cast<std::size_t>(group_sent++)];
  event.time = time_of(time);
  const std::int64_t bytes = cable.send(event, time, false);
  sink.send(event);
  if (group_lane < 0) return;
  lane_bytes[static_cast<std::size_t>(group_lane)] += bytes;
  if (group_sent == group.count && cable.is_din()) {
    lanes[static_cast<std::size_t>(group_lane)].arrives(cable.free_at(), until);
  }
}

OutputPort::OutputPort(std::unique_ptr<State> state) : state_(std::move(state)) {}
OutputPort::~OutputPort() = default;

Result<std::unique_ptr<OutputPort>> OutputPort::create(const OutputPortConfig& config) {
  if (!(config.rate_hz >= 8000 && config.rate_hz <= 768000)) {
    return fail(ErrorCode::value_out_of_range,
                "the clock has " + std::to_string(config.rate_hz) +
                    " samples a second; 8000 to 768000 are possible");
  }
  return std::unique_ptr<OutputPort>(new OutputPort(std::make_unique<State>(config)));
}

namespace {

Error lane_fault(const std::string& what, int found, int low, int high) {
  return fail(ErrorCode::value_out_of_range, what + " is " + std::to_string(found) + "; " +
                                                 std::to_string(low) + " to " +
                                                 std::to_string(high) + " are possible");
}

Result<void> check_lane(const LaneSpec& lane) {
  const bool is_control = lane.kind == OutputKind::control;
  const bool is_nrpn = lane.kind == OutputKind::nrpn;
  if (lane.kind == OutputKind::osc || lane.kind == OutputKind::voltage) {
    return fail(ErrorCode::value_out_of_range, "a lane is of MIDI; OSC and voltages have none");
  }
  if (lane.channel < 1 || lane.channel > 16) return lane_fault("channel", lane.channel, 1, 16);
  if (lane.key < 0 || lane.key > 127) return lane_fault("key", lane.key, 0, 127);
  if (lane.bits != 7 && lane.bits != 14) {
    return fail(ErrorCode::value_out_of_range,
                "bits is " + std::to_string(lane.bits) + "; 7 and 14 are possible");
  }
  const int most = is_nrpn ? 16383 : lane.bits == 14 ? 31 : 119;
  if ((is_control || is_nrpn) && (lane.number < 0 || lane.number > most)) {
    return lane_fault("number", lane.number, 0, most);
  }
  const int top = lane.bits == 14 ? 16383 : 127;
  if (lane.first_step < -1 || lane.first_step > top) {
    return lane_fault("first_step", lane.first_step, -1, top);
  }
  if (lane.rest_step < -1 || lane.rest_step > top) {
    return lane_fault("rest_step", lane.rest_step, -1, top);
  }
  return {};
}

}  // namespace

Result<int> OutputPort::add_lane(const LaneSpec& spec) {
  LaneSpec lane = spec;
  if (lane.kind == OutputKind::pitch_bend) lane.bits = 14;
  if (lane.kind == OutputKind::channel_pressure || lane.kind == OutputKind::poly_pressure) {
    lane.bits = 7;
  }
  if (auto checked = check_lane(lane); !checked) return checked.error();
  if (state_->lanes.size() >= kMostLanes) {
    return fail(ErrorCode::value_out_of_range,
                "a port has " + std::to_string(kMostLanes) + " lanes at most");
  }
  state_->lanes.emplace_back(lane);
  state_->lane_bytes.push_back(0);
  const OutputLane& added = state_->lanes.back();
  const Ticks known =
      state_->cable.is_din()
          ? state_->cable.time_of_bytes(added.most_bytes() + added.most_next_bytes())
          : state_->cable.spacing();
  const auto samples =
      static_cast<std::size_t>((known + kTicksPerSample - 1) >> kTickBits) + kSlack;
  state_->ahead = std::max(state_->ahead, samples);
  return static_cast<int>(state_->lanes.size()) - 1;
}

void OutputPort::address(int lane, int channel, int key, std::int64_t from) KNOTWAVE_RT {
  state_->lanes[static_cast<std::size_t>(lane)].address(channel, key, from);
}

std::size_t OutputPort::ahead_samples() const KNOTWAVE_RT { return state_->ahead; }

bool OutputPort::post(const MidiEvent& event, OutputPriority priority, bool is_thru) KNOTWAVE_RT {
  Queue& queue = priority == OutputPriority::clock ? state_->clocks : state_->messages;
  const std::int64_t bytes = message_bytes(event);
  if (is_thru) state_->cable.count_arrival(bytes, state_->waiting_thru_bytes);
  if (!state_->admission.admit(event, state_->clocks.size() + state_->messages.size())) {
    state_->cable.count_loss();
    return false;
  }
  if (is_thru) state_->waiting_thru_bytes += bytes;
  queue.push({event, priority, is_thru});
  return true;
}

void OutputPort::render(std::int64_t first, std::size_t n, std::span<const LaneValues> lanes,
                        PortSink& sink) KNOTWAVE_RT {
  State& state = *state_;
  state.begin_block(first, n, lanes);
  const Ticks begin = sample_ticks(first);
  const Ticks end = sample_ticks(first + static_cast<std::int64_t>(n));
  for (;;) {
    const Candidate candidate = state.next(std::max(begin, state.decided));
    if (candidate.kind == Candidate::Kind::none || candidate.ready >= end) break;
    state.decided = candidate.ready;
    state.send(candidate, sink);
  }
  for (OutputLane& lane : state.lanes) lane.end_block(static_cast<std::int64_t>(n));
  state.cable.update_use(end);
}

void OutputPort::say_again() KNOTWAVE_RT { state_->must_say_again = true; }
void OutputPort::say_again(int lane) KNOTWAVE_RT {
  state_->lanes[static_cast<std::size_t>(lane)].say_again();
}
int OutputPort::last_step(int lane) const KNOTWAVE_RT {
  return state_->lanes[static_cast<std::size_t>(lane)].sent();
}
std::int64_t OutputPort::lane_bytes(int lane) const KNOTWAVE_RT {
  return state_->lane_bytes[static_cast<std::size_t>(lane)];
}
const PortCounters& OutputPort::counters() const KNOTWAVE_RT { return state_->cable.counters(); }

bool OutputPort::is_waiting() const KNOTWAVE_RT {
  const State& state = *state_;
  if (state.clocks.size() + state.messages.size() != 0) return true;
  if (state.group_sent < state.group.count) return true;
  for (const ParameterSelection& selection : state.selections) {
    if (selection.null_at != kNever) return true;
  }
  return std::any_of(state.lanes.begin(), state.lanes.end(),
                     [](const OutputLane& lane) { return lane.is_waiting(); });
}

}  // namespace knotwave::engine
