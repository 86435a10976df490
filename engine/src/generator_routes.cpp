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

/// One output of one patch, as far as others may meet it.
struct Sender {
  const GeneratorRoute& route;
  const EnvelopePatchSpec& patch;
  const OutputSpec& spec() const { return route.spec; }
};

/// The channels it may speak on, a bit each. That of the note is any that the trigger hears; under
/// MPE those of a zone's members come with it, which nobody knows beforehand.
unsigned channels_of(const Sender& sender) {
  if (sender.spec().channel != 0) return 1u << (sender.spec().channel - 1);
  constexpr unsigned kMembers = 0xFFFE, kAll = 0xFFFF;
  if (sender.patch.notes == NoteOutput::mpe) return kMembers;
  const int heard = sender.patch.trigger.channel;
  return heard == 0 ? kAll : 1u << (heard - 1);
}

/// Controllers that one output occupies: a value of 14 bits has two.
bool share_a_controller(const OutputSpec& a, const OutputSpec& b) {
  if (a.number == b.number) return true;
  if (a.kind == OutputKind::nrpn) return false;
  return (a.bits == 14 && a.number + 32 == b.number) || (b.bits == 14 && b.number + 32 == a.number);
}

bool share_a_key(const TriggerSpec& a, const TriggerSpec& b) {
  return a.key_low <= b.key_high && b.key_low <= a.key_high;
}

/// Both may speak on one cable and channel.
bool share_a_channel(const Sender& a, const Sender& b) {
  return a.route.port >= 0 && a.route.port == b.route.port &&
         (channels_of(a) & channels_of(b)) != 0;
}

bool meet(const Sender& a, const Sender& b) {
  if (a.spec().kind != b.spec().kind) return false;
  if (a.spec().kind == OutputKind::osc) return a.spec().address == b.spec().address;
  if (a.spec().kind == OutputKind::voltage) return a.spec().number == b.spec().number;
  if (!share_a_channel(a, b)) return false;
  if (a.spec().kind == OutputKind::poly_pressure) {
    return share_a_key(a.patch.trigger, b.patch.trigger);
  }
  return !has_number(a.spec().kind) || share_a_controller(a.spec(), b.spec());
}

/// Controllers that a parameter is chosen and set by: data entry, its steps, and the choice.
bool is_data_entry(int control) {
  return control == 6 || control == 38 || (control >= 96 && control <= 101);
}

/// `a` is a parameter, and `b` a controller that parameters are sent by.
bool disturbs(const Sender& a, const Sender& b) {
  return a.spec().kind == OutputKind::nrpn && b.spec().kind == OutputKind::control &&
         is_data_entry(b.spec().number) && share_a_channel(a, b);
}

bool is_one_lane(const GeneratorRoute& a, const GeneratorRoute& b) {
  return a.spec.bits == b.spec.bits && a.spec.number == b.spec.number && !a.is_per_voice &&
         !b.is_per_voice && is_midi(a.spec.kind);
}

/// A program change chooses between them.
bool take_turns(const EnvelopePatchSpec& a, const EnvelopePatchSpec& b) {
  return a.trigger.program >= 0 && b.trigger.program >= 0 && a.trigger.program != b.trigger.program;
}

/// "output 1 of 'Swell'". Patches of one name are told apart by their files.
std::string words_of(const Sender& sender, const Sender& other) {
  const PatchSpec& patch = sender.patch.patch;
  const bool is_alike = patch.name == other.patch.patch.name && !patch.source_name.empty();
  return "output " + std::to_string(sender.route.output + 1) + " of '" + patch.name + "'" +
         (is_alike ? " (" + patch.source_name + ")" : "");
}

Error same_destination(const Sender& a, const Sender& b) {
  std::string message = words_of(a, b) + " and " + words_of(b, a) + " go to the same destination";
  const bool one_follows_notes = (a.spec().channel == 0) != (b.spec().channel == 0);
  if (one_follows_notes) {
    message +=
        ": the note's channel may be the other's; a 'channel' in [trigger] can keep them apart";
  }
  return fail(ErrorCode::control_conflict, message);
}

Error disturbed(const Sender& parameter, const Sender& control) {
  return fail(ErrorCode::control_conflict,
              words_of(parameter, control) +
                  " is an NRPN, which is sent by controllers 6, 38 and 98 "
                  "to 101 of its channel; " +
                  words_of(control, parameter) + " is controller " +
                  std::to_string(control.spec().number) + " there");
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

namespace {

Result<void> place_ports(GeneratorRoutes& table,
                         std::span<const EnvelopePatchProgram* const> patches) {
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
  return {};
}

GeneratorRoute route_of(const GeneratorRoutes& table, const EnvelopePatchSpec& spec,
                        std::size_t patch, std::size_t output) {
  GeneratorRoute route;
  route.patch = static_cast<int>(patch);
  route.output = static_cast<int>(output);
  route.spec = spec.outputs[output];
  if (is_midi(route.spec.kind)) route.port = table.port(route.patch, spec, route.spec.port);
  const bool follows_notes =
      route.spec.channel == 0 || route.spec.kind == OutputKind::poly_pressure;
  route.is_per_voice = is_midi(route.spec.kind) && follows_notes;
  return route;
}

/// Against all routes before it. Where programs choose between two that are alike, they share a
/// lane.
Result<void> find_place(const GeneratorRoutes& table, GeneratorRoute& route,
                        std::span<const EnvelopePatchProgram* const> patches) {
  const auto spec_of = [&](const GeneratorRoute& one) -> const EnvelopePatchSpec& {
    return patches[static_cast<std::size_t>(one.patch)]->spec();
  };
  for (const GeneratorRoute& other : table.routes) {
    const Sender a{route, spec_of(route)}, b{other, spec_of(other)};
    if (disturbs(a, b)) return disturbed(a, b);
    if (disturbs(b, a)) return disturbed(b, a);
    if (!meet(a, b)) continue;
    if (!take_turns(a.patch, b.patch)) return same_destination(a, b);
    if (!is_one_lane(route, other)) continue;
    route.first_lane = other.first_lane;
    route.lanes = 1;
  }
  return {};
}

}  // namespace

Result<GeneratorRoutes> GeneratorRoutes::create(
    std::span<const EnvelopePatchProgram* const> patches, std::span<const int> voices) {
  GeneratorRoutes table;
  if (auto placed = place_ports(table, patches); !placed) return placed.error();
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const EnvelopePatchSpec& spec = patches[p]->spec();
    for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
      GeneratorRoute route = route_of(table, spec, p, o);
      if (auto placed = find_place(table, route, patches); !placed) return placed.error();
      const int index = static_cast<int>(table.routes.size());
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
