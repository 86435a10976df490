// SPDX-License-Identifier: MIT
// The program of the determinism matrix.
#include "bits.h"

#include <cstdio>

#include "knotwave/base/sha256.h"

namespace knotwave::bits {
namespace {
void print_bytes(const std::string& name, std::span<const std::byte> bytes) {
  base::Sha256 hash;
  hash.update(bytes);
  std::printf("%s %s\n", name.c_str(), hash.finish_hex().c_str());
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
  if (argc != 2) {
    std::fputs("usage: knotwave_bits EXAMPLES\n", stderr);
    return 2;
  }
  knotwave::bits::base();
  knotwave::bits::curves();
  knotwave::bits::dsp();
  knotwave::bits::engine(argv[1]);
}
