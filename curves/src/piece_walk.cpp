// SPDX-License-Identifier: MIT
#include "piece_walk.h"

#include <algorithm>
#include <cmath>

namespace knotwave::curves {
namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

int PieceWalk::find_piece(double u, int hint) const KNOTWAVE_RT {
  const std::vector<double>& breaks = program_.breaks_;
  const int count = program_.piece_count();
  if (hint >= 0 && hint < count && breaks[at(hint)] <= u) {
    if (u < breaks[at(hint) + 1]) return hint;
    if (hint + 1 < count && u < breaks[at(hint) + 2]) return hint + 1;
  }
  // The number of inner breaks at or below u, halving without a branch on u.
  const double* inner = breaks.data() + 1;
  int found = 0;
  for (int left = count - 1; left > 0;) {
    const int half = (left + 1) / 2;
    found += inner[found + half - 1] <= u ? half : 0;
    left -= half;
  }
  return found;
}

Place PieceWalk::place(double u, int hint) const KNOTWAVE_RT {
  const double u_min = program_.u_min();
  const double u_max = program_.u_max();
  if (program_.periodic_) {
    const double shift = std::floor((u - u_min) * program_.inverse_period_) * (u_max - u_min);
    const double wrapped = u - shift;
    // Rounding at the seam, and all that is not finite, counts as the seam itself.
    if (!(wrapped >= u_min && wrapped < u_max)) return {Place::Kind::start, 0, 0};
    return {Place::Kind::piece, find_piece(wrapped, hint), shift};
  }
  if (!(u > u_min)) return {Place::Kind::start, 0, 0};
  if (u >= u_max) return {Place::Kind::end, program_.piece_count() - 1, 0};
  return {Place::Kind::piece, find_piece(u, hint), 0};
}

bool PieceWalk::contains(const Place& place, double u) const KNOTWAVE_RT {
  const double u_min = program_.u_min();
  const double u_max = program_.u_max();
  const double low = program_.breaks_[at(place.piece)];
  const double high = program_.breaks_[at(place.piece) + 1];
  if (program_.periodic_) {
    if (place.kind != Place::Kind::piece) return false;
    const double shift = std::floor((u - u_min) * program_.inverse_period_) * (u_max - u_min);
    const double wrapped = u - shift;
    return shift == place.shift && wrapped >= low && wrapped < high;
  }
  switch (place.kind) {
    case Place::Kind::start:
      return !(u > u_min);
    case Place::Kind::end:
      return u >= u_max;
    case Place::Kind::piece:
      break;
  }
  return u >= low && u < high && u > u_min;
}

std::int64_t PieceWalk::run_length(const Place& place, const GridRun& run, std::int64_t first,
                                   std::int64_t limit) const KNOTWAVE_RT {
  // Nodes never turn back, so those of one place are neighbours and the far end decides.
  if (limit <= 1 || contains(place, run.at(first + limit - 1))) return limit;
  std::int64_t inside = 0;
  std::int64_t outside = limit - 1;
  double border = program_.breaks_[at(place.piece) + (run.step > 0 ? 1U : 0U)] + place.shift;
  if (place.kind == Place::Kind::start) border = program_.u_min();
  if (place.kind == Place::Kind::end) border = program_.u_max();
  const double guess = (border - run.at(first)) / run.step;
  // Where the border should be, then one to its side, then halving: at most log2(limit) + 3 looks.
  for (int look = 0; outside - inside > 1; ++look) {
    std::int64_t node = inside + (outside - inside) / 2;
    if (look < 3 && guess >= 0 && guess < static_cast<double>(limit)) {
      node = std::clamp(static_cast<std::int64_t>(guess) + (look == 2 ? -1 : look), inside + 1,
                        outside - 1);
    }
    (contains(place, run.at(first + node)) ? inside : outside) = node;
  }
  return outside;
}

PieceTask PieceWalk::task(const Place& place) const KNOTWAVE_RT {
  const std::size_t powers = at(program_.degree_) + 1;
  const std::size_t rows = program_.rows();
  const std::size_t terms = 1 + program_.control_rest_.size();
  const double* piece = program_.coefficients_.data() + at(place.piece) * terms * rows * powers;
  PieceTask task;
  task.numerator = piece + at(coordinate_) * powers;
  task.denominator = program_.rational_ ? piece + at(program_.dim_) * powers : nullptr;
  task.term_stride = rows * powers;
  task.degree = program_.degree_;
  task.shift = place.shift;
  task.start = program_.breaks_[at(place.piece)];
  task.inverse_width = program_.inverse_widths_[at(place.piece)];
  task.low = program_.low_[at(coordinate_)];
  task.high = program_.high_[at(coordinate_)];
  task.clamp = program_.inside_hull_[at(place.piece * program_.dim_ + coordinate_)] == 0;
  return task;
}

double PieceWalk::end_value(Place::Kind kind, const ControlMoves& moves) const KNOTWAVE_RT {
  const bool at_start = kind == Place::Kind::start;
  const std::vector<double>& values = at_start ? program_.start_values_ : program_.end_values_;
  if (values.empty()) {
    const Place edge{Place::Kind::piece, at_start ? 0 : program_.piece_count() - 1, 0};
    return sample_piece(task(edge), at_start ? program_.u_min() : program_.u_max(), moves.by,
                        moves.count);
  }
  double y = values[at(coordinate_)];
  for (int k = 0; k < moves.count; ++k) {
    y = y + moves.by[k] * values[at((k + 1) * program_.dim_ + coordinate_)];
  }
  return clamp_to_hull(y, program_.low_[at(coordinate_)], program_.high_[at(coordinate_)]);
}

double PieceWalk::value(const Place& place, double u, const ControlMoves& moves) const KNOTWAVE_RT {
  if (place.kind != Place::Kind::piece) return end_value(place.kind, moves);
  return sample_piece(task(place), u, moves.by, moves.count);
}

ControlMoves PieceWalk::moves(std::span<const double> controls) const KNOTWAVE_RT {
  ControlMoves moves;
  if (controls.empty()) return moves;
  moves.count = std::min(program_.control_count(), static_cast<int>(controls.size()));
  for (int k = 0; k < moves.count; ++k) {
    moves.by[k] = control_move(controls[at(k)], program_.control_rest_[at(k)],
                               program_.control_low_[at(k)], program_.control_high_[at(k)]);
  }
  return moves;
}

ControlTask PieceWalk::control_task(const double* const* values,
                                    std::size_t offset) const KNOTWAVE_RT {
  return {program_.control_count(),
          values,
          offset,
          program_.control_rest_.data(),
          program_.control_low_.data(),
          program_.control_high_.data()};
}

}  // namespace knotwave::curves
