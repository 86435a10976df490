// SPDX-License-Identifier: MIT
// A curve program in float32: three to four times as fast, with a proved error of its own. For
// grids where that error does; CurveProgram itself is right to -140 dBFS and better.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "knotwave/curves/curve_program.h"

namespace knotwave::curves {

/// Pieces as powers of s = t - 1/2 in float32, made from a program and kept beside it. Values do
/// not hang on the block size or the vector unit, but on the grid: a node's parameter is worked out
/// in double every 256th node and in float from there on. Controls are at rest. Immutable; copying
/// is [control]. docs/compile.md, Fast programs.
class FastProgram {
 public:
  FastProgram() : FastProgram(CurveProgram()) {}
  /// Pieces whose float32 error would be above `max_error`, or has no bound, are played by
  /// `program`, as are grids beyond what a float can count: nodes more than 2^24 times a piece's
  /// width from 0. [control]
  explicit FastProgram(CurveProgram program,
                       double max_error = std::numeric_limits<double>::infinity());

  /// The program in double that it was made from.
  const CurveProgram& accurate() const KNOTWAVE_RT { return program_; }
  /// No sample is further from the curve at its node, in output units: proved for every grid, the
  /// error of accurate() and the rounding to float32 included (with controls, as far as that of
  /// accurate() is). What is measured is 3 to 10 times
  /// less.
  double max_error(int coordinate = 0) const KNOTWAVE_RT {
    return max_error_[static_cast<std::size_t>(coordinate)];
  }
  /// How many pieces of a coordinate are played in float32.
  int fast_piece_count(int coordinate = 0) const KNOTWAVE_RT;

  /// The program on run.at(0), run.at(1), ... [audio] Any split into blocks has the same bits. The
  /// hull is kept (its ends rounded to float32), end values are those of accurate().
  void render(const GridRun& run, std::span<float> out, CurveCursor& cursor,
              int coordinate = 0) const KNOTWAVE_RT;
  /// Coordinates 0 .. out.size()-1 in one pass, to the bits of the call for one. [audio] All of the
  /// same length, at most dim() of them.
  void render(const GridRun& run, std::span<const std::span<float>> out,
              CurveCursor& cursor) const KNOTWAVE_RT;
  /// Nodes of a grid, the last one exact as in CurveProgram::evaluate_grid. [any]
  void evaluate_grid(const MapGrid& grid, std::int64_t first,
                     std::span<float> out) const KNOTWAVE_RT;

 private:
  friend class FastRun;  // src/fast_program.cpp, one call of render()

  enum class Form : unsigned char { accurate, fast, clamped };

  double largest(int coordinate) const;
  void add_piece(int piece, double max_error);
  void render_pieces(const GridRun& run, std::span<float> out, CurveCursor& cursor,
                     int coordinate) const KNOTWAVE_RT;

  CurveProgram program_;
  int near_pieces_ = 0;              // pieces that a hint may name: none of a periodic program
  double farthest_ = 0;              // of the ends of the domain, from 0
  std::size_t piece_size_ = 0;       // floats of a piece: (dim + rational) * (degree + 1)
  std::vector<float> coefficients_;  // [(piece * rows + row) * (degree + 1) + power]
  std::vector<Form> forms_;          // [piece * dim + coordinate]
  std::vector<float> ranges_;        // [dim * 2] low, high
  std::vector<double> max_error_;    // [dim]
};

}  // namespace knotwave::curves
