// SPDX-License-Identifier: MIT
#include "env_input.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bank_input/patch_warnings.h"

namespace knotwave::env {
namespace {

using engine::OutputKind;

bool is_midi(OutputKind kind) { return kind != OutputKind::osc && kind != OutputKind::voltage; }

/// The full scale of what a destination of MIDI takes; nothing for OSC and voltages.
std::optional<std::pair<double, double>> scale_of(const engine::OutputSpec& output) {
  if (output.kind == OutputKind::pitch_bend) return std::pair(-8192.0, 8191.0);
  if (!is_midi(output.kind)) return std::nullopt;
  return std::pair(0.0, output.bits == 14 ? 16383.0 : 127.0);
}

/// `range` and `rest` as steps of a controller: the same share of the full scale; of OSC and
/// voltages, which have none, `range` becomes all there is.
void scale_to_control(engine::OutputSpec& output) {
  const auto [least, most] = scale_of(output).value_or(std::minmax({output.low, output.high}));
  const auto step = [least = least, most = most](double value) {
    if (most <= least) return 0.0;
    return std::clamp(std::floor((value - least) / (most - least) * 127 + 0.5), 0.0, 127.0);
  };
  output.low = step(output.low);
  output.high = step(output.high);
  output.rest = step(output.rest);
}

bool sends(const engine::EnvelopePatchSpec& patch, OutputKind kind) {
  return std::any_of(patch.outputs.begin(), patch.outputs.end(),
                     [kind](const auto& output) { return output.kind == kind; });
}

/// Options for voltages, where no patch has any.
Result<void> check_voltage_options(const EnvOptions& options, const EnvInput& input) {
  if (!input.voltage_patches().empty()) return {};
  const std::pair<bool, const char*> given[] = {
      {options.direct_current, "--cv"},
      {!options.calibration.empty(), "--calibration"},
      {!options.audio_api.empty(), "--audio-api"},
      {!options.audio_device.empty(), "--audio-device"},
  };
  for (const auto& [is_given, name] : given) {
    if (!is_given) continue;
    return fail(ErrorCode::usage, std::string(name) +
                                      " is for control voltage, and no patch has an output to = "
                                      "\"cv\" or an event with a gate");
  }
  return {};
}

}  // namespace

std::vector<const engine::EnvelopePatchProgram*> EnvInput::patches() const {
  std::vector<const engine::EnvelopePatchProgram*> all;
  for (const auto& program : programs) all.push_back(program.get());
  return all;
}

bool EnvInput::has_osc() const {
  return std::any_of(programs.begin(), programs.end(),
                     [](const auto& program) { return sends(program->spec(), OutputKind::osc); });
}

std::vector<const engine::EnvelopePatchProgram*> EnvInput::voltage_patches() const {
  std::vector<const engine::EnvelopePatchProgram*> all;
  for (const auto& program : programs) {
    const auto& events = program->spec().place_events;
    const bool has_gate = std::any_of(events.begin(), events.end(), [](const auto& event) {
      return event.kind == engine::PlaceEventSpec::Kind::voltage;
    });
    if (has_gate || sends(program->spec(), OutputKind::voltage)) all.push_back(program.get());
  }
  return all;
}

void redirect(const EnvOptions& options, engine::EnvelopePatchSpec& patch) {
  if (options.control >= 0 && !patch.outputs.empty()) {
    engine::OutputSpec& first = patch.outputs.front();
    scale_to_control(first);
    first.kind = OutputKind::control;
    first.number = options.control;
    first.bits = 7;
  }
  if (options.channel == 0) return;
  for (engine::OutputSpec& output : patch.outputs) {
    if (is_midi(output.kind)) output.channel = options.channel;
  }
}

Result<EnvInput> read_input(const EnvOptions& options) {
  EnvInput input;
  for (const std::string& path : options.patches) {
    auto spec = engine::read_envelope_patch(path);
    if (!spec) return std::move(spec).error();
    for (std::string& line : bank_input::patch_warnings(*spec)) {
      input.warnings.push_back(std::move(line));
    }
    redirect(options, *spec);
    auto program = engine::EnvelopePatchProgram::create(*spec);
    if (!program) {
      Error error = std::move(program).error();
      if (error.source.empty()) error.source = path;
      return error;
    }
    input.programs.push_back(std::move(*program));
  }
  if (const auto fine = check_voltage_options(options, input); !fine) return fine.error();
  return input;
}

Result<std::unique_ptr<engine::EnvelopeGenerator>> make_generator(const EnvOptions& options,
                                                                  const EnvInput& input) {
  engine::EnvelopeGeneratorConfig config;
  config.rate_hz = kClockHz;
  config.seed = options.seed;
  config.thru = options.thru;
  config.bpm = options.bpm;
  config.lead_s = std::min(config.lead_s, options.latency_ms * 0.5e-3);
  return engine::EnvelopeGenerator::create(config, input.patches());
}

SentNames names_of(const engine::EnvelopeGenerator& generator, const EnvInput& input) {
  SentNames names;
  for (const engine::PortSpec& port : generator.ports()) {
    names.ports.push_back(port.name.empty() ? "out" : port.name);
  }
  for (const auto& program : input.programs) {
    auto& addresses = names.addresses.emplace_back();
    for (const auto& output : program->spec().outputs) addresses.push_back(output.address);
  }
  return names;
}

}  // namespace knotwave::env
