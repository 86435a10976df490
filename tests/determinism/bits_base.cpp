// SPDX-License-Identifier: MIT
#include <vector>

#include "knotwave/base/elementary.h"
#include "knotwave/base/random.h"
#include "knotwave/base/time.h"

#include "bits.h"

namespace knotwave::bits {
namespace {

constexpr int kCount = 40001;

template <class Function>
void print_function(const char* name, double low, double high, Function function) {
  std::vector<double> values;
  for (int i = 0; i < kCount; ++i) values.push_back(function(spread(low, high, i, kCount)));
  print(name, values);
}

}  // namespace

void base() {
  print_function("exp2", -1100, 1100, [](double x) { return base::exp2(x); });
  print_function("log2", -1, 1e6, [](double x) { return base::log2(x); });
  print_function("sin", -300, 300, [](double x) { return base::sin_cos_cycles(x).sin; });
  print_function("cos", -300, 300, [](double x) { return base::sin_cos_cycles(x).cos; });
  print_function("tanh", -25, 25, [](double x) { return base::tanh(x); });
  print_function("note_to_hz", -200, 300, [](double x) { return base::note_to_hz(x); });
  print_function("db_to_gain", -300, 300, [](double x) { return base::db_to_gain(x); });
  print_function("gain_to_db", 0, 4, [](double x) { return base::gain_to_db(x); });
  print_function("phase", -3, 3, [](double x) { return base::phase_from_cycles(x).cycles(); });
  std::vector<double> in;
  for (int i = 0; i < kCount; ++i) in.push_back(spread(-20, 20, i, kCount));
  std::vector<double> out(in.size());
  base::exp2(in, out);
  print("exp2_of_a_span", out);
  const base::RandomStream stream{1, 2, base::kRandomNoise};
  for (int i = 0; i < kCount; ++i) {
    out[static_cast<std::size_t>(i)] = stream.bipolar(static_cast<std::uint64_t>(i));
  }
  print("random", out);
}

}  // namespace knotwave::bits
