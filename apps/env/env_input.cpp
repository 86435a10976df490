// SPDX-License-Identifier: MIT
#include "env_input.h"

#include <algorithm>
#include <utility>

#include "bank_input/patch_warnings.h"

namespace knotwave::env {
namespace {

using engine::OutputKind;

bool is_midi(OutputKind kind) { return kind != OutputKind::osc && kind != OutputKind::voltage; }

bool is_in_steps(const engine::OutputSpec& output) {
  return output.kind == OutputKind::channel_pressure || output.kind == OutputKind::poly_pressure ||
         ((output.kind == OutputKind::control || output.kind == OutputKind::nrpn) &&
          output.bits == 7);
}

bool sends(const engine::EnvelopePatchSpec& patch, OutputKind kind) {
  return std::any_of(patch.outputs.begin(), patch.outputs.end(),
                     [kind](const auto& output) { return output.kind == kind; });
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
    if (!is_in_steps(first)) {
      first.low = 0;
      first.high = 127;
      first.rest = 0;
    }
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
