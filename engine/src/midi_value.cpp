// SPDX-License-Identifier: MIT
#include "knotwave/engine/midi_value.h"

#include "knotwave/base/suggest.h"
#include "knotwave/engine/channel_state.h"

#include "envelope_patch_limits.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

using base::MidiStatus;

constexpr int kNoParameter = -1;

constexpr std::string_view kWords[] = {"bend", "pressure", "poly_pressure", "cc74", "nrpn100"};
constexpr base::Synonym kSynonyms[] = {
    {"pitchbend", "bend"},
    {"pitch", "bend"},
    {"aftertouch", "pressure"},
    {"channelpressure", "pressure"},
    {"polyaftertouch", "poly_pressure"},
};

bool has_choice_of_bits(const MidiValueSpec& spec) {
  return spec.kind == OutputKind::nrpn ||
         (spec.kind == OutputKind::control && spec.number <= kLastFineControl);
}

}  // namespace

std::optional<MidiValueSpec> find_midi_value(std::string_view word) {
  if (word == "bend") return MidiValueSpec{OutputKind::pitch_bend, 0, 14};
  if (word == "pressure") return MidiValueSpec{OutputKind::channel_pressure};
  if (word == "poly_pressure") return MidiValueSpec{OutputKind::poly_pressure};
  if (const int number = number_after("cc", word); number >= 0 && number <= kLastControl)
    return MidiValueSpec{OutputKind::control, number};
  if (const int number = number_after("nrpn", word); number >= 0 && number <= kLastNrpn)
    return MidiValueSpec{OutputKind::nrpn, number};
  return std::nullopt;
}

Result<MidiValueSpec> parse_midi_value(std::string_view word, int bits) {
  auto found = find_midi_value(word);
  const std::string name(word);
  if (!found) {
    const bool is_range = number_after("cc", word) >= 0 || number_after("nrpn", word) >= 0;
    return fail(is_range ? ErrorCode::value_out_of_range : ErrorCode::unknown_name,
                "MIDI has no value '" + name + "'" +
                    (is_range ? "; there are cc0 to cc119 and nrpn0 to nrpn16383"
                              : base::suggestion(word, kWords, kSynonyms)));
  }
  if (bits == 0 || bits == found->bits) return *found;
  if ((bits != 7 && bits != 14) || !has_choice_of_bits(*found)) {
    return fail(ErrorCode::value_out_of_range, name + " has " + std::to_string(found->bits) +
                                                   " bits, not " + std::to_string(bits) +
                                                   "; cc0 to cc31 and NRPN have 7 or 14");
  }
  found->bits = bits;
  return *found;
}

std::string midi_value_text(const MidiValueSpec& spec) {
  const std::string bits = spec.bits == 14 ? " (14 bit)" : "";
  switch (spec.kind) {
    case OutputKind::control:
      return "cc" + std::to_string(spec.number) + bits;
    case OutputKind::nrpn:
      return "nrpn" + std::to_string(spec.number) + bits;
    case OutputKind::pitch_bend:
      return "bend";
    case OutputKind::channel_pressure:
      return "pressure";
    default:
      return "poly_pressure";
  }
}

bool MidiValue::hear(const std::uint8_t (&bytes)[3]) KNOTWAVE_RT {
  const int one = bytes[1] & 127, two = bytes[2] & 127;
  completes_ = false;
  switch (static_cast<MidiStatus>(bytes[0] & 0xF0)) {
    case MidiStatus::control_change:
      return hear_control(one, two);
    case MidiStatus::pitch_bend:
      if (spec_.kind != OutputKind::pitch_bend) return false;
      step_ = two << 7 | one;
      return true;
    case MidiStatus::channel_pressure:
      if (spec_.kind != OutputKind::channel_pressure) return false;
      step_ = one;
      return true;
    case MidiStatus::poly_pressure:
      if (spec_.kind != OutputKind::poly_pressure) return false;
      step_ = two;
      return true;
    default:
      return false;
  }
}

bool MidiValue::hear_control(int control, int value) KNOTWAVE_RT {
  if (spec_.kind == OutputKind::nrpn) {
    const int selected = parameter_ == kNoParameter ? 0 : parameter_;
    if (control == kNrpnMsb) parameter_ = value << 7 | (selected & 127);
    if (control == kNrpnLsb) parameter_ = (selected & ~127) | value;
    if (control == kRpnMsb || control == kRpnLsb) parameter_ = kNoParameter;
    const bool is_low = spec_.bits == 14 && control == kDataEntryLsb;
    if (parameter_ != spec_.number || !(control == kDataEntryMsb || is_low)) return false;
    take_half(!is_low, value);
    return true;
  }
  if (spec_.kind != OutputKind::control) return false;
  const bool is_low = spec_.bits == 14 && control == spec_.number + 32;
  if (control != spec_.number && !is_low) return false;
  take_half(!is_low, value);
  return true;
}

void MidiValue::take_half(bool is_high, int value) KNOTWAVE_RT {
  if (is_high) {
    high_ = value;
    low_ = 0;
  } else {
    low_ = value;
  }
  completes_ = !is_high && was_high_;
  was_high_ = is_high;
  step_ = spec_.bits == 14 ? high_ << 7 | low_ : high_;
}

}  // namespace knotwave::engine
