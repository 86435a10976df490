// SPDX-License-Identifier: MIT
// Tables of numbers and sound files as data that a curve can be fitted to.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::curve_app {

struct Data {
  int dim = 0;
  std::vector<double> times;   ///< [n]
  std::vector<double> values;  ///< [n*dim]
};

/// Rows of a time and 1 to 4 values, or of one value each (time is then the row, from 0), separated
/// by ';', tabs, ',' or blanks, the first of these that the row has. Empty lines, lines that begin
/// with '#' and a first row that begins with a word are skipped. Errors: malformed with line and
/// column of the word at fault; coordinate_out_of_range (a value beyond kMaxCoordinate), the same;
/// dimension_mismatch (more than 4 values); too_few_points (no row).
Result<Data> data_of_table(std::string_view text, const std::string& source);

/// A sound (.wav, .flac, .aif, .aiff, .ogg, .w64; time is seconds, a coordinate a channel), or a
/// table. Errors: those of the file, and the above; dimension_mismatch for more than 4 channels.
Result<Data> read_data(const std::string& path);

}  // namespace knotwave::curve_app
