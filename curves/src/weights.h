// SPDX-License-Identifier: MIT
// Weights are worth what they are to each other: a factor common to all changes nothing.
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::curves {

/// Multiplies all by the power of 2 that brings them into kMinWeight..kMaxWeight, as far from one
/// limit as from the other; by nothing if they are inside. Errors: weight_not_positive,
/// weight_out_of_range (no power of 2 does), not_finite; `what` begins the message.
Result<void> fit_weights(const std::string& what, std::vector<double>& weights);

}  // namespace knotwave::curves
