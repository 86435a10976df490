// SPDX-License-Identifier: MIT
#include "piece_walk.h"

#include <cmath>

namespace knotwave::curves {

PieceWalk::Range PieceWalk::certain_range(const Place& place) const KNOTWAVE_RT {
  const double low = program_.breaks_[at(place.piece)];
  const double high = program_.breaks_[at(place.piece) + 1];
  if (!program_.periodic_) return {low, high};
  // u - shift and (u - u_min) * inverse_period round by a few 2^-53 of what goes in.
  const double margin = 0x1p-49 * (std::abs(place.shift) + std::abs(u_min_) + std::abs(u_max_));
  return {low + place.shift + margin, high + place.shift - margin};
}

std::int64_t PieceWalk::border(const Place& place, const GridRun& run, std::int64_t first,
                               std::int64_t limit) const KNOTWAVE_RT {
  std::int64_t inside = 0;
  std::int64_t outside = limit - 1;
  double end = program_.breaks_[at(place.piece) + (run.step > 0 ? 1U : 0U)] + place.shift;
  if (place.kind == Place::Kind::start) end = u_min_;
  if (place.kind == Place::Kind::end) end = u_max_;
  const double guess = (end - run.at(first)) / run.step;
  // Where the border should be, then beside it, then halving: at most log2(limit) + 3 looks.
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

double PieceWalk::end_value(Place::Kind kind, const ControlMoves& moves) const KNOTWAVE_RT {
  const bool at_start = kind == Place::Kind::start;
  const std::vector<double>& values = at_start ? program_.start_values_ : program_.end_values_;
  if (values.empty()) {
    const Place edge{Place::Kind::piece, at_start ? 0 : program_.piece_count() - 1, 0};
    return sample_piece(task(edge), at_start ? u_min_ : u_max_, moves.by, moves.count);
  }
  double y = values[coordinate_];
  for (int k = 0; k < moves.count; ++k) {
    y = y + moves.by[k] * values[at(k + 1) * at(program_.dim_) + coordinate_];
  }
  return clamp_to_hull(y, program_.low_[coordinate_], program_.high_[coordinate_]);
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
