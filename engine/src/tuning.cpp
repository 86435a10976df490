// SPDX-License-Identifier: MIT
// A scale laid over the keys.
#include "knotwave/engine/tuning.h"

#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"

#include "scala_text.h"

namespace knotwave::engine {
namespace {

constexpr double kMaxSemitones = 1200;  // 100 octaves

double place_semitones(const Scale& scale, const KeyboardMapping& mapping,
                       const KeyboardMapping::Place& place) {
  return scale.semitones(place.degree) + place.pattern * scale.semitones(mapping.octave_degree);
}

Scale twelve_tones() {
  Scale scale;
  for (int i = 1; i <= 12; ++i) scale.degrees.push_back(i);
  return scale;
}

}  // namespace

Tuning::Tuning() {
  for (std::size_t note = 0; note < 128; ++note) pitch_[note] = static_cast<double>(note);
  mapped_.fill(true);
}

Result<Tuning> Tuning::create(std::string_view scl_text, std::string_view scl_name,
                              std::string_view kbm_text, std::string_view kbm_name) {
  Result<Scale> scale = scl_text.empty() ? twelve_tones() : parse_scale(scl_text, scl_name);
  if (!scale) return scale.error();
  Result<KeyboardMapping> mapping =
      kbm_text.empty() ? KeyboardMapping{} : parse_mapping(kbm_text, kbm_name);
  if (!mapping) return mapping.error();

  const auto reference = mapping->place(mapping->reference_note);
  if (!reference) {
    Error error =
        fail(ErrorCode::malformed, "the reference note " + std::to_string(mapping->reference_note) +
                                       " is unmapped ('x'), so nothing has a pitch");
    error.source = kbm_name;
    error.line = mapping->reference_line.line;
    error.column = mapping->reference_line.column;
    return error;
  }
  // Relative to the reference, so that the reference note has its frequency to the bit.
  const double reference_pitch = 69 + 12 * base::log2(mapping->reference_hz / 440);
  const double reference_semitones = place_semitones(*scale, *mapping, *reference);
  Tuning tuning;
  for (int note = mapping->first_note; note <= mapping->last_note; ++note) {
    const auto index = static_cast<std::size_t>(note);
    const auto place = mapping->place(note);
    tuning.mapped_[index] = place.has_value();
    if (!place) continue;
    tuning.pitch_[index] =
        reference_pitch + (place_semitones(*scale, *mapping, *place) - reference_semitones);
    if (!(std::abs(tuning.pitch_[index] - 69) <= kMaxSemitones)) {
      Error error = fail(ErrorCode::value_out_of_range,
                         "note " + std::to_string(note) + " would be " +
                             base::number_text((tuning.pitch_[index] - 69) / 12) +
                             " octaves from A4, the limit is 100");
      const bool by_scale = !scale->lines.empty();
      const ScalaLine& at = by_scale ? scale->lines.back() : mapping->hz_line;
      error.source = by_scale ? scl_name : kbm_name;
      error.line = at.line;
      error.column = at.column;
      return error;
    }
  }
  std::size_t first = 0;
  while (!tuning.mapped_[first]) ++first;  // the reference note is mapped or outside first..last
  for (std::size_t note = 0; note < 128; ++note) {
    if (!tuning.mapped_[note]) tuning.pitch_[note] = tuning.pitch_[note > first ? note - 1 : first];
  }
  return tuning;
}

double Tuning::midi_pitch(double note) const KNOTWAVE_RT {
  if (!(note > 0)) return note <= 0 ? pitch_[0] + note : pitch_[0];
  if (note >= 127) return pitch_[127] + (note - 127);
  const double below = std::floor(note);
  const auto index = static_cast<std::size_t>(below);
  return pitch_[index] + (note - below) * (pitch_[index + 1] - pitch_[index]);
}

double Tuning::hz(double note) const KNOTWAVE_RT { return base::note_to_hz(midi_pitch(note)); }

bool Tuning::is_mapped(int note) const KNOTWAVE_RT {
  return note >= 0 && note < 128 && mapped_[static_cast<std::size_t>(note)];
}

}  // namespace knotwave::engine
