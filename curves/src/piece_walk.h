// SPDX-License-Identifier: MIT
// From u to the piece it lies in, and to how many of the next nodes lie in the same. Private to
// curves.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/curves/curve_program.h"

#include "grid_kernel.h"

namespace knotwave::curves {

/// Where a parameter lies: a piece and the whole periods taken off, or an end that is held.
struct Place {
  enum class Kind : std::uint8_t { piece, start, end };
  Kind kind = Kind::start;
  int piece = 0;
  double shift = 0;
};

/// The movements of all controls from rest, on the stack.
struct ControlMoves {
  double by[kMaxControls] = {};
  int count = 0;
};

class PieceWalk {
 public:
  PieceWalk(const CurveProgram& program, int coordinate) KNOTWAVE_RT : program_(program),
                                                                       coordinate_(coordinate) {}

  /// Where u lies. `hint` is a piece; any value gives the same place.
  Place place(double u, int hint) const KNOTWAVE_RT;
  /// Whether u lies in the same place as the one `place` was made for; false is always allowed
  /// where the place is not a piece.
  bool contains(const Place& place, double u) const KNOTWAVE_RT;

  /// How many of the nodes first..first+limit-1 (the first lies in `place`) lie there in a row.
  std::int64_t run_length(const Place& place, const GridRun& run, std::int64_t first,
                          std::int64_t limit) const KNOTWAVE_RT;

  /// The piece as kernels read it.
  PieceTask task(const Place& place) const KNOTWAVE_RT;

  /// The value at any place.
  double value(const Place& place, double u, const ControlMoves& moves) const KNOTWAVE_RT;

  ControlMoves moves(std::span<const double> controls) const KNOTWAVE_RT;
  ControlTask control_task(const double* const* values, std::size_t offset) const KNOTWAVE_RT;

 private:
  double end_value(Place::Kind kind, const ControlMoves& moves) const KNOTWAVE_RT;
  int find_piece(double u, int hint) const KNOTWAVE_RT;

  const CurveProgram& program_;
  int coordinate_;
};

}  // namespace knotwave::curves
