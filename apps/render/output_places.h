// SPDX-License-Identifier: MIT
// Where the files of a render go.
#pragma once
#include <string>

#include "options.h"
#include "render_job.h"

namespace knotwave::render {

/// The stem of a channel (0..15): `channel-01.wav` in the folder of --stems, `.flac` beside a FLAC.
std::string stem_path(const RenderOptions& options, int channel);

/// What is wrong with where the files go: over one that is read, or two into one. Empty when
/// nothing is.
std::string output_overlap(const RenderOptions& options, const RenderInput& input);

}  // namespace knotwave::render
