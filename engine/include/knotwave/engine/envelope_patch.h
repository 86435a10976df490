// SPDX-License-Identifier: MIT
// A patch of the envelope generator as its file says it (kind "envelope"): what opens the gate, the
// curves that then play, and where their values go. Plain data. docs/envelope-format.md is the
// user's page of this. [control]
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/bank.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

inline constexpr int kMaxOutputs = 32;         ///< of a patch
inline constexpr int kMaxEnvelopeVoices = 32;  ///< of a patch
inline constexpr int kUsualEnvelopeVoices = 8;
inline constexpr int kMaxPlaceEvents = 16;  ///< of a patch
inline constexpr int kMaxOutputPorts = 16;  ///< of all patches together

/// What opens and closes the gate of a patch's envelopes.
struct TriggerSpec {
  enum class Kind {
    note,   ///< a key; mode and priority of the patch say which of several
    gate,   ///< a controller: open from `threshold` on
    clock,  ///< every `beats` of the tempo, open for `gate_share` of them; from a MIDI clock while
            ///< one runs
    loop,   ///< open from the start to the end
  };
  Kind kind = Kind::note;
  int channel = 0;                  ///< 1..16; 0: every channel
  int key_low = 0, key_high = 127;  ///< note
  int control = 64;                 ///< gate: 0..119; 64 is the sustain pedal
  int threshold = 64;               ///< gate: 1..127
  double beats = 1;                 ///< clock: quarter notes, 1/96..1024
  double offset_beats = 0;          ///< clock: 0..beats
  double gate_share = 0.5;          ///< clock: 0..1
  int program = -1;  ///< 0..127: only while the channel's program is this one; -1: always. Keys
                     ///< held when it changes play on until they are let go
};

enum class OutputKind {
  control,     ///< CC `number`; bits 14: its lower half follows by CC number + 32
  nrpn,        ///< parameter `number` by CC 99, 98, 6 and, bits 14, 38; null (127/127) after
               ///< `kNrpnNullSeconds` without another value
  pitch_bend,  ///< 14 bits
  channel_pressure,
  poly_pressure,  ///< of the key that opened the gate
  osc,            ///< one number to an address
  voltage,        ///< an audio channel
};

/// Where a value goes.
struct OutputSpec {
  MapSource source = MapSource::envelope;  ///< envelope, lfo or free_number
  int source_index = 0;
  OutputKind kind = OutputKind::control;
  std::string port;  ///< of MIDI: a name of [ports], or "": the first, else the program's own
  int channel = 1;   ///< 1..16; 0: that of the note (with NoteOutput::mpe the one it was given)
  int number = 0;    ///< CC 0..119 (bits 14: 0..31), NRPN 0..16383, voltage: audio channel from 1
  int bits = 7;      ///< 7 or 14
  std::string address;  ///< osc
  /// The source's values `of_low..of_high` become `low..high`, clamped beyond. Units of low and
  /// high: steps (0..127 or 0..16383, bend -8192..8191), volts, or what the OSC address expects.
  double of_low = 0, of_high = 1;
  double low = 0, high = 127;
  std::string curve;    ///< 0..1 over 0..1 between the two; "": straight
  double rest = 0;      ///< where it is left on exit and before the first gate, as low and high
  double osc_hz = 200;  ///< osc: values a second at most
};

/// Something told when an envelope passes a place.
struct PlaceEventSpec {
  enum class At { place, end, loop };  ///< a place of the curve; its end; every time round the loop
  enum class Kind { note, voltage };
  int envelope = 0;
  At at = At::end;
  double place_u = 0;
  Kind kind = Kind::note;
  std::string port;
  int channel = 1, key = 60, velocity = 100;
  int voltage_channel = 1;
  double volts = 5;
  double length_s = 0.01;
};

/// What becomes of the notes that come in.
enum class NoteOutput {
  off,
  thru,  ///< as they are
  mpe,   ///< each on a member channel of its own, 2..16; the envelope's outputs follow it
};

/// A MIDI output.
struct PortSpec {
  std::string name;    ///< in the patch
  std::string device;  ///< part of a port's name; "": a port of our own
  enum class Wire { none, usb, din } wire = Wire::usb;
  bool running_status = true;  ///< counted on, with Wire::din
};

struct EnvelopePatchSpec {
  /// Curves, envelopes, LFOs, maps, free numbers, mode, polyphony, seed; PatchSpec::has_sound is
  /// false.
  PatchSpec patch;
  TriggerSpec trigger;
  NoteOutput notes = NoteOutput::off;
  std::string notes_port;
  std::vector<PortSpec> ports;
  std::vector<OutputSpec> outputs;
  std::vector<PlaceEventSpec> place_events;
  /// The file and every file it names, as they were read.
  std::vector<FileText> texts;
};

/// Reads a patch and every file it names. Errors: those of read_bank(); unsupported (a kind that is
/// no envelope: the message says which program plays it); unknown_name; value_out_of_range;
/// malformed (no outputs and no events; keys that do not go together); all with file, line and
/// column.
Result<EnvelopePatchSpec> read_envelope_patch(const std::string& path);
/// The same from texts in place of the disk, as read_bank() does it.
Result<EnvelopePatchSpec> read_envelope_patch(const std::string& path,
                                              std::span<const FileText> texts);
/// From text; files are looked up beside `source_name`. For tests and fuzzers.
Result<EnvelopePatchSpec> parse_envelope_patch(std::string_view text, std::string_view source_name);

}  // namespace knotwave::engine
