// SPDX-License-Identifier: MIT
// A dry run as a picture: for each output the curve, and over it what a receiver holds.
#pragma once
#include <string>

#include "dry_run.h"

namespace knotwave::env {

/// SVG. Errors: those of the players.
Result<std::string> plot_of(const EnvOptions& options, const EnvInput& input, const io::Song& song,
                            const DryRun& run);

/// What a receiver makes of the messages for one destination: (seconds, value in the unit of the
/// output) whenever one came.
std::vector<std::pair<double, double>> received(std::span<const SentMessage> messages, int port,
                                                int patch, int output,
                                                const engine::OutputSpec& spec);

}  // namespace knotwave::env
