// SPDX-License-Identifier: MIT
// The program of the determinism matrix.
#include "bits.h"

#include <cstdio>
#include <string_view>

#include "knotwave/base/sha256.h"
#include "knotwave/curves/simd.h"

namespace knotwave::bits {
namespace {
void print_bytes(const std::string& name, std::span<const std::byte> bytes) {
  base::Sha256 hash;
  hash.update(bytes);
  std::printf("%s %s\n", name.c_str(), hash.finish_hex().c_str());
}

/// The vector unit of each family of kernels, for the log.
void say_units() {
  for (const auto& use : curves::simd_kernels_in_use()) {
    std::fprintf(stderr, "%s on %s; ", use.family.c_str(), use.unit.c_str());
  }
  std::fputs("\n", stderr);
}

/// False, with a message, where there is no such level here.
bool choose_level(std::string_view name) {
  using curves::SimdLevel;
  for (const SimdLevel level : {SimdLevel::best, SimdLevel::avx2, SimdLevel::baseline}) {
    if (name != to_string(level)) continue;
    const auto set = curves::set_simd_level(level);
    if (!set) std::fprintf(stderr, "knotwave_bits: %s\n", set.error().message.c_str());
    if (set) say_units();
    return set.has_value();
  }
  std::fprintf(stderr, "knotwave_bits: no level is named thus\n");
  return false;
}

}  // namespace

void print(const std::string& name, std::span<const double> numbers) {
  print_bytes(name, std::as_bytes(numbers));
}
void print(const std::string& name, std::span<const float> numbers) {
  print_bytes(name, std::as_bytes(numbers));
}

}  // namespace knotwave::bits

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: knotwave_bits EXAMPLES best|avx2|baseline\n", stderr);
    return 2;
  }
  if (!knotwave::bits::choose_level(argv[2])) return 1;
  knotwave::bits::base();
  knotwave::bits::curves();
  knotwave::bits::dsp();
  knotwave::bits::engine(argv[1]);
}
