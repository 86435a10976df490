// SPDX-License-Identifier: MIT
#include "reference_records.h"

#include <cstdlib>

namespace knotwave::test {

std::vector<double> hex_numbers(std::istream& words) {
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

void read_curve_record(const std::string& what, std::istream& words, curves::CurveSpec& spec) {
  if (what == "curve") {
    spec = {};
    words >> spec.degree >> spec.dim >> spec.periodic;
  }
  if (what == "knots") spec.knots = hex_numbers(words);
  if (what == "points") spec.points = hex_numbers(words);
  if (what == "weights") spec.weights = hex_numbers(words);
  if (what == "jumps") spec.jumps = hex_numbers(words);
}

}  // namespace knotwave::test
