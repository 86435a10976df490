// SPDX-License-Identifier: MIT
// A patch compiled: what its voices read. Immutable, no sample rate in it, shared by all voices.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/surface_program.h"
#include "knotwave/dsp/crossfade.h"
#include "knotwave/dsp/envelope.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/dsp/wave_tables.h"
#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/map_slots.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

class PatchProgram {
 public:
  /// An oscillator, or the noise (then without tables).
  struct Source {
    std::shared_ptr<const dsp::WaveTables> tables;
    double gain_lin = 1;   ///< 0: never rendered
    double semitones = 0;  ///< transpose, detune and ratio
    bool is_fixed = false;
    double fixed_pitch = 0;  ///< as a MIDI note number
    double position = 0;
    double phase_cycles = 0;
    bool random_phase = false;
    double pan = 0.5;
    bool phase_moves = false;  ///< a map moves its phase
    int envelope = -1;         ///< multiplies this source alone
    /// A curve whose number a map moves is a surface over the number's range: the slot the number
    /// is in, and its range.
    int control_slot = -1;
    double control_low = 0, control_high = 1;
  };
  struct EnvelopePart {
    std::string name;
    dsp::EnvelopeProgram program;
    std::vector<int> control_slots;  ///< in the order of the program's controls
    double velocity_time = 0, key_time = 0;
    bool tempo_beats = false;
  };
  struct LfoPart {
    std::string name;
    dsp::LfoSpec spec;
    curves::CurveProgram cycle;
    std::vector<int> control_slots;  ///< of the cycle
    bool rate_moves = false;         ///< a map moves its speed
  };
  struct MapPart {
    MapSource source = MapSource::constant, source_v = MapSource::constant;
    int source_index = 0, source_v_index = 0;
    std::optional<curves::CurveProgram> curve;
    std::vector<int> control_slots;  ///< of the curve
    std::optional<curves::SurfaceProgram> surface;
    int slot = 0;
    double depth = 1;
    bool is_control = false;  ///< low + (high - low) * value instead of value
    double low = 0, high = 1;
    double smooth_s = 0;
  };
  /// What is computed in which order: every map after what it reads, everything a map moves after
  /// the map.
  struct Step {
    enum class Kind { map, envelope, lfo };
    Kind kind = Kind::map;
    int index = 0;
  };

  /// Compiles. [control] Errors, with the patch's file and name: those of the parts, unknown_name,
  /// cyclic_reference (an envelope, LFO, curve or free number that moves itself, through others or
  /// not),
  /// control_conflict (two maps onto one number), unsupported (a moved number in a 2-D curve that
  /// is a function; two in one waveform; an envelope's time from an envelope or LFO),
  /// file_not_found (a wave_file not in `cycles`).
  static Result<std::unique_ptr<const PatchProgram>> create(
      const PatchSpec& spec, std::span<const WaveCycles> cycles = {});

  const std::string& name() const noexcept { return spec_.name; }
  /// The numbers that need no compiling: polyphony, mode, filter, gains. [audio] Read only.
  const PatchSpec& spec() const KNOTWAVE_RT { return spec_; }
  const Tuning& tuning() const KNOTWAVE_RT { return spec_.tuning; }

  std::span<const Source> oscillators() const KNOTWAVE_RT { return oscillators_; }
  const Source& noise() const KNOTWAVE_RT { return noise_; }
  std::span<const EnvelopePart> envelopes() const KNOTWAVE_RT { return envelopes_; }
  int amp_envelope() const KNOTWAVE_RT {
    return amp_envelope_;
  }  ///< -1: PatchSpec::has_sound false
  std::span<const LfoPart> lfos() const KNOTWAVE_RT { return lfos_; }
  /// Those that are on and not overridden.
  std::span<const MapPart> maps() const KNOTWAVE_RT { return maps_; }
  std::span<const Step> schedule() const KNOTWAVE_RT { return schedule_; }
  /// The maps an envelope's time hangs on, through others or not, in the order of the schedule.
  std::span<const int> note_on_maps() const KNOTWAVE_RT { return note_on_maps_; }
  const dsp::ShaperProgram* shaper() const KNOTWAVE_RT { return shaper_ ? &*shaper_ : nullptr; }
  /// Where the numbers of a curve that maps move are, in the order of its controls.
  std::span<const int> shaper_slots() const KNOTWAVE_RT { return shaper_slots_; }
  const dsp::CrossfadeLaw& crossfade_law() const KNOTWAVE_RT { return crossfade_law_; }
  std::span<const int> crossfade_slots() const KNOTWAVE_RT { return crossfade_slots_; }
  const curves::CurveProgram* glide_curve() const KNOTWAVE_RT {
    return glide_curve_ ? &*glide_curve_ : nullptr;
  }
  std::span<const int> glide_slots() const KNOTWAVE_RT { return glide_slots_; }
  double gain_lin() const KNOTWAVE_RT { return gain_lin_; }
  /// Left and right never differ before the pan of the voice.
  bool is_mono() const KNOTWAVE_RT { return is_mono_; }
  /// No map from velocity onto the voice's loudness: the built-in law applies.
  bool uses_velocity_law() const KNOTWAVE_RT { return velocity_law_; }

  /// Lines worth telling: measured errors, tables, memory. [control]
  const std::vector<std::string>& report() const noexcept { return report_; }

 private:
  friend class PatchCompiler;  // src/patch_compiler.h
  PatchProgram() = default;
  PatchSpec spec_;
  std::vector<Source> oscillators_;
  Source noise_;
  std::vector<EnvelopePart> envelopes_;
  int amp_envelope_ = 0;
  std::vector<LfoPart> lfos_;
  std::vector<MapPart> maps_;
  std::vector<Step> schedule_;
  std::vector<int> note_on_maps_;
  std::optional<dsp::ShaperProgram> shaper_;
  dsp::CrossfadeLaw crossfade_law_;
  std::optional<curves::CurveProgram> glide_curve_;
  std::vector<int> shaper_slots_, crossfade_slots_, glide_slots_;
  double gain_lin_ = 1;
  bool is_mono_ = true;
  bool velocity_law_ = true;
  std::vector<std::string> report_;
};

}  // namespace knotwave::engine
