// SPDX-License-Identifier: MIT
#include "knotwave/curves/curve_program.h"

#include <algorithm>
#include <cmath>

#include "live_spline.h"
#include "piece_walk.h"

namespace knotwave::curves {
namespace {

/// Below this many samples in a piece a kernel call costs more than it saves.
constexpr std::size_t kShortRun = 4;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void run_kernel(const PieceTask& task, const GridRun& run, std::int64_t i, float* out,
                std::size_t n) KNOTWAVE_RT {
  grid_kernels().grid_float(task, run.origin, run.step, static_cast<double>(run.first + i), out, n);
}
void run_kernel(const PieceTask& task, const GridRun& run, std::int64_t i, double* out,
                std::size_t n) KNOTWAVE_RT {
  grid_kernels().grid_double(task, run.origin, run.step, static_cast<double>(run.first + i), out,
                             n);
}

/// Whether first..last and the sums of the kernel are exact as doubles.
bool indices_are_exact(const GridRun& run, std::int64_t count) KNOTWAVE_RT {
  constexpr std::int64_t kLimit = std::int64_t{1} << 52;
  return run.first > -kLimit && run.first < kLimit - count;
}

template <class Float>
void render_run(const PieceWalk& walk, const GridRun& run, std::span<Float> out,
                CurveCursor& cursor) KNOTWAVE_RT {
  const std::int64_t count = static_cast<std::int64_t>(out.size());
  const bool exact = indices_are_exact(run, count);
  for (std::int64_t i = 0; i < count;) {
    const auto [place, length] = walk.stretch(run, i, count - i, cursor.piece);
    cursor.piece = place.piece;
    const auto part = out.subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(length));
    if (place.kind != Place::Kind::piece) {
      std::fill(part.begin(), part.end(), static_cast<Float>(walk.value(place, 0, {})));
    } else if (exact && part.size() >= kShortRun) {
      run_kernel(walk.task(place), run, i, part.data(), part.size());
    } else {
      const PieceTask task = walk.task(place);
      for (std::int64_t j = 0; j < length; ++j) {
        part[static_cast<std::size_t>(j)] = static_cast<Float>(sample_piece(task, run.at(i + j)));
      }
    }
    i += length;
  }
}

/// Where knots move: u as the curve's own parameter, its ends beyond them.
LiveSpline::Jet live_at(const LiveSpline& spline, const PieceWalk& walk, double u, int coordinate,
                        const ControlMoves& moves) KNOTWAVE_RT {
  const Place place = walk.place(u, 0);
  const double inside = place.kind == Place::Kind::piece   ? u - place.shift
                        : place.kind == Place::Kind::start ? walk.u_min()
                                                           : walk.u_max();
  return spline.at(inside, coordinate, std::span(moves.by, at(moves.count)));
}

/// Samples taken one by one, without a hint, where they jump from piece to piece.
constexpr std::size_t kScattered = 32;

void render_scattered(const PieceWalk& walk, std::span<const double> u,
                      std::span<double> out) KNOTWAVE_RT {
  for (std::size_t i = 0; i < u.size(); ++i) {
    // No branch that depends on the piece, so that one sample does not wait for the other.
    const Place place = walk.place(u[i], -1);
    if (place.kind != Place::Kind::piece) {
      out[i] = walk.value(place, u[i], {});
      continue;
    }
    PieceTask task = walk.task(place);
    task.clamp = true;  // where it is not needed it changes nothing
    out[i] = sample_piece(task, u[i]);
  }
}

/// How many of u[0..] lie in the place of the first.
std::size_t same_place(const PieceWalk& walk, const Place& place,
                       std::span<const double> u) KNOTWAVE_RT {
  std::size_t n = 1;
  if (place.kind == Place::Kind::piece) {
    const PieceWalk::Range range = walk.certain_range(place);
    while (n < u.size() && u[n] >= range.low && u[n] < range.high && u[n] > walk.u_min()) ++n;
  }
  while (n < u.size() && walk.contains(place, u[n])) ++n;
  return n;
}

}  // namespace

CurveProgram::CurveProgram()
    : breaks_{0, 1}, inverse_widths_{1}, coefficients_{0}, inside_hull_{0}, low_{0}, high_{0} {}

std::span<const double> CurveProgram::coefficients(int piece, int coordinate) const KNOTWAVE_RT {
  const std::size_t powers = at(degree_) + 1;
  const std::size_t terms = 1 + control_rest_.size();
  return std::span<const double>(coefficients_)
      .subspan((at(piece) * terms * rows() + at(coordinate)) * powers, powers);
}

double CurveProgram::at_u(double u, int coordinate,
                          std::span<const double> controls) const KNOTWAVE_RT {
  const PieceWalk walk(*this, coordinate);
  const ControlMoves moves = walk.moves(controls);
  if (live_ != nullptr && moves.count == control_count()) {
    const double y = live_at(*live_, walk, u, coordinate, moves).value;
    return clamp_to_hull(y, low(coordinate), high(coordinate));
  }
  return walk.value(walk.place(u, 0), u, moves);
}

double CurveProgram::slope_at_u(double u, int coordinate,
                                std::span<const double> controls) const KNOTWAVE_RT {
  const PieceWalk walk(*this, coordinate);
  const ControlMoves moves = walk.moves(controls);
  if (live_ != nullptr && moves.count == control_count()) {
    return live_at(*live_, walk, u, coordinate, moves).slope;
  }
  const Place place = walk.place(u, 0);
  const PieceTask task = walk.task(place);
  double t = ((u - place.shift) - task.start) * task.inverse_width;
  if (place.kind != Place::Kind::piece) t = place.kind == Place::Kind::start ? 0.0 : 1.0;

  // Value and derivative of one row, its terms added first.
  struct Jet {
    double value;
    double slope;
  };
  const auto jet = [&](const double* row) {
    Jet sum{0, 0};
    for (int k = degree_; k >= 0; --k) {
      double c = row[k];
      for (int m = 0; m < moves.count; ++m)
        c = c + moves.by[m] * row[at(m + 1) * task.term_stride + at(k)];
      sum.slope = sum.slope * t + sum.value;
      sum.value = sum.value * t + c;
    }
    return sum;
  };
  const Jet n = jet(task.numerator);
  if (task.denominator == nullptr) return n.slope * task.inverse_width;
  const Jet d = jet(task.denominator);
  return (n.slope * d.value - n.value * d.slope) / (d.value * d.value) * task.inverse_width;
}

void CurveProgram::render(const GridRun& run, std::span<double> out, CurveCursor& cursor,
                          int coordinate) const KNOTWAVE_RT {
  render_run(PieceWalk(*this, coordinate), run, out, cursor);
}

void CurveProgram::render(const GridRun& run, std::span<float> out, CurveCursor& cursor,
                          int coordinate) const KNOTWAVE_RT {
  render_run(PieceWalk(*this, coordinate), run, out, cursor);
}

void CurveProgram::render(std::span<const double> u, std::span<double> out, CurveCursor& cursor,
                          int coordinate) const KNOTWAVE_RT {
  const PieceWalk walk(*this, coordinate);
  const std::size_t count = std::min(u.size(), out.size());
  for (std::size_t i = 0; i < count;) {
    const Place place = walk.place(u[i], cursor.piece);
    cursor.piece = place.piece;
    std::size_t n = same_place(walk, place, u.subspan(i, count - i));
    if (place.kind != Place::Kind::piece) {
      std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(i), n, walk.value(place, 0, {}));
    } else if (n >= kShortRun) {
      grid_kernels().array(walk.task(place), u.data() + i, out.data() + i, n);
    } else {
      n = std::min(kScattered, count - i);
      render_scattered(walk, u.subspan(i, n), out.subspan(i, n));
    }
    i += n;
  }
}

void CurveProgram::render(std::span<const double> u, std::span<const double* const> controls,
                          std::span<double> out, CurveCursor& cursor,
                          int coordinate) const KNOTWAVE_RT {
  if (controls.size() < control_rest_.size() || controls.empty()) {
    render(u, out, cursor, coordinate);
    return;
  }
  const PieceWalk walk(*this, coordinate);
  const std::size_t count = std::min(u.size(), out.size());
  for (std::size_t i = 0; live_ != nullptr && i < count; ++i) {
    double values[kMaxControls];
    for (int k = 0; k < control_count(); ++k) values[k] = controls[at(k)][i];
    out[i] = at_u(u[i], coordinate, {values, at(control_count())});
  }
  for (std::size_t i = 0; live_ == nullptr && i < count;) {
    const Place place = walk.place(u[i], cursor.piece);
    cursor.piece = place.piece;
    const std::size_t n = same_place(walk, place, u.subspan(i, count - i));
    if (place.kind == Place::Kind::piece) {
      grid_kernels().array_controls(walk.task(place), walk.control_task(controls.data(), i),
                                    u.data() + i, out.data() + i, n);
    } else {
      for (std::size_t j = i; j < i + n; ++j) {
        double values[kMaxControls];
        for (int k = 0; k < control_count(); ++k) values[k] = controls[at(k)][j];
        out[j] = walk.value(place, u[j], walk.moves({values, at(control_count())}));
      }
    }
    i += n;
  }
}

void CurveProgram::evaluate_grid(const MapGrid& grid, std::int64_t first,
                                 std::span<float> out) const KNOTWAVE_RT {
  const GridRun run{grid.u1, (grid.u2 - grid.u1) / static_cast<double>(grid.n), first};
  CurveCursor cursor;
  render(run, out, cursor);
  const std::int64_t last = grid.n - first;
  if (last >= 0 && last < static_cast<std::int64_t>(out.size())) {
    out[static_cast<std::size_t>(last)] = static_cast<float>(at_u(grid.u2));
  }
}

}  // namespace knotwave::curves
