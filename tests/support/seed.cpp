// SPDX-License-Identifier: MIT
#include "support/seed.h"

#include <cstdio>
#include <cstdlib>

namespace knotwave::support {
namespace {
std::uint64_t from_environment(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : fallback;
}
}  // namespace

std::uint64_t test_seed() {
  const std::uint64_t seed = from_environment("KNOTWAVE_SEED", 1);
  std::printf("KNOTWAVE_SEED=%llu\n", static_cast<unsigned long long>(seed));
  return seed;
}

int test_count(int normal) {
  return normal * static_cast<int>(from_environment("KNOTWAVE_SCALE", 1));
}

}  // namespace knotwave::support
