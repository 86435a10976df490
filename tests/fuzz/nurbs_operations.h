// SPDX-License-Identifier: MIT
// Every operation on curves as something a fuzzer can do to one: takes its arguments from the
// bytes, checks what the header promises, and gives the curve to go on with, or none.
#pragma once
#include <optional>
#include <span>

#include "knotwave/curves/nurbs_curve.h"

#include "byte_reader.h"

namespace knotwave::fuzz {

using Outcome = std::optional<curves::NurbsCurve>;
using Operation = Outcome (*)(const curves::NurbsCurve&, ByteReader&);

std::span<const Operation> edits();    ///< the same curve in another form, smaller, or at a pace
std::span<const Operation> pairs();    ///< with a second curve, read from the bytes
std::span<const Operation> studies();  ///< slopes, areas, lengths, roots, repair
std::span<const Operation> forms();    ///< programs, moving curves, paths, fits

}  // namespace knotwave::fuzz
