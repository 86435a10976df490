// SPDX-License-Identifier: MIT
// Envelopes, LFOs and the single parts of a patch. Waves are in compile_waves.cpp, maps in
// compile_maps.cpp, their order in map_schedule.cpp.
#include "patch_compiler.h"

#include <algorithm>
#include <array>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/suggest.h"

#include "map_schedule.h"

namespace knotwave::engine {

using base::number_text;

Result<std::unique_ptr<const PatchProgram>> PatchProgram::create(
    const PatchSpec& spec, std::span<const WaveCycles> cycles) {
  return PatchCompiler(spec, cycles).compile();
}

Result<std::unique_ptr<const PatchProgram>> PatchCompiler::compile() {
  program_.reset(new PatchProgram);
  program_->spec_ = spec_;
  program_->gain_lin_ = base::db_to_gain(spec_.gain_db);
  for (auto step : {&PatchCompiler::check_counts, &PatchCompiler::collect_moved_numbers,
                    &PatchCompiler::compile_envelopes, &PatchCompiler::compile_lfos,
                    &PatchCompiler::compile_oscillators, &PatchCompiler::compile_maps,
                    &PatchCompiler::compile_rest, &PatchCompiler::order_steps}) {
    if (auto done = (this->*step)(); !done) return about(done.error());
  }
  finish_flags();
  program_->spec_.curves = {};  // compiled away
  program_->spec_.places = {};
  return std::unique_ptr<const PatchProgram>(std::move(program_));
}

Error PatchCompiler::about(Error error) const {
  error = placed(std::move(error), "");
  if (!spec_.name.empty()) error.message = "patch '" + spec_.name + "': " + error.message;
  return error;
}

// Errors of a file of its own (a tuning) keep their place.
Error PatchCompiler::placed(Error error, std::string_view path) const {
  if (!error.source.empty()) return error;
  const Place place = spec_.place_of(path);
  error.source = spec_.source_name;
  error.line = place.line;
  error.column = place.column;
  return error;
}

Error PatchCompiler::about(Error error, const Part& part) const {
  error = placed(std::move(error), part.path);
  error.message = part.name + ": " + error.message;
  return error;
}

void PatchCompiler::tell(std::string line) { program_->report_.push_back(std::move(line)); }

Result<void> PatchCompiler::check_counts() {
  const auto too_many = [](const char* what, std::size_t found, int most) {
    return fail(ErrorCode::value_out_of_range, std::to_string(found) + " " + what + "; at most " +
                                                   std::to_string(most) + " are possible");
  };
  if (spec_.oscillators.size() > kMaxOscillators)
    return too_many("oscillators", spec_.oscillators.size(), kMaxOscillators);
  if (spec_.envelopes.size() > kMaxEnvelopes)
    return too_many("envelopes", spec_.envelopes.size(), kMaxEnvelopes);
  if (spec_.lfos.size() > kMaxLfos) return too_many("LFOs", spec_.lfos.size(), kMaxLfos);
  if (spec_.maps.size() > kMaxMaps) return too_many("maps", spec_.maps.size(), kMaxMaps);
  if (spec_.free_numbers.size() > kMaxFreeNumbers)
    return too_many("free numbers", spec_.free_numbers.size(), kMaxFreeNumbers);
  const int sources = static_cast<int>(spec_.oscillators.size());
  if (!spec_.has_sound && sources > 0)
    return fail(ErrorCode::unsupported, "an envelope patch has no oscillators");
  for (const int end : {spec_.crossfade_a, spec_.crossfade_b}) {
    if (!spec_.crossfade_on || end == kNoiseSource || (end >= 0 && end < sources)) continue;
    return placed(fail(ErrorCode::value_out_of_range, "the crossfade names oscillator " +
                                                          std::to_string(end) + "; there are " +
                                                          std::to_string(sources)),
                  "crossfade.between");
  }
  return {};
}

Result<const curves::NurbsCurve*> PatchCompiler::curve(const std::string& name,
                                                       const Part& part) const {
  if (const curves::NurbsCurve* found = spec_.curves.find_curve(name)) return found;
  const auto names = spec_.curves.names();
  return about(
      fail(ErrorCode::unknown_name, "no curve '" + name + "'" + base::suggestion(name, names)),
      part);
}

Result<PatchCompiler::MovedCurve> PatchCompiler::moved_curve(const std::string& name,
                                                             const Part& part,
                                                             bool is_function) const {
  auto found = curve(name, part);
  if (!found) return found.error();
  MovedCurve moved;
  moved.curve = *found;
  const std::vector<int> numbers = moved_numbers_of(name);
  for (const int number : numbers) {
    moved.options.controls.push_back(moved_[static_cast<std::size_t>(number)].range);
    moved.slots.push_back(kSlotControl + number);
  }
  if (numbers.empty() || !is_function || moved.curve->dim() == 1) return moved;
  const Part mover = map_part(moved_[static_cast<std::size_t>(numbers[0])].map, ".to");
  return about(fail(ErrorCode::unsupported,
                    "it moves a number of curve '" + name + "' (" + part.name +
                        "), whose points have a time of their own (x): y over x is worked out when "
                        "the patch is read and cannot move. A curve of one coordinate, with knots "
                        "for the times, can"),
               mover);
}

Result<void> PatchCompiler::compile_envelopes() {
  for (const EnvelopeUse& use : spec_.envelopes) {
    const Part role{"envelope '" + use.name + "'", "envelopes." + use.name + ".curve"};
    auto found = moved_curve(use.curve, role);
    if (!found) return found.error();
    PatchProgram::EnvelopePart part;
    dsp::EnvelopeSpec spec = use.spec;
    spec.compile.controls = found->options.controls;
    part.control_slots = found->slots;
    auto program = dsp::EnvelopeProgram::create(*found->curve, spec);
    if (!program) return about(program.error(), role);
    part.name = use.name;
    part.program = *std::move(program);
    part.velocity_time = use.velocity_time;
    part.key_time = use.key_time;
    part.tempo_beats = use.tempo_beats;
    tell(role.name + ": curve '" + use.curve + "', " +
         std::to_string(part.program.program().piece_count()) + " pieces, largest error " +
         number_text(part.program.program().max_error()));
    program_->envelopes_.push_back(std::move(part));
  }
  program_->amp_envelope_ = -1;
  return spec_.has_sound ? add_default_amp() : Result<void>{};
}

// Up in 3 ms, held, down in 15 ms: for a patch that draws no loudness of its own.
Result<void> PatchCompiler::add_default_amp() {
  program_->amp_envelope_ = envelope_index("amp");
  if (program_->amp_envelope_ >= 0) return {};
  curves::CurveSpec gate;
  gate.name = "amp";
  gate.degree = 2;
  gate.points = {0, 1, 1, 1, 0, 0};
  gate.knots = {0, 0, 0, 0.003, 0.003, 0.0105, 0.018, 0.018, 0.018};
  auto made = curves::NurbsCurve::create(gate);
  if (!made) return made.error();
  dsp::EnvelopeSpec spec;
  spec.seconds = 0.018;
  spec.sustain_u = 0.003;
  auto program = dsp::EnvelopeProgram::create(*made, spec);
  if (!program) return about(program.error(), {"the built-in amp envelope", "envelopes"});
  program_->amp_envelope_ = static_cast<int>(program_->envelopes_.size());
  PatchProgram::EnvelopePart part;
  part.name = "amp";
  part.program = *std::move(program);
  program_->envelopes_.push_back(std::move(part));
  return {};
}

Result<void> PatchCompiler::compile_lfos() {
  for (const LfoUse& use : spec_.lfos) {
    const Part role{"lfo '" + use.name + "'", "lfos." + use.name + ".curve"};
    auto found = moved_curve(use.curve, role);
    if (!found) return found.error();
    auto cycle = curves::compile_function(*found->curve, found->options);
    if (!cycle) return about(cycle.error(), role);
    tell(role.name + ": curve '" + use.curve + "', " + std::to_string(cycle->piece_count()) +
         " pieces, largest error " + number_text(cycle->max_error()));
    program_->lfos_.push_back(
        {use.name, use.spec, *std::move(cycle), std::move(found->slots), false});
  }
  return {};
}

Result<void> PatchCompiler::compile_rest() {
  const Part of_shaper{"shaper", "shaper.curve"}, of_law{"crossfade", "crossfade.law"};
  const Part of_glide{"glide", "glide_curve"};
  if (!spec_.shaper_curve.empty()) {
    auto found = moved_curve(spec_.shaper_curve, of_shaper);
    if (!found) return found.error();
    auto shaper = dsp::ShaperProgram::create(*found->curve, found->options.controls);
    if (!shaper) return about(shaper.error(), of_shaper);
    program_->shaper_ = *std::move(shaper);
    program_->shaper_slots_ = std::move(found->slots);
  }
  if (spec_.crossfade_law == "linear") {
    program_->crossfade_law_ = dsp::CrossfadeLaw::linear();
  } else if (!spec_.crossfade_law.empty()) {
    auto found = moved_curve(spec_.crossfade_law, of_law, false);
    if (!found) return found.error();
    auto law = dsp::CrossfadeLaw::create(*found->curve, found->options);
    if (!law) return about(law.error(), of_law);
    program_->crossfade_law_ = *std::move(law);
    program_->crossfade_slots_ = std::move(found->slots);
  }
  if (!spec_.glide_curve.empty()) {
    auto found = moved_curve(spec_.glide_curve, of_glide);
    if (!found) return found.error();
    auto glide = curves::compile_function(*found->curve, found->options);
    if (!glide) return about(glide.error(), of_glide);
    program_->glide_curve_ = *std::move(glide);
    program_->glide_slots_ = std::move(found->slots);
  }
  return {};
}

void PatchCompiler::finish_flags() {
  PatchProgram& p = *program_;
  p.is_mono_ = p.noise_.gain_lin == 0 || p.noise_.pan == 0.5;
  for (const PatchProgram::Source& source : p.oscillators_) {
    if (source.gain_lin == 0) continue;
    if (source.pan != 0.5 || source.tables->channels() != 1) p.is_mono_ = false;
  }
  for (const PatchProgram::MapPart& map : p.maps_) {
    if (map.slot >= kSlotSourcePan && map.slot < kSlotSourcePan + kMaxSources) p.is_mono_ = false;
    for (std::size_t i = 0; i < p.oscillators_.size(); ++i) {
      if (map.slot == kSlotSourcePhase + static_cast<int>(i)) p.oscillators_[i].phase_moves = true;
    }
    for (std::size_t i = 0; i < p.lfos_.size(); ++i) {
      if (map.slot == kSlotLfoRate + static_cast<int>(i)) p.lfos_[i].rate_moves = true;
    }
  }
  p.velocity_law_ = !velocity_is_loudness();
}

// Straight or through free numbers.
bool PatchCompiler::velocity_is_loudness() const {
  std::array<bool, kSlotCount> has_velocity{};
  for (const PatchProgram::Step& step : program_->schedule_) {
    if (step.kind != PatchProgram::Step::Kind::map) continue;
    const PatchProgram::MapPart& map = program_->maps_[static_cast<std::size_t>(step.index)];
    const std::vector<int> slots = slots_read_by(map);
    has_velocity[static_cast<std::size_t>(map.slot)] |=
        map.source == MapSource::velocity || map.source_v == MapSource::velocity ||
        std::any_of(slots.begin(), slots.end(), [&](int slot) {
          return is_free_slot(slot) && has_velocity[static_cast<std::size_t>(slot)];
        });
  }
  return has_velocity[kSlotAmp] || has_velocity[kSlotGain];
}

int PatchCompiler::envelope_index(const std::string& name) const {
  for (std::size_t i = 0; i < spec_.envelopes.size(); ++i) {
    if (spec_.envelopes[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace knotwave::engine
