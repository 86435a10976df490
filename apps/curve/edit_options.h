// SPDX-License-Identifier: MIT
// The options of the commands that make curves; with options.cpp all that knows CLI11.
#pragma once
#include <string>

#include "options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace knotwave::curve_app {

void add_edits(CLI::App& app, CurveOptions& options);

/// What is wrong with options that are each good in themselves; empty when nothing is.
std::string edit_conflict(const CurveOptions& options);

}  // namespace knotwave::curve_app
