// SPDX-License-Identifier: MIT
// A value over a chunk of samples: one number while it rests, one a sample while it moves. Both
// give the same bits, because both go through the same operations in the same order.
#pragma once
#include <array>
#include <cstddef>

#include "knotwave/base/elementary.h"
#include "knotwave/base/rt.h"
#include "knotwave/dsp/elementary_block.h"

namespace knotwave::engine {

/// Voices are rendered in chunks of at most this many samples. No result depends on it.
inline constexpr std::size_t kChunk = 64;
using ChunkBuffer = std::array<double, kChunk>;

struct Signal {
  double constant = 0;
  const double* values = nullptr;  ///< [chunk length], or null: `constant` throughout

  bool is_constant() const KNOTWAVE_RT { return values == nullptr; }
  bool is_zero() const KNOTWAVE_RT { return values == nullptr && constant == 0; }
  double at(std::size_t i) const KNOTWAVE_RT { return values == nullptr ? constant : values[i]; }
};

/// f of every value; `buffer` holds the result where it moves and may be what `in` points to.
template <class F>
Signal mapped(const Signal& in, std::size_t n, ChunkBuffer& buffer, F&& f) KNOTWAVE_RT {
  if (in.is_constant()) return {f(in.constant), nullptr};
  // Two loops, so that the compiler sees that a value depends on its own place alone.
  double* __restrict const out = buffer.data();
  if (in.values == buffer.data()) {
    for (std::size_t i = 0; i < n; ++i) out[i] = f(out[i]);
  } else {
    const double* __restrict const from = in.values;
    for (std::size_t i = 0; i < n; ++i) out[i] = f(from[i]);
  }
  return {0, buffer.data()};
}

/// f of two; `buffer` may be what `a` or `b` points to.
template <class F>
Signal combined(const Signal& a, const Signal& b, std::size_t n, ChunkBuffer& buffer,
                F&& f) KNOTWAVE_RT {
  if (a.is_constant() && b.is_constant()) return {f(a.constant, b.constant), nullptr};
  if (a.is_constant()) {
    for (std::size_t i = 0; i < n; ++i) buffer[i] = f(a.constant, b.values[i]);
  } else if (b.is_constant()) {
    for (std::size_t i = 0; i < n; ++i) buffer[i] = f(a.values[i], b.constant);
  } else {
    for (std::size_t i = 0; i < n; ++i) buffer[i] = f(a.values[i], b.values[i]);
  }
  return {0, buffer.data()};
}

inline Signal sum(const Signal& a, const Signal& b, std::size_t n,
                  ChunkBuffer& buffer) KNOTWAVE_RT {
  return combined(a, b, n, buffer, [](double x, double y) { return x + y; });
}
inline Signal product(const Signal& a, const Signal& b, std::size_t n,
                      ChunkBuffer& buffer) KNOTWAVE_RT {
  return combined(a, b, n, buffer, [](double x, double y) { return x * y; });
}

/// 2^x of every value, as mapped().
inline Signal power_of_2(const Signal& in, std::size_t n, ChunkBuffer& buffer) KNOTWAVE_RT {
  if (in.is_constant()) return {base::exp2(in.constant), nullptr};
  dsp::exp2(std::span(in.values, n), std::span(buffer).first(n));
  return {0, buffer.data()};
}
/// Gain of every level in decibels, as mapped().
inline Signal gain_of_db(const Signal& in, std::size_t n, ChunkBuffer& buffer) KNOTWAVE_RT {
  if (in.is_constant()) return {base::db_to_gain(in.constant), nullptr};
  dsp::db_to_gain(std::span(in.values, n), std::span(buffer).first(n));
  return {0, buffer.data()};
}

}  // namespace knotwave::engine
