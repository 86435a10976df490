// SPDX-License-Identifier: MIT
// A take from its journal: the same samples again, or an error.
#pragma once
#include "knotwave/base/result.h"

#include "options.h"
#include "report.h"

namespace knotwave::render {

/// Plays options.journal from engine time 0 and writes the take. Errors: those of reading the
/// journal, its banks and sounds; value_out_of_range (longer than --max-length, a rate no sound
/// file has); malformed (other samples than the journal's hash says, which leaves no file); those
/// of the sound writer.
Result<RenderReport> render_journal(const RenderOptions& options);

}  // namespace knotwave::render
