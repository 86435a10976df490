// SPDX-License-Identifier: MIT
// Ports of one name become one port, outputs become lanes.
#include "generator_routes.h"

#include <algorithm>
#include <string>

namespace knotwave::engine {
namespace {

bool is_same(const PortSpec& a, const PortSpec& b) {
  return a.device == b.device && a.wire == b.wire && a.running_status == b.running_status;
}

Result<int> place_port(std::vector<PortSpec>& ports, const PortSpec& wanted) {
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (ports[i].name != wanted.name) continue;
    if (is_same(ports[i], wanted)) return static_cast<int>(i);
    return fail(ErrorCode::control_conflict,
                "port '" + wanted.name +
                    "' is in two patches that differ in its device, wire or running_status");
  }
  if (ports.size() >= static_cast<std::size_t>(kMaxOutputPorts)) {
    return fail(
        ErrorCode::value_out_of_range,
        "the patches have more than " + std::to_string(kMaxOutputPorts) + " ports together");
  }
  ports.push_back(wanted);
  return static_cast<int>(ports.size()) - 1;
}

bool is_midi(OutputKind kind) { return kind != OutputKind::osc && kind != OutputKind::voltage; }
bool has_number(OutputKind kind) { return kind == OutputKind::control || kind == OutputKind::nrpn; }

/// Controllers that one output occupies: a value of 14 bits has two.
bool share_a_controller(const OutputSpec& a, const OutputSpec& b) {
  if (a.number == b.number) return true;
  if (a.kind == OutputKind::nrpn) return false;
  return (a.bits == 14 && a.number + 32 == b.number) || (b.bits == 14 && b.number + 32 == a.number);
}

bool meet(const GeneratorRoute& a, const GeneratorRoute& b) {
  if (a.spec.kind != b.spec.kind) return false;
  if (a.spec.kind == OutputKind::osc) return a.spec.address == b.spec.address;
  if (a.port != b.port) return false;
  if (a.spec.kind == OutputKind::voltage) return a.spec.number == b.spec.number;
  if (a.spec.channel != b.spec.channel) return false;
  return !has_number(a.spec.kind) || share_a_controller(a.spec, b.spec);
}

bool is_one_lane(const GeneratorRoute& a, const GeneratorRoute& b) {
  return a.spec.bits == b.spec.bits && a.spec.number == b.spec.number && !a.is_per_voice &&
         !b.is_per_voice && is_midi(a.spec.kind);
}

/// A program change chooses between them.
bool take_turns(const EnvelopePatchSpec& a, const EnvelopePatchSpec& b) {
  return a.trigger.program >= 0 && b.trigger.program >= 0 && a.trigger.program != b.trigger.program;
}

/// Patches of one name are told apart by their files.
std::string output_words(const GeneratorRoute& route, const PatchSpec& patch,
                         const PatchSpec& other) {
  const bool is_alike = patch.name == other.name && !patch.source_name.empty();
  return "output " + std::to_string(route.output + 1) + " of '" + patch.name + "'" +
         (is_alike ? " (" + patch.source_name + ")" : "");
}

void add_lanes(GeneratorRoutes& table, GeneratorRoute& route, int index, int voices) {
  route.first_lane = static_cast<int>(table.lanes.size());
  route.lanes = route.is_per_voice ? voices : 1;
  for (int i = 0; i < route.lanes; ++i) {
    GeneratorLane lane;
    lane.port = route.port;
    lane.voice = route.is_per_voice ? i : -1;
    lane.routes = {index};
    table.lanes.push_back(lane);
  }
}

}  // namespace

int GeneratorRoutes::port(int patch, const EnvelopePatchSpec& spec, const std::string& name) const {
  const std::vector<int>& own = ports_of_patches[static_cast<std::size_t>(patch)];
  for (std::size_t i = 0; i < spec.ports.size(); ++i) {
    if (spec.ports[i].name == name) return own[i];
  }
  return own.front();
}

Result<GeneratorRoutes> GeneratorRoutes::create(
    std::span<const EnvelopePatchProgram* const> patches, std::span<const int> voices) {
  GeneratorRoutes table;
  for (const EnvelopePatchProgram* patch : patches) {
    std::vector<int> own;
    std::vector<PortSpec> wanted = patch->spec().ports;
    if (wanted.empty()) wanted.emplace_back();  // one of our own
    for (const PortSpec& port : wanted) {
      const auto placed = place_port(table.ports, port);
      if (!placed) return placed.error();
      own.push_back(*placed);
    }
    table.ports_of_patches.push_back(own);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const EnvelopePatchSpec& spec = patches[p]->spec();
    for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
      GeneratorRoute route;
      route.patch = static_cast<int>(p);
      route.output = static_cast<int>(o);
      route.spec = spec.outputs[o];
      if (is_midi(route.spec.kind)) route.port = table.port(route.patch, spec, route.spec.port);
      const bool follows_notes =
          route.spec.channel == 0 || route.spec.kind == OutputKind::poly_pressure;
      route.is_per_voice = is_midi(route.spec.kind) && follows_notes;
      const int index = static_cast<int>(table.routes.size());
      for (const GeneratorRoute& other : table.routes) {
        if (!meet(route, other)) continue;
        const EnvelopePatchSpec& others = patches[static_cast<std::size_t>(other.patch)]->spec();
        if (take_turns(spec, others)) {
          if (is_one_lane(route, other)) {
            route.first_lane = other.first_lane;
            route.lanes = 1;
          }
          continue;
        }
        return fail(ErrorCode::control_conflict, output_words(route, spec.patch, others.patch) +
                                                     " and " +
                                                     output_words(other, others.patch, spec.patch) +
                                                     " go to the same destination");
      }
      if (route.first_lane >= 0) {
        table.lanes[static_cast<std::size_t>(route.first_lane)].routes.push_back(index);
      } else if (route.port >= 0) {
        add_lanes(table, route, index, voices[p]);
      }
      table.routes.push_back(route);
    }
  }
  return table;
}

}  // namespace knotwave::engine
