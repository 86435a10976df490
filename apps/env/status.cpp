// SPDX-License-Identifier: MIT
#include "status.h"

#include <array>
#include <charconv>
#include <cmath>

#include "knotwave/base/document.h"

namespace knotwave::env {
namespace {

using engine::MapSource;
using engine::OutputKind;
using engine::TriggerSpec;

std::string channel_text(int channel) {
  return channel == 0 ? "any ch" : "ch" + std::to_string(channel);
}

std::string name_of(const std::string& name, const std::string& curve) {
  return name == curve ? name : name + "." + curve;
}

/// The places it repeats between or holds at, if it does.
std::string places_text(const dsp::EnvelopeSpec& spec) {
  using base::number_text;
  if (spec.loop_end_u > spec.loop_start_u) {
    return " (loop " + number_text(spec.loop_start_u) + ".." + number_text(spec.loop_end_u) + ")";
  }
  return spec.sustain_u >= 0 ? " (sustain " + number_text(spec.sustain_u) + ")" : "";
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return value < 0 ? "-inf" : "inf";
  std::array<char, 400> text;
  const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value,
                                         std::chars_format::fixed, decimals);
  return {text.data(), end};
}

std::string trigger_text(const TriggerSpec& trigger) {
  switch (trigger.kind) {
    case TriggerSpec::Kind::note:
      return channel_text(trigger.channel) + " note";
    case TriggerSpec::Kind::gate:
      return channel_text(trigger.channel) + " CC" + std::to_string(trigger.control);
    case TriggerSpec::Kind::clock:
      return "every " + base::number_text(trigger.beats) +
             (trigger.beats == 1 ? " beat" : " beats");
    default:
      return "always";
  }
}

std::string source_text(const engine::EnvelopePatchSpec& spec, const engine::OutputSpec& output) {
  const auto index = static_cast<std::size_t>(output.source_index);
  const engine::PatchSpec& patch = spec.patch;
  if (output.source == MapSource::envelope && index < patch.envelopes.size()) {
    const engine::EnvelopeUse& envelope = patch.envelopes[index];
    return name_of(envelope.name, envelope.curve) + places_text(envelope.spec);
  }
  if (output.source == MapSource::lfo && index < patch.lfos.size()) {
    return name_of(patch.lfos[index].name, patch.lfos[index].curve);
  }
  if (index < patch.free_numbers.size()) return "free." + patch.free_numbers[index];
  return "?";
}

std::string source_name(const engine::EnvelopePatchSpec& spec, const engine::OutputSpec& output) {
  const auto index = static_cast<std::size_t>(output.source_index);
  const engine::PatchSpec& patch = spec.patch;
  if (output.source == MapSource::envelope && index < patch.envelopes.size()) {
    return patch.envelopes[index].name;
  }
  if (output.source == MapSource::lfo && index < patch.lfos.size()) return patch.lfos[index].name;
  return source_text(spec, output);
}

std::string destination_text(const engine::OutputSpec& output) {
  const std::string channel =
      output.channel == 0 ? " ch of the note" : " ch" + std::to_string(output.channel);
  const std::string number = std::to_string(output.number);
  switch (output.kind) {
    case OutputKind::control:
      return "CC" + number + (output.bits == 14 ? " 14 bit" : "") + channel;
    case OutputKind::nrpn:
      return "NRPN" + number + channel;
    case OutputKind::pitch_bend:
      return "bend" + channel;
    case OutputKind::channel_pressure:
      return "pressure" + channel;
    case OutputKind::poly_pressure:
      return "poly pressure" + channel;
    case OutputKind::osc:
      return output.address;
    default:
      return "CV " + number;
  }
}

std::string route_line(const engine::EnvelopePatchSpec& patch, const engine::RouteStatus& route,
                       const std::string& in, const std::string& port) {
  const engine::OutputSpec& output = patch.outputs[static_cast<std::size_t>(route.output)];
  const bool is_song = patch.trigger.kind == TriggerSpec::Kind::clock ||
                       patch.trigger.kind == TriggerSpec::Kind::loop;
  std::string line = "IN " + (is_song || in.empty() ? "" : in + " ") + trigger_text(patch.trigger) +
                     " -> " + source_text(patch, output) + " -> " + destination_text(output);
  if (route.port < 0) return line + " = " + fixed(route.value, 3);
  line += " " + port + " " + fixed(route.bytes_per_second, 0) + " B/s";
  return route.share > 0 ? line + " " + fixed(route.share * 100, 0) + " %" : line;
}

}  // namespace knotwave::env
