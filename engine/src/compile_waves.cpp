// SPDX-License-Identifier: MIT
// Waveforms of a patch: a curve, a surface, a curve whose number a map moves, or sampled cycles.
#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/suggest.h"
#include "knotwave/dsp/builtin_waves.h"

#include "patch_compiler.h"

namespace knotwave::engine {
namespace {

constexpr double kSilentDb = -96;

}  // namespace

Result<void> PatchCompiler::compile_oscillators() {
  for (const OscillatorSpec& oscillator : spec_.oscillators) {
    const std::string path = "oscillators." + oscillator.name;
    const std::string name = "oscillator '" + oscillator.name + "'";
    const Part wave{name, path + (oscillator.wave.empty() ? ".wave_file" : ".wave")};
    PatchProgram::Source source;
    source.gain_lin = oscillator.level_db <= kSilentDb ? 0 : base::db_to_gain(oscillator.level_db);
    source.semitones = oscillator.transpose_semitones + oscillator.detune_cents / 100 +
                       12 * base::log2(oscillator.ratio);
    source.is_fixed = oscillator.fixed_hz > 0;
    if (source.is_fixed) source.fixed_pitch = 69 + 12 * base::log2(oscillator.fixed_hz / 440);
    source.position = oscillator.position;
    source.phase_cycles = oscillator.phase_cycles;
    source.random_phase = oscillator.random_phase;
    source.pan = oscillator.pan;
    if (auto done = link_envelope(oscillator.envelope, {name, path + ".envelope"}, source); !done)
      return done.error();
    if (auto done = compile_wave(oscillator, source); !done) return about(done.error(), wave);
    program_->oscillators_.push_back(std::move(source));
  }
  PatchProgram::Source& noise = program_->noise_;
  noise.gain_lin = spec_.noise_db <= kNoiseOffDb ? 0 : base::db_to_gain(spec_.noise_db);
  noise.pan = spec_.noise_pan;
  return link_envelope(spec_.noise_envelope, {"noise", "noise.envelope"}, noise);
}

Result<void> PatchCompiler::link_envelope(const std::string& name, const Part& part,
                                          PatchProgram::Source& source) const {
  if (name.empty()) return {};
  source.envelope = envelope_index(name);
  if (source.envelope >= 0) return {};
  std::vector<std::string_view> names;
  for (const EnvelopeUse& use : spec_.envelopes) names.push_back(use.name);
  return about(
      fail(ErrorCode::unknown_name, "no envelope '" + name + "'" + base::suggestion(name, names)),
      part);
}

Result<void> PatchCompiler::compile_wave(const OscillatorSpec& oscillator,
                                         PatchProgram::Source& source) {
  const bool from_file = oscillator.wave.empty();
  const std::vector<int> moved = from_file ? std::vector<int>{} : moved_numbers_of(oscillator.wave);
  if (moved.size() > 1) {
    const int second = moved_[static_cast<std::size_t>(moved[1])].map;
    return placed(fail(ErrorCode::unsupported,
                       std::to_string(moved.size()) + " numbers of the waveform '" +
                           oscillator.wave + "' are moved by maps; a waveform can follow one"),
                  map_part(second, ".to").path);
  }
  const std::string key = from_file
                              ? oscillator.wave_file + "\n" + std::to_string(oscillator.wave_frame)
                              : oscillator.wave;
  auto& shared = waves_[key];
  if (!shared) {
    auto made = from_file ? cycles_of(oscillator) : wave_of(oscillator.wave, moved);
    if (!made) return made.error();
    shared = std::make_shared<const dsp::WaveTables>(*std::move(made));
    tell("wave '" + (from_file ? oscillator.wave_file : oscillator.wave) + "': " +
         std::to_string(shared->rows()) + " rows, " + std::to_string(shared->level_count()) +
         " levels, " + std::to_string(shared->memory_bytes() / 1024) + " KiB, largest error " +
         base::number_text(shared->fit_error()));
  }
  source.tables = shared;
  if (moved.empty()) return {};
  const MovedNumber& number = moved_[static_cast<std::size_t>(moved.front())];
  source.control_slot = kSlotControl + moved.front();
  source.control_low = number.range.low;
  source.control_high = number.range.high;
  return {};
}

Result<dsp::WaveTables> PatchCompiler::wave_of(const std::string& name,
                                               const std::vector<int>& moved) const {
  if (const curves::NurbsSurface* surface = spec_.curves.find_surface(name)) {
    return dsp::WaveTables::create(*surface);
  }
  if (moved.empty() && dsp::is_builtin_wave(name)) return dsp::builtin_wave(name);
  const curves::NurbsCurve* found = spec_.curves.find_curve(name);
  if (found == nullptr) {
    return fail(ErrorCode::unknown_name,
                "no curve '" + name + "'" + base::suggestion(name, spec_.curves.names()));
  }
  if (moved.empty()) return dsp::WaveTables::create(*found);
  return dsp::WaveTables::create(*found, moved_[static_cast<std::size_t>(moved.front())].range);
}

Result<dsp::WaveTables> PatchCompiler::cycles_of(const OscillatorSpec& oscillator) const {
  for (const WaveCycles& cycles : cycles_) {
    const bool same_frame = oscillator.wave_frame == 0 || oscillator.wave_frame == cycles.frame;
    if (cycles.file != oscillator.wave_file || !same_frame) continue;
    return dsp::WaveTables::create_from_cycles(cycles.samples, cycles.frame, cycles.rows);
  }
  return fail(ErrorCode::file_not_found,
              "the cycles of '" + oscillator.wave_file + "' were not read");
}

}  // namespace knotwave::engine
