// SPDX-License-Identifier: MIT
#include "knotwave/engine/envelope_patch_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/suggest.h"
#include "knotwave/curves/compile.h"

#include "envelope_patch_limits.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr int kMpeMembers = 15;

Error placed(Error error, const EnvelopePatchSpec& spec, const std::string& path,
             const std::string& part) {
  if (error.source.empty()) {
    const Place place = spec.patch.place_of(path);
    error.source = spec.patch.source_name;
    error.line = place.line;
    error.column = place.column;
  }
  if (!part.empty()) error.message = part + ": " + error.message;
  if (!spec.patch.name.empty()) {
    error.message = "patch '" + spec.patch.name + "': " + error.message;
  }
  return error;
}

Error out_of_range(const char* what, double value, double low, double high) {
  return fail(ErrorCode::value_out_of_range, std::string(what) + " is " + base::number_text(value) +
                                                 "; it must be from " + base::number_text(low) +
                                                 " to " + base::number_text(high));
}

Result<void> within(const char* what, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return out_of_range(what, value, low, high);
}

Result<void> first_error(std::initializer_list<Result<void>> all) {
  for (const Result<void>& one : all) {
    if (!one) return one;
  }
  return {};
}

Result<void> check_count(const char* what, std::size_t count, int most) {
  if (count <= static_cast<std::size_t>(most)) return {};
  return fail(ErrorCode::value_out_of_range, std::to_string(count) + " " + what + "; at most " +
                                                 std::to_string(most) + " are possible");
}

Result<void> check_port(const EnvelopePatchSpec& spec, const std::string& name) {
  if (name.empty() || has_name(spec.ports, name)) return {};
  return fail(ErrorCode::unknown_name,
              "there is no port '" + name + "'" + base::suggestion(name, names_of(spec.ports)));
}

Result<void> check_trigger(const TriggerSpec& trigger) {
  return first_error(
      {within("channel", trigger.channel, 0, 16), within("key_low", trigger.key_low, 0, 127),
       within("key_high", trigger.key_high, trigger.key_low, 127),
       within("control", trigger.control, 0, kLastControl),
       within("threshold", trigger.threshold, 1, 127),
       within("beats", trigger.beats, 1.0 / 96, 1024),
       within("offset_beats", trigger.offset_beats, 0, trigger.beats),
       within("gate", trigger.gate_share, 0, 1), within("program", trigger.program, -1, 127)});
}

Result<void> check_whole(const EnvelopePatchSpec& spec) {
  if (auto ok = check_count("outputs", spec.outputs.size(), kMaxOutputs); !ok) return ok;
  if (auto ok = check_count("events", spec.place_events.size(), kMaxPlaceEvents); !ok) return ok;
  if (auto ok = check_count("ports", spec.ports.size(), kMaxOutputPorts); !ok) return ok;
  if (spec.patch.has_sound) {
    return fail(ErrorCode::unsupported, "an envelope patch makes no sound (PatchSpec::has_sound)");
  }
  if (auto ok = within("polyphony", spec.patch.polyphony, 1, kMaxEnvelopeVoices); !ok) return ok;
  if (auto ok = check_port(spec, spec.notes_port); !ok) return ok;
  if (spec.notes != NoteOutput::mpe) return {};
  if (spec.trigger.kind != TriggerSpec::Kind::note || spec.patch.mode != PlayMode::poly) {
    return fail(ErrorCode::unsupported,
                "notes to MPE channels need notes that come in, played poly");
  }
  if (spec.patch.polyphony <= kMpeMembers) return {};
  return fail(ErrorCode::unsupported, "polyphony is " + std::to_string(spec.patch.polyphony) +
                                          ", but MPE has channels for " +
                                          std::to_string(kMpeMembers) + " notes");
}

Result<void> check_source(const PatchSpec& patch, const OutputSpec& output) {
  const std::size_t count = output.source == MapSource::envelope      ? patch.envelopes.size()
                            : output.source == MapSource::lfo         ? patch.lfos.size()
                            : output.source == MapSource::free_number ? patch.free_numbers.size()
                                                                      : 0;
  if (output.source_index >= 0 && static_cast<std::size_t>(output.source_index) < count) return {};
  return fail(ErrorCode::unknown_name, "its source " + std::to_string(output.source_index) +
                                           " does not exist; there are " + std::to_string(count));
}

Result<void> check_output(const EnvelopePatchSpec& spec, const OutputSpec& output) {
  const OutputLimits limits = limits_of(output);
  const bool is_fine = output.kind == OutputKind::control && output.bits == 14;
  const int last_number = output.kind == OutputKind::control
                              ? (is_fine ? kLastFineControl : kLastControl)
                          : output.kind == OutputKind::nrpn    ? kLastNrpn
                          : output.kind == OutputKind::voltage ? kMaxVoltageChannels
                                                               : 127;
  const int first_number = output.kind == OutputKind::voltage ? 1 : 0;
  if (output.bits != 7 && output.bits != 14) return out_of_range("bits", output.bits, 7, 14);
  if (!(output.of_low < output.of_high)) {
    return fail(ErrorCode::value_out_of_range, "of (" + base::number_text(output.of_low) + " to " +
                                                   base::number_text(output.of_high) +
                                                   ") does not rise");
  }
  if (output.kind == OutputKind::osc && !is_osc_address(output.address)) {
    return fail(ErrorCode::malformed, "'" + output.address + "' is no OSC address");
  }
  return first_error({check_source(spec.patch, output), check_port(spec, output.port),
                      within("channel", output.channel, 0, 16),
                      within("its number", output.number, first_number, last_number),
                      within("range", output.low, limits.low, limits.high),
                      within("range", output.high, limits.low, limits.high),
                      within("rest", output.rest, limits.low, limits.high),
                      within("rate_hz", output.osc_hz, 1, kMostOscHz)});
}

Result<void> check_event(const EnvelopePatchSpec& spec, const EnvelopePatchProgram& program,
                         const PlaceEventSpec& event) {
  const auto envelopes = program.patch().envelopes();
  const auto index = static_cast<std::size_t>(event.envelope);
  if (event.envelope < 0 || index >= envelopes.size()) {
    return fail(ErrorCode::unknown_name, "its envelope " + std::to_string(event.envelope) +
                                             " does not exist; there are " +
                                             std::to_string(envelopes.size()));
  }
  const dsp::EnvelopeProgram& envelope = envelopes[index].program;
  if (event.at == PlaceEventSpec::At::loop && !envelope.has_loop()) {
    return fail(ErrorCode::malformed, "envelope '" + envelopes[index].name + "' has no loop");
  }
  const bool has_place = event.at == PlaceEventSpec::At::place;
  return first_error({check_port(spec, event.port),
                      within("at", has_place ? event.place_u : envelope.program().u_min(),
                             envelope.program().u_min(), envelope.program().u_max()),
                      within("channel", event.channel, 1, 16), within("note", event.key, 0, 127),
                      within("velocity", event.velocity, 1, 127),
                      within("gate", event.voltage_channel, 1, kMaxVoltageChannels),
                      within("volts", event.volts, -kMostVolts, kMostVolts),
                      within("seconds", event.length_s, kLeastEventSeconds, kMostEventSeconds)});
}

/// The curve between `of` and `range`: from 0 to 1, and none that a map moves.
Result<curves::CurveProgram> compile_law(const PatchSpec& patch, const std::string& name) {
  const curves::NurbsCurve* curve = patch.curves.find_curve(name);
  if (curve == nullptr) {
    return fail(ErrorCode::unknown_name,
                "no curve '" + name + "'" + base::suggestion(name, patch.curves.names()));
  }
  for (const MapSpec& map : patch.maps) {
    if (!map.enabled || !moves_a_number(map) || map.target_curve != name) continue;
    return fail(ErrorCode::unsupported,
                "a map moves a number of curve '" + name +
                    "'; an output's curve stands still. A map to a free number can have a curve "
                    "that moves");
  }
  auto law = curves::compile_function(*curve);
  if (law && (law->u_min() != 0 || law->u_max() != 1)) {
    return fail(ErrorCode::value_out_of_range,
                "curve '" + name + "' runs from " + base::number_text(law->u_min()) + " to " +
                    base::number_text(law->u_max()) + "; an output's curve runs from 0 to 1");
  }
  return law;
}

}  // namespace

void EnvelopePatchProgram::Output::values(std::span<const double> source, std::span<double> out,
                                          curves::CurveCursor& cursor) const KNOTWAVE_RT {
  constexpr std::size_t kPart = 64;
  std::array<double, kPart> places, shaped;
  const auto [least, most] = std::minmax(spec.low, spec.high);
  for (std::size_t done = 0; done < source.size(); done += kPart) {
    const std::size_t n = std::min(kPart, source.size() - done);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = (source[done + i] - spec.of_low) / (spec.of_high - spec.of_low);
      places[i] = x > 0 ? std::min(x, 1.0) : 0.0;
    }
    if (curve) {
      curve->render(std::span<const double>(places).first(n), std::span(shaped).first(n), cursor);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double y = curve ? shaped[i] : places[i];
      const double moved = y < 1 ? spec.low + (spec.high - spec.low) * std::max(y, 0.0) : spec.high;
      const double x = source[done + i];
      out[done + i] = x == x ? std::clamp(moved, least, most) : spec.rest;
    }
  }
}

double EnvelopePatchProgram::Output::value(double source,
                                           curves::CurveCursor& cursor) const KNOTWAVE_RT {
  double number = 0;
  values(std::span<const double>(&source, 1), std::span<double>(&number, 1), cursor);
  return number;
}

Result<std::unique_ptr<const EnvelopePatchProgram>> EnvelopePatchProgram::create(
    const EnvelopePatchSpec& spec) {
  std::unique_ptr<EnvelopePatchProgram> program(new EnvelopePatchProgram);
  if (auto ok = check_whole(spec); !ok) return placed(ok.error(), spec, "", "");
  if (auto ok = check_trigger(spec.trigger); !ok) {
    return placed(ok.error(), spec, "trigger", "trigger");
  }
  auto patch = PatchProgram::create(spec.patch);
  if (!patch) return patch.error();
  program->spec_ = spec;
  program->patch_ = *std::move(patch);
  for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
    const std::string path = "outputs." + std::to_string(i);
    const std::string part = "output " + std::to_string(i + 1);
    Output output{spec.outputs[i], {}};
    if (auto ok = check_output(spec, output.spec); !ok) return placed(ok.error(), spec, path, part);
    if (!output.spec.curve.empty()) {
      auto law = compile_law(spec.patch, output.spec.curve);
      if (!law) return placed(law.error(), spec, path + ".curve", part);
      output.curve = *std::move(law);
    }
    program->hears_lfo_ |= output.spec.source == MapSource::lfo;
    program->outputs_.push_back(std::move(output));
  }
  for (const PatchProgram::MapPart& map : program->patch_->maps()) {
    program->hears_lfo_ |= map.source == MapSource::lfo || map.source_v == MapSource::lfo;
  }
  for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
    if (auto ok = check_event(spec, *program, spec.place_events[i]); !ok) {
      return placed(ok.error(), spec, "events." + std::to_string(i),
                    "event " + std::to_string(i + 1));
    }
  }
  return std::unique_ptr<const EnvelopePatchProgram>(std::move(program));
}

}  // namespace knotwave::engine
