// SPDX-License-Identifier: MIT
#include "knotwave/dsp/fft.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/seed.h"

namespace {

using Complex = std::complex<double>;
using knotwave::dsp::CycleSynthesis;
using knotwave::dsp::fft;
using knotwave::dsp::harmonics_of_cycle;

std::vector<Complex> random_values(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Complex> values(size);
  for (Complex& value : values) value = {uniform(generator), uniform(generator)};
  return values;
}

/// The definition, with the products jk reduced exactly and libm in long double.
std::vector<Complex> slow_transform(const std::vector<Complex>& values, bool inverse) {
  const std::size_t size = values.size();
  std::vector<Complex> out(size);
  for (std::size_t k = 0; k < size; ++k) {
    std::complex<long double> sum = 0;
    for (std::size_t j = 0; j < size; ++j) {
      const long double turns =
          static_cast<long double>(j * k % size) / static_cast<long double>(size);
      const long double angle = 2 * std::acos(-1.0L) * turns * (inverse ? 1 : -1);
      sum += std::complex<long double>(values[j]) *
             std::complex<long double>(std::cos(angle), std::sin(angle));
    }
    out[k] = Complex(sum);
  }
  return out;
}

double relative_rms(const std::vector<Complex>& found, const std::vector<Complex>& truth) {
  double error = 0, power = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    error += std::norm(found[k] - truth[k]);
    power += std::norm(truth[k]);
  }
  return std::sqrt(error / power);
}

TEST(Fft, AgreesWithTheDefinitionForEveryLengthUpTo130) {
  const std::uint64_t seed = knotwave::support::test_seed();
  for (std::size_t size = 1; size <= 130; ++size) {
    const auto values = random_values(size, seed + size);
    for (const bool inverse : {false, true}) {
      auto found = values;
      fft(found, inverse);
      EXPECT_LT(relative_rms(found, slow_transform(values, inverse)), 4e-15) << "length " << size;
    }
  }
}

TEST(Fft, ForwardAndInverseGiveTheValuesBackTimesTheLength) {
  for (const std::size_t size : {4096UL, 600UL, 2047UL, 65536UL}) {
    const auto values = random_values(size, size);
    auto found = values;
    fft(found, false);
    fft(found, true);
    for (Complex& value : found) value /= static_cast<double>(size);
    EXPECT_LT(relative_rms(found, values), 4e-15) << "length " << size;
  }
}

TEST(Fft, HarmonicsOfACycleAreThoseItWasMadeOf) {
  // 600 samples is the length of a well-known collection of single cycles.
  for (const std::size_t size : {64UL, 600UL, 601UL}) {
    std::vector<double> cycle(size);
    for (std::size_t k = 0; k < size; ++k) {
      const double angle = 2 * std::acos(-1.0) * static_cast<double>(k) / static_cast<double>(size);
      cycle[k] = 0.25 + std::sin(angle) - 0.5 * std::cos(7 * angle);
    }
    const auto harmonics = harmonics_of_cycle(cycle, 400);
    ASSERT_EQ(harmonics.size(), 401U);
    for (std::size_t n = 0; n < harmonics.size(); ++n) {
      const Complex expected = n == 0   ? Complex(0.25, 0)
                               : n == 1 ? Complex(0, -0.5)
                               : n == 7 ? Complex(-0.25, 0)
                                        : Complex(0, 0);
      EXPECT_LT(std::abs(harmonics[n] - expected), 1e-15) << "harmonic " << n << " of " << size;
    }
  }
}

TEST(Fft, ACycleIsMadeFromItsHarmonics) {
  const auto harmonics = random_values(32, 7);
  std::vector<double> cycle(64);
  CycleSynthesis(64).render(harmonics, cycle);
  for (std::size_t k = 0; k < cycle.size(); ++k) {
    double expected = harmonics[0].real();
    for (std::size_t n = 1; n < harmonics.size(); ++n) {
      const double angle = 2 * std::acos(-1.0) * static_cast<double>(n * k) / 64;
      expected += 2 * (harmonics[n] * Complex(std::cos(angle), std::sin(angle))).real();
    }
    EXPECT_NEAR(cycle[k], expected, 1e-13) << "sample " << k;
  }
}

}  // namespace
