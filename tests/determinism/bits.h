// SPDX-License-Identifier: MIT
// What the determinism matrix compares: every subject is a name and the bits of its numbers. The
// program built by each row prints one line a subject. To add one, add a line to the module's file.
#pragma once
#include <span>
#include <string>

namespace knotwave::bits {

/// Prints "NAME SHA256" of the numbers' bits (doubles as they are, little-endian).
void print(const std::string& name, std::span<const double> numbers);
void print(const std::string& name, std::span<const float> numbers);

/// `count` numbers spread evenly over low..high, without libm.
inline double spread(double low, double high, int index, int count) {
  return low + (high - low) * (static_cast<double>(index) / static_cast<double>(count - 1));
}

void base();
void curves();
void dsp();
/// `examples`: the folder of that name.
void engine(const std::string& examples);

}  // namespace knotwave::bits
