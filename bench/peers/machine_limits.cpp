// SPDX-License-Identifier: MIT
// What the vector unit can do at most: the operations of a sample, without the curve, in ten
// chains that do not wait for each other. Compiled for AVX2 without fused multiply-add.
#include "linked_peers.h"
#include "peer_curve.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace peers {

#if defined(__AVX2__)
namespace {

constexpr int kChains = 10;
constexpr int kRounds = 2000;

/// Least ns of processor time a call of `work`, of many.
template <class Work>
double least_ns(const Work& work) {
  double least = 1e300;
  for (int i = 0; i < 300; ++i) {
    const double before = processor_ns();
    work();
    const double took = processor_ns() - before;
    if (took < least) least = took;
  }
  return least;
}

/// ns a vector of `products` products, `sums` sums and `divisions` divisions.
template <int Products, int Sums, int Divisions>
double floats_ns() {
  const double ns = least_ns([&] {
    __m256 by = _mm256_set1_ps(1);
    asm volatile("" : "+x"(by));  // a 1 nobody knows
    const __m256 none = _mm256_sub_ps(by, by);
    __m256 x[kChains];
    for (__m256& chain : x) chain = by;
    for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 16
      for (int k = 0; k < (Products > Sums ? Products : Sums); ++k) {
#pragma GCC unroll 16
        for (__m256& chain : x) {
          if (k < Products) chain = _mm256_mul_ps(chain, by);
          if (k < Sums) chain = _mm256_add_ps(chain, none);
        }
      }
      for (int k = 0; k < Divisions; ++k) {
#pragma GCC unroll 16
        for (__m256& chain : x) chain = _mm256_div_ps(chain, by);
      }
    }
    for (int chain = 1; chain < kChains; ++chain) x[0] = _mm256_add_ps(x[0], x[chain]);
    asm volatile("" : : "x"(x[0]));
  });
  return ns / (kRounds * kChains);
}

template <int Products, int Sums>
double doubles_ns() {
  const double ns = least_ns([&] {
    __m256d by = _mm256_set1_pd(1);
    asm volatile("" : "+x"(by));
    const __m256d none = _mm256_sub_pd(by, by);
    __m256d x[kChains];
    for (__m256d& chain : x) chain = by;
    for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 16
      for (int k = 0; k < (Products > Sums ? Products : Sums); ++k) {
#pragma GCC unroll 16
        for (__m256d& chain : x) {
          if (k < Products) chain = _mm256_mul_pd(chain, by);
          if (k < Sums) chain = _mm256_add_pd(chain, none);
        }
      }
    }
    for (int chain = 1; chain < kChains; ++chain) x[0] = _mm256_add_pd(x[0], x[chain]);
    asm volatile("" : : "x"(x[0]));
  });
  return ns / (kRounds * kChains);
}

double store_ns() {
  alignas(32) static float buffer[256];
  const double ns = least_ns([&] {
    const __m256 y = _mm256_set1_ps(1);
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i < 256; i += 8) _mm256_store_ps(buffer + i, y);
      asm volatile("" ::: "memory");
    }
  });
  return ns / (kRounds * 32);
}

}  // namespace

MachineLimits machine_limits() {
  if (!__builtin_cpu_supports("avx2")) return {};
  // 2 more sums for what makes 4 doubles into floats: it takes the same units.
  return {floats_ns<4, 4, 0>() / 8, floats_ns<7, 7, 1>() / 8, doubles_ns<9, 12>() / 4,
          store_ns() / 8};
}

#else

MachineLimits machine_limits() { return {}; }

#endif

}  // namespace peers
