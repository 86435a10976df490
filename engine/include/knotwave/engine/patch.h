// SPDX-License-Identifier: MIT
// A patch as its file says it: plain data, checked for itself, not yet compiled.
// docs/patch-format.md is the user's page of this. [control]
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/envelope.h"
#include "knotwave/dsp/filter.h"
#include "knotwave/dsp/lfo.h"
#include "knotwave/engine/tuning.h"

namespace knotwave::engine {

inline constexpr int kMaxOscillators = 4;
inline constexpr int kMaxEnvelopes = 6;
inline constexpr int kMaxLfos = 4;
inline constexpr int kMaxMaps = 32;
inline constexpr int kMaxFreeNumbers = 16;
inline constexpr double kNoiseOffDb = -200;

/// Where a key of a patch file is written; both 0: in no file.
struct Place {
  int line = 0;
  int column = 0;
};
/// Places of a patch's keys by path: "envelopes.amp.curve", "maps.0.to" (maps count from 0), "" for
/// the file itself.
using Places = std::map<std::string, Place, std::less<>>;

/// A source of sound: a curve, a surface or sampled cycles as a waveform.
struct OscillatorSpec {
  std::string name;
  std::string wave;       ///< a curve or surface of the patch
  std::string wave_file;  ///< or a sound file of cycles: the path to open
  int wave_frame = 0;     ///< frames of a cycle in wave_file; 0 = from the file
  double level_db = 0;    ///< -96 or less is silence
  double transpose_semitones = 0;
  double detune_cents = 0;
  double fixed_hz = 0;  ///< > 0: ignores the key
  double position = 0;  ///< along v, 0..1
  double phase_cycles = 0;
  bool random_phase = false;  ///< from the patch seed and the note
  double pan = 0.5;           ///< 0 left .. 1 right
  std::string envelope;  ///< an envelope of the patch that multiplies this source alone; "" none
  double ratio = 1;      ///< multiplies the frequency, 0.01..100
};

struct EnvelopeUse {
  std::string name;  ///< "amp" is the loudness of the voice
  std::string curve;
  dsp::EnvelopeSpec spec;
  double velocity_time =
      0;                ///< octaves of time from velocity 127 to 1: 1 = soft notes twice as long
  double key_time = 0;  ///< octaves of time an octave below middle C
  bool tempo_beats = false;  ///< `seconds` is in quarter notes of the tempo at note-on
};

struct LfoUse {
  std::string name;
  std::string curve;
  dsp::LfoSpec spec;
};

/// Where a map's coordinate comes from. Values are 0..1 unless said.
enum class MapSource {
  constant,  ///< 1
  velocity,
  release_velocity,
  key,          ///< note number / 127
  key_octaves,  ///< octaves from middle C, unbounded
  random,       ///< seeded, one a note
  channel_pressure,
  poly_pressure,
  pressure,    ///< pressure: the larger, MPE's per-note one included
  timbre,      ///< CC 74, per note under MPE
  pitch_bend,  ///< -1..1
  control,     ///< CC index; 14-bit where the LSB is sent
  envelope,
  lfo,          ///< by index
  free_number,  ///< what the maps onto it add up to; by index
};

/// What a map moves, with the unit of its depth.
enum class MapTarget {
  amp,            ///< dB
  level,          ///< of an oscillator, the noise: dB
  gain,           ///< of an oscillator, the noise or the voice ("amp"): factor 1 + value, >= 0
  pitch,          ///< semitones, of the voice or an oscillator
  pan,            ///< 0..1 added, of the voice or an oscillator
  phase,          ///< cycles, of an oscillator
  position,       ///< 0..1 added, along v
  cutoff,         ///< semitones
  resonance,      ///< 0..1 added
  drive,          ///< dB
  crossfade,      ///< 0..1 added
  lfo_rate,       ///< octaves
  envelope_time,  ///< octaves; read at note-on
  curve_weight,   ///< a weight of a curve: the value itself replaces it between low and high
  curve_point,    ///< a coordinate of a control point, likewise
  curve_knot,     ///< a knot, likewise
  free_number,    ///< a number of the patch's own, which maps may read
};

/// Map1: value = depth * curve(source), or depth * source without a curve. Map2: surface(source,
/// source_v). All maps onto one target add; but where one of them is rational (weights that differ,
/// or one that a map moves), only the rational ones do. Disabled and overridden maps cost nothing.
struct MapSpec {
  MapSource source = MapSource::constant;
  int source_index = 0;  ///< control number, envelope, lfo, free number
  MapSource source_v = MapSource::constant;
  int source_v_index = 0;
  std::string curve;    ///< optional
  std::string surface;  ///< optional, instead of a curve
  MapTarget target = MapTarget::amp;
  int target_index = -1;     ///< oscillator (kMaxOscillators = noise), envelope, lfo,
                             ///< free number; -1 = voice
  std::string target_curve;  ///< curve_weight, curve_point, curve_knot
  int target_point = 0;      ///< of a knot its index
  int target_coordinate = 0;
  double depth = 1;
  double low = 0,
         high = 1;          ///< curve targets: the declared range; source 0..1 covers it
  double smooth_s = 0.005;  ///< controllers glide to a new value in this time
  bool enabled = true;
};

enum class PlayMode { poly, mono, legato };
enum class NotePriority { last, low, high };

struct PatchSpec {
  std::string name;
  std::string about;        ///< one line for people, or empty
  std::string source_name;  ///< file, for messages
  curves::CurveSet curves;  ///< its own, those of its curve files, and the built-in ones it uses
  bool has_sound = true;    ///< false: of the envelope generator; no amp envelope, and maps move
                            ///< free numbers, times, rates and curves alone
  std::vector<OscillatorSpec> oscillators;
  double noise_db = kNoiseOffDb;
  double noise_pan = 0.5;
  std::string noise_envelope;  ///< as OscillatorSpec::envelope
  bool crossfade_on = false;
  int crossfade_a = 0, crossfade_b = 1;  ///< oscillators; kMaxOscillators = noise
  double crossfade_position = 0;
  std::string crossfade_law;  ///< "" equal power, "linear", or a curve
  std::string shaper_curve;   ///< "" = no shaper
  double shaper_drive_db = 0;
  double shaper_mix = 1;
  bool filter_on = false;
  dsp::FilterKind filter_kind = dsp::FilterKind::low;
  double filter_cutoff_hz = 20000;
  double filter_resonance = 0;
  double filter_key_track = 0;  ///< 1 = cutoff follows the key, from middle C
  std::vector<EnvelopeUse> envelopes;
  std::vector<LfoUse> lfos;
  std::vector<std::string> free_numbers;  ///< by the maps onto them, in their order
  std::vector<MapSpec> maps;
  double gain_db = 0;
  double pan = 0.5;
  PlayMode mode = PlayMode::poly;
  NotePriority priority = NotePriority::last;
  int polyphony = 32;
  double glide_s = 0;
  std::string glide_curve;  ///< 0..1 over 0..1; "" = the built-in S
  double bend_semitones = 2;
  double velocity_db = 24;  ///< how much softer velocity 1 is than 127, when no map does it
  std::string tuning_file, keymap_file;  ///< .scl, .kbm: paths, or empty
  Tuning tuning;                         ///< what they say
  std::uint64_t seed = 1;
  Places places;  ///< of what was read from a file, for the messages of later steps

  /// Where `path` is written, or what it is in where the file has no such key.
  Place place_of(std::string_view path) const;
};

/// A patch from text; files are looked up beside `source_name`. For tests, fuzzers and demos.
Result<PatchSpec> parse_patch(std::string_view text, std::string_view source_name);

}  // namespace knotwave::engine
