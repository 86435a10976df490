// SPDX-License-Identifier: MIT
#include "knotwave/dsp/oscillator.h"

#include <algorithm>
#include <array>

#include "knotwave/base/time.h"

#include "table_kernel.h"

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = 64;
constexpr int kFade = TableOscillator::kLevelFadeSamples;

/// Rises from 0 to 1 with two derivatives 0 at both ends: 6x^5 - 15x^4 + 10x^3.
constexpr std::array<float, kFade> kFadeCurve = [] {
  std::array<float, kFade> curve{};
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const double x = (static_cast<double>(k) + 0.5) / kFade;
    curve[k] = static_cast<float>(x * x * x * (10 - x * (15 - 6 * x)));
  }
  return curve;
}();

constexpr std::uint64_t magnitude(base::Phase increment) KNOTWAVE_RT {
  return std::min(increment.value, std::uint64_t(0) - increment.value);
}

/// increment * lead / 2^32 without losing the high bits. An increment above half a cycle is a
/// negative one, and stays right: the product is taken modulo a cycle.
constexpr base::Phase part_of(base::Phase increment, std::uint32_t lead) KNOTWAVE_RT {
  const bool backwards = (increment.value >> 63) != 0;
  const std::uint64_t step = magnitude(increment);
  const std::uint64_t part = (step >> 32) * lead + (((step & 0xffffffffU) * lead) >> 32);
  return {backwards ? std::uint64_t(0) - part : part};
}

/// base::phase_from_cycles(), without a call where |cycles| < 2^22 (exact: 24 significant bits).
base::Phase offset_phase(float cycles) KNOTWAVE_RT {
  const double exact = double(cycles);
  if (!(exact > -0x1p22 && exact < 0x1p22)) return base::phase_from_cycles(exact);
  const double part = exact - static_cast<double>(static_cast<std::int64_t>(exact));
  return {static_cast<std::uint64_t>(static_cast<std::int64_t>(part * 0x1p62)) << 2};
}

/// A level is dropped at once when its highest harmonic would fold below a third of the sample
/// rate: 4/3 of its limit. Otherwise it is faded out and folds, if at all, above that.
bool folds_low(const WaveTables& tables, int level, std::uint64_t step) KNOTWAVE_RT {
  const std::uint64_t limit = tables.level_limit(level);
  return step > limit + limit / 3 && level > 0;
}

}  // namespace

/// Up to kChunk samples in which the levels do not change.
struct TableOscillator::Chunk {
  std::span<const base::Phase> phases;
  const WaveTables::RowBlend* blends;
  std::size_t blend_step;
  std::span<float> left, right;
};

void TableOscillator::start(base::Phase phase, double lead_samples) KNOTWAVE_RT {
  phase_ = phase;
  if (!(lead_samples > 0)) lead_samples = 0;
  lead_ = lead_samples >= 1 ? 0xffffffffU : static_cast<std::uint32_t>(lead_samples * 0x1p32);
  fresh_ = true;
  fade_left_ = 0;
}

/// Settles the level for the first increment, and says how many samples it stays so.
int TableOscillator::steady_run(const WaveTables& tables,
                                std::span<const base::Phase> increments) KNOTWAVE_RT {
  const std::uint64_t first = magnitude(increments[0]);
  const int last = tables.level_count() - 1;
  level_ = std::min(level_, last);
  next_level_ = std::min(next_level_, last);
  const int target = tables.level_for(increments[0]);
  if (fresh_ || folds_low(tables, level_, first) ||
      (fade_left_ > 0 && folds_low(tables, next_level_, first))) {
    level_ = target;
    fade_left_ = 0;
  } else if (fade_left_ == 0 && target != level_) {
    next_level_ = target;
    fade_left_ = kFade;
  }
  std::size_t count = 1;
  if (fade_left_ > 0) {
    const auto longest = std::min(increments.size(), static_cast<std::size_t>(fade_left_));
    while (count < longest && !folds_low(tables, level_, magnitude(increments[count])) &&
           !folds_low(tables, next_level_, magnitude(increments[count]))) {
      ++count;
    }
    return static_cast<int>(count);
  }
  // The level stays while level_for() would choose it.
  const std::uint64_t above = level_ == 0 ? ~std::uint64_t(0) : tables.level_limit(level_);
  const std::uint64_t below = level_ == last ? 0 : tables.level_limit(level_ + 1);
  while (count < increments.size()) {
    const std::uint64_t step = magnitude(increments[count]);
    if (step > above || (step <= below && level_ != last)) break;
    ++count;
  }
  return static_cast<int>(count);
}

void TableOscillator::render_chunk(const WaveTables& tables, const Chunk& chunk) KNOTWAVE_RT {
  const TableKernels& kernels = table_kernels_in_use();
  const auto channels = static_cast<std::size_t>(tables.channels());
  const auto read = [&](int level, std::size_t channel, float* out) {
    const WaveTables::LevelView view = tables.level_view(level);
    const TableRow row = {view.data + view.stride * channel, view.stride * channels,
                          view.size_log2};
    if (tables.rows() == 1) {
      kernels.row(row, chunk.phases, out);
    } else {
      kernels.blended(row, chunk.blends, chunk.blend_step, chunk.phases, out);
    }
  };
  const std::size_t count = chunk.phases.size();
  const std::size_t heard = chunk.right.empty() ? 1 : channels;
  for (std::size_t channel = 0; channel < heard; ++channel) {
    float* out = channel == 0 ? chunk.left.data() : chunk.right.data();
    read(level_, channel, out);
    if (fade_left_ == 0) continue;
    float next[kChunk];
    read(next_level_, channel, next);
    const float* gain = kFadeCurve.data() + (kFade - fade_left_);
    for (std::size_t i = 0; i < count; ++i) out[i] = out[i] + gain[i] * (next[i] - out[i]);
  }
  if (heard == 1 && !chunk.right.empty()) {
    std::copy(chunk.left.begin(), chunk.left.end(), chunk.right.begin());
  }
}

void TableOscillator::render(const WaveTables& tables, std::span<const base::Phase> increments,
                             std::span<const float> positions, std::span<const float> phase_offset,
                             std::span<float> out_left, std::span<float> out_right) KNOTWAVE_RT {
  const std::size_t count = out_left.size();
  KNOTWAVE_ASSERT(increments.size() >= count);
  KNOTWAVE_ASSERT(positions.empty() || positions.size() >= count);
  KNOTWAVE_ASSERT(phase_offset.empty() || phase_offset.size() >= count);
  KNOTWAVE_ASSERT(out_right.empty() || out_right.size() == count);
  std::array<base::Phase, kChunk> phases;
  WaveTables::RowBlend rest = tables.blend_at(0);
  const bool moves = tables.rows() > 1 && !positions.empty();
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t most = std::min(kChunk, count - begin);
    const auto steady =
        static_cast<std::size_t>(steady_run(tables, increments.subspan(begin, most)));
    if (fresh_) {
      phase_ = phase_ + part_of(increments[0], lead_);
      fresh_ = false;
    }
    base::Phase phase = phase_;  // in a register: a store to phases could be one to phase_
    for (std::size_t i = 0; i < steady; ++i) {
      phases[i] = phase;
      phase = phase + increments[begin + i];
    }
    phase_ = phase;
    if (!phase_offset.empty()) {
      for (std::size_t i = 0; i < steady; ++i) {
        phases[i] = phases[i] + offset_phase(phase_offset[begin + i]);
      }
    }
    const auto render_with = [&](const WaveTables::RowBlend* blends, std::size_t step) {
      render_chunk(tables,
                   {std::span(phases).first(steady), blends, step, out_left.subspan(begin, steady),
                    out_right.empty() ? out_right : out_right.subspan(begin, steady)});
    };
    const auto here = moves ? positions.subspan(begin, steady) : positions.first(0);
    if (moves) rest = tables.blend_at(double(here[0]));
    if (std::all_of(here.begin(), here.end(), [&](float place) { return place == here[0]; })) {
      render_with(&rest, 0);
    } else {  // only here, as it costs something to clear them
      std::array<WaveTables::RowBlend, kChunk> blends;
      for (std::size_t i = 0; i < steady; ++i) blends[i] = tables.blend_at(double(here[i]));
      render_with(blends.data(), 1);
    }
    if (fade_left_ > 0) {
      fade_left_ -= static_cast<int>(steady);
      if (fade_left_ == 0) level_ = next_level_;
    }
    begin += steady;
  }
}

}  // namespace knotwave::dsp
