// SPDX-License-Identifier: MIT
// Plain parts to a CurveProgram. Private to curves. [control]
#pragma once
#include <memory>
#include <vector>

#include "knotwave/curves/curve_program.h"

namespace knotwave::curves {

/// What a program is made of; the layouts are those of CurveProgram.
struct ProgramParts {
  int dim = 1;
  int degree = 0;
  bool rational = false;
  bool periodic = false;
  double max_error = 0;
  std::vector<double> breaks;  ///< [pieces + 1], increasing
  std::vector<double> coefficients;
  std::vector<double> start_values, end_values;  ///< [terms * dim] or empty
  std::vector<double> low, high;                 ///< [dim]
  std::vector<double> control_rest, control_low, control_high;

  std::shared_ptr<const LiveSpline> live;

  std::size_t rows() const { return static_cast<std::size_t>(dim) + (rational ? 1U : 0U); }
  std::size_t terms() const { return 1 + control_rest.size(); }
  std::size_t powers() const { return static_cast<std::size_t>(degree) + 1; }
  std::size_t piece_size() const { return terms() * rows() * powers(); }
  std::size_t pieces() const { return breaks.size() - 1; }
};

class ProgramBuilder {
 public:
  /// `parts` is taken as checked: sizes agree, widths are normal numbers, D > 0.
  static CurveProgram build(ProgramParts parts);
  /// The same program with its measured error.
  static void set_max_error(CurveProgram& program, double max_error) {
    program.max_error_ = max_error;
  }
};

}  // namespace knotwave::curves
