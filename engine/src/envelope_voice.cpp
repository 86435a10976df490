// SPDX-License-Identifier: MIT
#include "envelope_voice.h"

#include <algorithm>
#include <cmath>

#include "map_limits.h"

namespace knotwave::engine {
namespace {

/// The place an event watches for, unfolded: along the curve, or the end of the loop.
double watched_place(const dsp::EnvelopeProgram& program, const PlaceEventSpec& event) KNOTWAVE_RT {
  switch (event.at) {
    case PlaceEventSpec::At::place:
      return event.place_u;
    case PlaceEventSpec::At::end:
      return program.program().u_max();
    case PlaceEventSpec::At::loop:
      return program.spec().loop_end_u;
  }
  return event.place_u;
}

}  // namespace

void Passages::add(const Passage& passage) KNOTWAVE_RT {
  if (count_ == passages_.size()) return;
  std::size_t at = count_++;
  for (; at > 0 && passage.time < passages_[at - 1].time; --at) passages_[at] = passages_[at - 1];
  passages_[at] = passage;
}

void EnvelopeVoice::open(const EnvelopePatchProgram& program, const NoteContext& note,
                         std::uint64_t number, base::SampleTime time, double rate_hz,
                         const TempoClock& tempo, bool joins) KNOTWAVE_RT {
  joins = joins && is_active(program);
  note_ = note;
  number_ = number;
  is_open_ = true;
  detached_ = was_still_ = false;
  if (joins) {
    modulation_.retrigger(program.patch(), note, time, rate_hz, tempo);
  } else {
    modulation_.start(program.patch(), note, time, rate_hz, tempo);
  }
  watched_ = time;
  turns_.fill(-1);
}

void EnvelopeVoice::move_to(const NoteContext& note) KNOTWAVE_RT {
  const int velocity = note_.velocity;
  const base::RandomStream random = note_.random;
  note_ = note;
  note_.velocity = velocity;
  note_.random = random;
  detached_ = false;
}

// A place is passed once between two openings of the gate, and once more each time round the loop:
// what lies behind the place it goes on from counts as passed.
void EnvelopeVoice::close(const EnvelopePatchProgram& program, base::SampleTime time,
                          int release_velocity) KNOTWAVE_RT {
  if (!is_open_) return;
  is_open_ = false;
  note_.release_velocity = release_velocity;
  modulation_.release(program.patch(), time);
  const auto& events = program.spec().place_events;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const dsp::Envelope& envelope = modulation_.envelope(events[i].envelope);
    if (envelope.is_idle()) continue;
    const dsp::EnvelopeProgram& part =
        program.patch().envelopes()[static_cast<std::size_t>(events[i].envelope)].program;
    const double near = envelope.u_per_sample() * 0x1p-10;  // what rounding may do to `from`
    const double ahead = watched_place(part, events[i]) - envelope.unfolded_u(time);
    const bool was_passed = turns_[i] >= 0 && (ahead <= near || !part.has_loop());
    turns_[i] = ahead < -near || was_passed ? 0 : -1;
  }
  watched_ = time;
}

bool EnvelopeVoice::is_active(const EnvelopePatchProgram& program) const KNOTWAVE_RT {
  if (is_open_) return true;
  for (int i = 0; has_begun() && i < static_cast<int>(program.patch().envelopes().size()); ++i) {
    if (!modulation_.envelope(i).is_idle()) return true;
  }
  return false;
}

bool EnvelopeVoice::is_still(const EnvelopePatchProgram& program,
                             std::int64_t first) const KNOTWAVE_RT {
  return !has_begun() || (!program.hears_lfo() && note_.targets_are_still(first) &&
                          modulation_.is_still(program.patch(), first));
}

void EnvelopeVoice::look_ahead_from(const EnvelopeVoice& other,
                                    const EnvelopePatchProgram& program) KNOTWAVE_RT {
  modulation_.look_ahead_from(other.modulation_, program.patch());
  note_ = other.note_;
  number_ = other.number_;
  is_open_ = other.is_open_;
  detached_ = other.detached_;
  was_still_ = other.was_still_;
  numbers_ = other.numbers_;
  cursors_ = other.cursors_;
}

void EnvelopeVoice::render(const EnvelopePatchProgram& program, const TempoClock& tempo,
                           std::int64_t first, std::size_t n, ModulationScratch& scratch,
                           const Rows& rows) KNOTWAVE_RT {
  if (!has_begun() || n == 0) return;
  if (!detached_) modulation_.follow(program.patch(), note_, first);
  const bool still = is_still(program, first);
  const bool holds = still && was_still_;
  if (!holds) modulation_.render(program.patch(), note_, tempo, first, n, scratch);
  for (std::size_t i = 0; i < program.outputs().size(); ++i) {
    const std::span<double> out(rows.first + i * rows.length + rows.offset, n);
    if (holds) {
      std::fill(out.begin(), out.end(), numbers_[i]);
    } else {
      render_output(program, i, n, scratch, out);
      numbers_[i] = out.back();
    }
  }
  was_still_ = still;
}

void EnvelopeVoice::render_output(const EnvelopePatchProgram& program, std::size_t index,
                                  std::size_t n, ModulationScratch& scratch,
                                  std::span<double> out) KNOTWAVE_RT {
  const EnvelopePatchProgram::Output& output = program.outputs()[index];
  const auto source = static_cast<std::size_t>(output.spec.source_index);
  curves::CurveCursor& cursor = cursors_[index];
  if (output.spec.source == MapSource::envelope) {
    output.values(std::span<const double>(scratch.envelopes[source]).first(n), out, cursor);
  } else if (output.spec.source == MapSource::lfo) {
    output.values(std::span<const double>(scratch.lfos[source]).first(n), out, cursor);
  } else {
    const Signal number =
        mapped(scratch.slots[kSlotFree + source], n, scratch.source, limited_free);
    if (number.is_constant()) {
      std::fill(out.begin(), out.end(), output.value(number.constant, cursor));
    } else {
      output.values(std::span(number.values, n), out, cursor);
    }
  }
}

// How often the place was passed by `time`, less 1: it goes by the envelope's stage, so that a
// gate is watched up to before it moves.
std::int64_t EnvelopeVoice::turns(const dsp::Envelope& envelope,
                                  const dsp::EnvelopeProgram& program, const PlaceEventSpec& event,
                                  base::SampleTime time) const KNOTWAVE_RT {
  const dsp::EnvelopeSpec& spec = program.spec();
  const double place = watched_place(program, event), u = envelope.unfolded_u(time);
  const bool is_open = envelope.gate_is_open();
  const bool loops = is_open && program.has_loop();
  if (loops && event.at == PlaceEventSpec::At::end) return -1;
  if (!loops && event.at == PlaceEventSpec::At::loop) return -1;
  if (is_open && program.has_sustain() && place > spec.sustain_u) return -1;
  if (!(u >= place)) return -1;
  if (!loops || place < spec.loop_start_u) return 0;
  if (place > spec.loop_end_u) return -1;
  const double turns = std::floor((u - place) / (spec.loop_end_u - spec.loop_start_u));
  return static_cast<std::int64_t>(std::min(turns, 0x1p62));
}

void EnvelopeVoice::watch(const EnvelopePatchProgram& program, base::SampleTime until,
                          Passages& passages) KNOTWAVE_RT {
  if (!has_begun() || until < watched_) return;
  for (std::size_t i = 0; i < program.spec().place_events.size(); ++i) {
    watch_one(program, i, until, passages);
  }
  watched_ = until;
}

// From sample to sample where anything was passed at all; one passage a sample is told at most.
void EnvelopeVoice::watch_one(const EnvelopePatchProgram& program, std::size_t index,
                              base::SampleTime until, Passages& passages) KNOTWAVE_RT {
  const PlaceEventSpec& event = program.spec().place_events[index];
  const dsp::Envelope& envelope = modulation_.envelope(event.envelope);
  const dsp::EnvelopeProgram& part =
      program.patch().envelopes()[static_cast<std::size_t>(event.envelope)].program;
  std::int64_t& passed = turns_[index];
  if (turns(envelope, part, event, until) <= passed) return;
  const double length = part.spec().loop_end_u - part.spec().loop_start_u;
  base::SampleTime before = watched_;
  while (true) {
    const base::SampleTime here =
        before < until ? std::min(base::SampleTime{before.sample + 1, 0}, until) : until;
    const std::int64_t now = turns(envelope, part, event, here);
    if (now > passed) {
      const double place = watched_place(part, event) + static_cast<double>(passed + 1) * length;
      const double samples = (place - envelope.unfolded_u(before)) / envelope.u_per_sample();
      passages.add(
          {std::min(time_after(before, samples + 0x1p-33), here), static_cast<int>(index)});
      passed = now;
    }
    if (here == until) return;
    before = here;
  }
}

}  // namespace knotwave::engine
