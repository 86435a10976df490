// SPDX-License-Identifier: MIT
// What is shown of a generator that plays: a line for each route.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/engine/envelope_generator.h"

#include "env_input.h"

namespace knotwave::env {

/// "0.250", with to_chars: no locale changes it.
std::string fixed(double value, int decimals);

/// What opens the gate: "ch1 note", "ch3 CC64", "every 0.5 beats".
std::string trigger_text(const engine::TriggerSpec& trigger);
/// What plays: "swell.curve (loop 2..5)", "tremolo", "free.depth".
std::string source_text(const engine::EnvelopePatchSpec& patch, const engine::OutputSpec& output);
/// The same as the patch calls it, without its curve and places: "swell".
std::string source_name(const engine::EnvelopePatchSpec& patch, const engine::OutputSpec& output);
/// Where it goes: "CC74 ch3", "bend ch of the note", "/filter/cutoff", "CV 2".
std::string destination_text(const engine::OutputSpec& output);

/// `IN KeyStep ch1 note -> swell.curve (loop 2..5) -> CC74 ch3 Minitaur 412 B/s 13 %`. `in` and
/// `port` are names of devices.
std::string route_line(const engine::EnvelopePatchSpec& patch, const engine::RouteStatus& route,
                       const std::string& in, const std::string& port);

}  // namespace knotwave::env
