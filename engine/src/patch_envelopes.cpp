// SPDX-License-Identifier: MIT
// Envelopes and LFOs of a patch.
#include "patch_tables.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr double kMostSeconds = 3600;
constexpr double kMostBeats = 1024;

}  // namespace

void PatchTables::read_envelopes() {
  for (const Node::Member* member : named_tables("envelopes", kMaxEnvelopes)) {
    if (is_source_word(member->key)) {
      return fail_at(member->line, member->column, ErrorCode::duplicate_name,
                     "an envelope may not be called '" + member->key +
                         "': maps use that word for something else");
    }
    read_envelope(*member);
    if (!ok()) return;
  }
}

void PatchTables::read_envelope(const Node::Member& member) {
  TableReader reader(member.value, source_, "envelope '" + member.key + "'");
  EnvelopeUse use;
  use.name = member.key;
  reader.string("curve");  // required
  use.curve = curve_name(reader, "curve", Role::function);
  exclude(reader, "seconds", "beats");
  use.tempo_beats = reader.node("beats") != nullptr;
  use.spec.seconds = use.tempo_beats ? reader.number("beats", 1, 1e-4, kMostBeats)
                                     : reader.number("seconds", 1, 1e-4, kMostSeconds);
  read_envelope_places(reader, use);
  use.spec.retrigger = reader.choice("retrigger", 0, {"current", "restart"}) == 0
                           ? dsp::EnvelopeSpec::Retrigger::current
                           : dsp::EnvelopeSpec::Retrigger::restart;
  use.velocity_time = reader.number("velocity_time", 0, -10, 10);
  use.key_time = reader.number("key_time", 0, -10, 10);
  keep(reader.finish());
  patch_.envelopes.push_back(std::move(use));
}

PatchTables::Domain PatchTables::places_of(const std::string& name) const {
  const curves::NurbsCurve* curve = patch_.curves.find_curve(name);
  if (curve == nullptr) return {};
  const Domain domain{curve->u_min(), curve->u_max()};
  if (curve->dim() != 2) return domain;
  double ends[2][curves::kMaxDim] = {};
  curve->evaluate(domain.low, ends[0]);
  curve->evaluate(domain.high, ends[1]);
  return {ends[0][0], ends[1][0]};
}

// Where an envelope holds, repeats and goes on: parameters of its curve (of 2-D curves, times).
void PatchTables::read_envelope_places(TableReader& reader, EnvelopeUse& use) {
  const auto [low, high] = places_of(use.curve);
  const double none = low - 1;
  use.spec.sustain_u = reader.number("sustain_at", none, low, high);
  use.spec.release_u = reader.number("release_at", none, low, high);
  use.spec.loop_start_u = use.spec.loop_end_u = low;
  exclude(reader, "sustain_at", "loop");
  const Node* release = reader.node("release_at");
  if (reader.node("sustain_at") != nullptr && release != nullptr && reader.ok() &&
      use.spec.release_u < use.spec.sustain_u) {
    reader.fail_at(*release, ErrorCode::parameter_out_of_range,
                   "release_at (" + base::number_text(use.spec.release_u) +
                       ") is before sustain_at (" + base::number_text(use.spec.sustain_u) + ")");
  }
  const Node* loop = reader.array("loop");
  const std::vector<double> ends = reader.numbers("loop");
  if (loop == nullptr || !reader.ok()) return;
  if (ends.size() != 2 || !(ends[0] < ends[1])) {
    return reader.fail_at(*loop, ErrorCode::parameter_out_of_range,
                          "loop must be two rising places of the curve: [start, end]");
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (ends[i] >= low && ends[i] <= high) continue;
    return reader.fail_at(loop->items[i], ErrorCode::parameter_out_of_range,
                          "the loop place " + base::number_text(ends[i]) +
                              " is outside the curve's " + base::number_text(low) + " to " +
                              base::number_text(high));
  }
  use.spec.loop_start_u = ends[0];
  use.spec.loop_end_u = ends[1];
  if (release != nullptr && use.spec.release_u < ends[1]) {
    reader.fail_at(*release, ErrorCode::parameter_out_of_range,
                   "release_at (" + base::number_text(use.spec.release_u) +
                       ") is before the end of the loop (" + base::number_text(ends[1]) + ")");
  }
}

void PatchTables::read_lfos() {
  for (const Node::Member* member : named_tables("lfos", kMaxLfos)) {
    if (is_source_word(member->key) || has_name(patch_.envelopes, member->key)) {
      return fail_at(
          member->line, member->column, ErrorCode::duplicate_name,
          "an LFO may not be called '" + member->key + "': maps use that word for something else");
    }
    read_lfo(*member);
    if (!ok()) return;
  }
}

void PatchTables::read_lfo(const Node::Member& member) {
  TableReader reader(member.value, source_, "LFO '" + member.key + "'");
  LfoUse use;
  use.name = member.key;
  reader.string("curve");  // required
  use.curve = curve_name(reader, "curve", Role::function);
  exclude(reader, "rate_hz", "beats");
  use.spec.rate_hz = reader.number("rate_hz", use.spec.rate_hz, 1e-4, 1000);
  use.spec.beats = reader.number("beats", 0, 1e-3, kMostBeats);
  constexpr dsp::LfoSpec::Mode kModes[] = {dsp::LfoSpec::Mode::key, dsp::LfoSpec::Mode::free,
                                           dsp::LfoSpec::Mode::one_shot};
  use.spec.mode = kModes[reader.choice("mode", 0, {"key", "free", "one_shot"})];
  use.spec.phase_cycles = reader.number("phase", 0, 0, 1);
  use.spec.delay_s = reader.number("delay_s", 0, 0, 60);
  use.spec.fade_s = reader.number("fade_s", 0, 0, 60);
  use.spec.random = reader.boolean("random", false);
  keep(reader.finish());
  patch_.lfos.push_back(std::move(use));
}

}  // namespace knotwave::engine
