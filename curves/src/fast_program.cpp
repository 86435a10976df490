// SPDX-License-Identifier: MIT
#include "knotwave/curves/fast_program.h"

#include <algorithm>
#include <cmath>

#include "fast_kernel.h"
#include "fast_piece.h"
#include "piece_walk.h"

namespace knotwave::curves {
namespace {

/// Fewer samples than this are not worth a kernel call.
constexpr std::size_t kShortRun = 4;
/// Widths of a piece from 0 up to which doubles place a node as exactly as kLocalError says.
constexpr double kFarthest = 0x1p24;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Samples first .. first + n - 1 without a kernel.
void run_one_by_one(const FastTask& task, int degree, bool clamp, std::int64_t anchor,
                    std::int64_t first, float* out, std::size_t n) KNOTWAVE_RT {
  for (std::size_t i = 0; i < n; ++i, ++first) {
    if (first == chunk_start(first)) anchor = first;
    const float k = static_cast<float>(first - anchor);
    out[i] = fast_sample(task, degree, clamp, anchor_of(task, anchor) + k * local_step(task));
  }
}

}  // namespace

/// Nodes of a grid that lie in one piece and that float32 can count.
struct FastStretch {
  FastTask task;  ///< all but the coordinate's own
  int piece = 0;
  std::int64_t anchor = 0;  ///< of the first node
};

/// What render() does with a stretch.
class FastRun {
 public:
  FastRun(const FastProgram& fast, const GridRun& run) KNOTWAVE_RT : fast_(fast), run_(run) {}

  /// Whether all `count` nodes lie in piece `hint` of a program that is not periodic, with an
  /// anchor in it as well: nearly every block, so in few steps. If not, other ways are taken.
  bool is_in_piece(std::int64_t count, int hint, FastStretch& stretch) const KNOTWAVE_RT {
    const CurveProgram& program = fast_.program_;
    if (hint < 0 || hint >= fast_.near_pieces_) return false;
    const std::int64_t anchor = chunk_start(run_.first);
    const double a = node(anchor), b = node(run_.first + count - 1);
    const double low = a < b ? a : b, high = b < a ? a : b;
    const double* const breaks = program.breaks().data();
    const double start = breaks[hint];
    if (!(low >= start && high < breaks[hint + 1] && low > breaks[0])) return false;
    const double inverse_width = program.inverse_widths().data()[hint];
    if (!is_countable(0, inverse_width)) return false;
    set(stretch, hint, 0, start, inverse_width, anchor);
    return true;
  }

  /// The nodes from i on that lie in one place, at most `limit`; whether float32 can count them.
  struct Found {
    std::int64_t length;
    bool countable;
  };
  Found find(std::int64_t i, std::int64_t limit, CurveCursor& cursor,
             FastStretch& stretch) const KNOTWAVE_RT {
    const PieceWalk walk(fast_.program_, 0);
    const auto [place, length] = walk.stretch(run_, i, limit, cursor.piece);
    cursor.piece = place.piece;
    const double inverse_width = walk.inverse_width(place);
    if (place.kind != Place::Kind::piece || !is_countable(place.shift, inverse_width)) {
      return {length, false};
    }
    set(stretch, place.piece, place.shift, fast_.program_.breaks()[at(place.piece)], inverse_width,
        anchor(walk, place, i));
    return {length, true};
  }

  /// The samples of a stretch that begins at node i.
  void render(FastStretch& stretch, std::int64_t i, int coordinate,
              std::span<float> out) const KNOTWAVE_RT {
    const CurveProgram& program = fast_.program_;
    const auto form = fast_.forms_[at(stretch.piece * program.dim() + coordinate)];
    if (form == FastProgram::Form::accurate) return render_accurate(i, coordinate, out);
    const bool clamp = form == FastProgram::Form::clamped;
    const int degree = program.piece_degree();
    const std::size_t powers = at(degree) + 1;
    const float* const rows = fast_.coefficients_.data() + at(stretch.piece) * fast_.piece_size_;
    FastTask& task = stretch.task;
    task.numerator = rows + at(coordinate) * powers;
    task.denominator = program.is_rational() ? rows + at(program.dim()) * powers : nullptr;
    task.range = fast_.ranges_.data() + at(2 * coordinate);
    const std::int64_t first = run_.first + i;
    if (out.size() < kShortRun) {
      run_one_by_one(task, degree, clamp, stretch.anchor, first, out.data(), out.size());
    } else {
      const auto& kernels = fast_kernels().run[degree];
      kernels[program.is_rational()][clamp](task, stretch.anchor, first, out.data(), out.size());
    }
  }

  [[gnu::noinline]] void render_accurate(std::int64_t i, int coordinate,
                                         std::span<float> out) const KNOTWAVE_RT {
    GridRun part = run_;
    part.first += i;
    CurveCursor cursor;
    fast_.program_.render(part, out, cursor, coordinate);
  }

 private:
  double node(std::int64_t index) const KNOTWAVE_RT {
    return run_.origin + static_cast<double>(index) * run_.step;
  }

  /// False for NaN. Two nodes of a piece are never further apart than its width.
  bool is_countable(double shift, double inverse_width) const KNOTWAVE_RT {
    const double farthest = fast_.farthest_ + std::abs(run_.origin) + std::abs(shift);
    return farthest * inverse_width <= kFarthest && std::abs(run_.step) * inverse_width <= 1;
  }

  std::int64_t anchor(const PieceWalk& walk, const Place& place, std::int64_t i) const KNOTWAVE_RT {
    const std::int64_t node = run_.first + i;
    const std::int64_t start = chunk_start(node);
    // Inside a block, a stretch begins where the one before it ends.
    if (i > 0 || start == node) return node;
    // Backwards: nodes of the same bits.
    const GridRun back{run_.origin, -run_.step, -node};
    return node + 1 - walk.run_length(place, back, 0, node - start + 1);
  }

  void set(FastStretch& stretch, int piece, double shift, double start, double inverse_width,
           std::int64_t anchor) const KNOTWAVE_RT {
    stretch.task.origin = run_.origin;
    stretch.task.step = run_.step;
    stretch.task.shift = shift;
    stretch.task.start = start;
    stretch.task.inverse_width = inverse_width;
    stretch.piece = piece;
    stretch.anchor = anchor;
  }

  const FastProgram& fast_;
  const GridRun& run_;
};

FastProgram::FastProgram(CurveProgram program, double max_error) : program_(std::move(program)) {
  const int dim = program_.dim();
  const std::size_t powers = at(program_.piece_degree()) + 1;
  near_pieces_ = program_.is_periodic() ? 0 : program_.piece_count();
  farthest_ = std::max(std::abs(program_.u_min()), std::abs(program_.u_max()));
  piece_size_ = (at(dim) + (program_.is_rational() ? 1U : 0U)) * powers;
  coefficients_.resize(at(program_.piece_count()) * piece_size_);
  forms_.resize(at(program_.piece_count() * dim));
  for (int c = 0; c < dim; ++c) {
    ranges_.push_back(static_cast<float>(program_.low(c)));
    ranges_.push_back(static_cast<float>(program_.high(c)));
    max_error_.push_back(0x1p-24 * largest(c));  // of accurate(), rounded
  }
  for (int piece = 0; piece < program_.piece_count(); ++piece) add_piece(piece, max_error);
  for (double& error : max_error_) error += program_.max_error();
}

double FastProgram::largest(int coordinate) const {
  return std::max(std::abs(program_.low(coordinate)), std::abs(program_.high(coordinate)));
}

void FastProgram::add_piece(int piece, double max_error) {
  const int dim = program_.dim();
  const std::size_t powers = at(program_.piece_degree()) + 1;
  const auto out = std::span(coefficients_).subspan(at(piece) * piece_size_, piece_size_);
  FastRow weight;
  if (program_.is_rational()) {
    weight = make_fast_row(program_.coefficients(piece, dim), out.subspan(at(dim) * powers));
  }
  for (int c = 0; c < dim; ++c) {
    FastRow row = make_fast_row(program_.coefficients(piece, c), out.subspan(at(c) * powers));
    if (program_.is_rational()) {
      row = quotient_of(row, weight, program_.piece_degree(), largest(c) + program_.max_error());
    }
    const bool stays_inside =
        row.low - row.error > ranges_[at(2 * c)] && row.high + row.error < ranges_[at(2 * c + 1)];
    // The hull's ends, where a sample is clamped to them, are rounded.
    const double error = row.error + (stays_inside ? 0 : 0x1p-24 * largest(c));
    if (!(error <= max_error) || !std::isfinite(error)) continue;
    forms_[at(piece * dim + c)] = stays_inside ? Form::fast : Form::clamped;
    max_error_[at(c)] = std::max(max_error_[at(c)], error);
  }
}

int FastProgram::fast_piece_count(int coordinate) const KNOTWAVE_RT {
  int count = 0;
  for (int piece = 0; piece < program_.piece_count(); ++piece) {
    count += forms_[at(piece * program_.dim() + coordinate)] != Form::accurate ? 1 : 0;
  }
  return count;
}

// Apart, so that the way of nearly every block needs few registers.
[[gnu::noinline]] void FastProgram::render_pieces(const GridRun& run, std::span<float> out,
                                                  CurveCursor& cursor,
                                                  int coordinate) const KNOTWAVE_RT {
  const FastRun fast(*this, run);
  FastStretch stretch;
  const auto count = static_cast<std::int64_t>(out.size());
  for (std::int64_t i = 0; i < count;) {
    const auto [length, countable] = fast.find(i, count - i, cursor, stretch);
    const auto part = out.subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(length));
    countable ? fast.render(stretch, i, coordinate, part)
              : fast.render_accurate(i, coordinate, part);
    i += length;
  }
}

void FastProgram::render(const GridRun& run, std::span<float> out, CurveCursor& cursor,
                         int coordinate) const KNOTWAVE_RT {
  const FastRun fast(*this, run);
  FastStretch stretch;
  const auto count = static_cast<std::int64_t>(out.size());
  if (count > 0 && fast.is_in_piece(count, cursor.piece, stretch)) {
    return fast.render(stretch, 0, coordinate, out);
  }
  render_pieces(run, out, cursor, coordinate);
}

void FastProgram::render(const GridRun& run, std::span<const std::span<float>> out,
                         CurveCursor& cursor) const KNOTWAVE_RT {
  if (out.empty() || out[0].empty()) return;
  const FastRun fast(*this, run);
  FastStretch stretch;
  const int coordinates = std::min(static_cast<int>(out.size()), program_.dim());
  const auto count = static_cast<std::int64_t>(out[0].size());
  if (fast.is_in_piece(count, cursor.piece, stretch)) {
    for (int c = 0; c < coordinates; ++c) fast.render(stretch, 0, c, out[at(c)]);
    return;
  }
  for (std::int64_t i = 0; i < count;) {
    const auto [length, countable] = fast.find(i, count - i, cursor, stretch);
    for (int c = 0; c < coordinates; ++c) {
      const auto part =
          out[at(c)].subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(length));
      countable ? fast.render(stretch, i, c, part) : fast.render_accurate(i, c, part);
    }
    i += length;
  }
}

void FastProgram::evaluate_grid(const MapGrid& grid, std::int64_t first,
                                std::span<float> out) const KNOTWAVE_RT {
  const GridRun run{grid.u1, (grid.u2 - grid.u1) / static_cast<double>(grid.n), first};
  CurveCursor cursor;
  render(run, out, cursor);
  const std::int64_t last = grid.n - first;
  if (last >= 0 && last < static_cast<std::int64_t>(out.size())) {
    out[static_cast<std::size_t>(last)] = static_cast<float>(program_.at_u(grid.u2));
  }
}

}  // namespace knotwave::curves
