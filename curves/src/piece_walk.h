// SPDX-License-Identifier: MIT
// From u to the piece it lies in, and to how many of the next nodes lie in the same. Private to
// curves. Inline: at 64 samples a block, calls would cost as much as the samples.
#pragma once
#include <algorithm>
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

/// One coordinate of a program.
class PieceWalk {
 public:
  PieceWalk(const CurveProgram& program, int coordinate) KNOTWAVE_RT
      : program_(program),
        coordinate_(static_cast<std::size_t>(coordinate)),
        u_min_(program.u_min()),
        u_max_(program.u_max()) {}

  /// Where u lies. `hint` is a piece; any value gives the same place.
  Place place(double u, int hint) const KNOTWAVE_RT {
    if (program_.periodic_) {
      const double shift = shift_at(u);
      const double wrapped = u - shift;
      // Rounding at the seam, and all that is not finite, counts as the seam itself.
      if (!(wrapped >= u_min_ && wrapped < u_max_)) return {Place::Kind::start, 0, 0};
      return {Place::Kind::piece, find_piece(wrapped, hint), shift};
    }
    if (!(u > u_min_)) return {Place::Kind::start, 0, 0};
    if (u >= u_max_) return {Place::Kind::end, program_.piece_count() - 1, 0};
    return {Place::Kind::piece, find_piece(u, hint), 0};
  }

  /// Whether u lies in `place`. The seam of a periodic program holds no second u.
  bool contains(const Place& place, double u) const KNOTWAVE_RT {
    const double low = program_.breaks_[at(place.piece)];
    const double high = program_.breaks_[at(place.piece) + 1];
    if (program_.periodic_) {
      if (place.kind != Place::Kind::piece) return false;
      const double shift = shift_at(u);
      const double wrapped = u - shift;
      return shift == place.shift && wrapped >= low && wrapped < high;
    }
    if (place.kind == Place::Kind::start) return !(u > u_min_);
    if (place.kind == Place::Kind::end) return u >= u_max_;
    return u >= low && u < high && u > u_min_;
  }

  double u_min() const KNOTWAVE_RT { return u_min_; }
  double inverse_width(const Place& place) const KNOTWAVE_RT {
    return program_.inverse_widths_[at(place.piece)];
  }
  double u_max() const KNOTWAVE_RT { return u_max_; }

  /// Parameters that lie in a piece for certain: low <= u < high, and u > u_min.
  struct Range {
    double low;
    double high;
  };
  Range certain_range(const Place& place) const KNOTWAVE_RT;

  /// How many of the nodes first..first+limit-1 (the first lies in `place`) lie there in a row.
  std::int64_t run_length(const Place& place, const GridRun& run, std::int64_t first,
                          std::int64_t limit) const KNOTWAVE_RT {
    // Nodes never turn back, so those of one place are neighbours and the far end decides.
    if (limit <= 1 || contains(place, run.at(first + limit - 1))) return limit;
    return border(place, run, first, limit);
  }

  /// The nodes from `first` on that lie in one place, at most `limit`; `hint` is a piece.
  struct Stretch {
    Place place;
    std::int64_t length;
  };
  Stretch stretch(const GridRun& run, std::int64_t first, std::int64_t limit,
                  int hint) const KNOTWAVE_RT {
    // Most blocks lie in the piece of the block before: both ends do, and nodes never turn back.
    if (!program_.periodic_ && hint >= 0 && hint < program_.piece_count()) {
      const double a = run.at(first), b = run.at(first + limit - 1);
      const double low = a < b ? a : b, high = a < b ? b : a;
      const double* const breaks = program_.breaks_.data() + hint;
      if (low >= breaks[0] && high < breaks[1] && low > u_min_) {
        return {{Place::Kind::piece, hint, 0}, limit};
      }
    }
    const Place here = place(run.at(first), hint);
    return {here, run_length(here, run, first, limit)};
  }

  /// The piece as kernels read it.
  PieceTask task(const Place& place) const KNOTWAVE_RT {
    const std::size_t piece = at(place.piece);
    const std::size_t dim = at(program_.dim_);
    const std::size_t powers = at(program_.degree_) + 1;
    const double* const terms = program_.coefficients_.data() + piece * program_.piece_size_;
    PieceTask task;
    task.numerator = terms + coordinate_ * powers;
    task.denominator = program_.rational_ ? terms + dim * powers : nullptr;
    task.term_stride = program_.rows() * powers;
    task.degree = program_.degree_;
    task.shift = place.shift;
    task.start = program_.breaks_[piece];
    task.inverse_width = program_.inverse_widths_[piece];
    task.low = program_.low_[coordinate_];
    task.high = program_.high_[coordinate_];
    task.clamp = program_.inside_hull_[piece * dim + coordinate_] == 0;
    return task;
  }

  /// The value at any place.
  double value(const Place& place, double u, const ControlMoves& moves) const KNOTWAVE_RT {
    if (place.kind != Place::Kind::piece) return end_value(place.kind, moves);
    return sample_piece(task(place), u, moves.by, moves.count);
  }

  ControlMoves moves(std::span<const double> controls) const KNOTWAVE_RT;
  ControlTask control_task(const double* const* values, std::size_t offset) const KNOTWAVE_RT;

 private:
  static std::size_t at(int i) KNOTWAVE_RT { return static_cast<std::size_t>(i); }

  /// floor(x), which the baseline instruction set has no instruction for; the rest is whole.
  static double floor_of(double x) KNOTWAVE_RT {
    if (!(x > -0x1p52 && x < 0x1p52)) return x;
    const double whole = static_cast<double>(static_cast<std::int64_t>(x));
    return whole > x ? whole - 1 : whole;
  }
  double shift_at(double u) const KNOTWAVE_RT {
    return floor_of((u - u_min_) * program_.inverse_period_) * (u_max_ - u_min_);
  }

  int find_piece(double u, int hint) const KNOTWAVE_RT {
    const double* const breaks = program_.breaks_.data();
    const int count = program_.piece_count();
    if (hint >= 0 && hint < count && breaks[hint] <= u) {
      if (u < breaks[hint + 1]) return hint;
      if (hint + 1 < count && u < breaks[hint + 2]) return hint + 1;
    }
    // The number of inner breaks at or below u, halving without a branch on u.
    int found = 0;
    for (int left = count - 1; left > 0;) {
      const int half = (left + 1) / 2;
      found += breaks[found + half] <= u ? half : 0;
      left -= half;
    }
    return found;
  }

  std::int64_t border(const Place& place, const GridRun& run, std::int64_t first,
                      std::int64_t limit) const KNOTWAVE_RT;
  double end_value(Place::Kind kind, const ControlMoves& moves) const KNOTWAVE_RT;

  const CurveProgram& program_;
  std::size_t coordinate_;
  double u_min_;
  double u_max_;
};

}  // namespace knotwave::curves
