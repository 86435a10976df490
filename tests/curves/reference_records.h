// SPDX-License-Identifier: MIT
// Records of tests/golden/curves/*.txt: a word, then numbers as hexadecimal floats.
#pragma once
#include <istream>
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::test {

/// The rest of a line.
std::vector<double> hex_numbers(std::istream& words);

/// What the line that begins with `what` says of a curve: "curve" starts a new one in `spec`, then
/// its knots, points, weights and jumps. Other lines are left alone.
void read_curve_record(const std::string& what, std::istream& words, curves::CurveSpec& spec);

}  // namespace knotwave::test
