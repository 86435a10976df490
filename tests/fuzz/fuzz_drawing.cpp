// SPDX-License-Identifier: MIT
// Any bytes as a drawing and as a table: either an error that says where, or curves that a curve
// file holds, and a table that a curve comes near to.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "knotwave/curves/curve_file.h"
#include "knotwave/curves/fit.h"
#include "knotwave/curves/svg_path.h"

#include "data_file.h"
#include "fuzz_check.h"
#include "svg_file.h"

namespace {

using namespace knotwave;

void read_as_path(const std::string& d) {
  const auto drawn = curves::curves_from_svg_path(d);
  if (!drawn) {
    FUZZ_CHECK(!drawn.error().message.empty());
    return;
  }
  for (const auto& curve : *drawn) {
    const auto square = curves::in_unit_square(curve);
    FUZZ_CHECK(square || square.error().code == ErrorCode::coordinate_out_of_range);
    const auto again = curves::parse_curves(curves::write_curves({{curve}, {}}), "written.toml");
    FUZZ_CHECK(!again || again->curves.front() == curve);
    FUZZ_CHECK(again || again.error().code == ErrorCode::file_too_large);
  }
}

void read_as_drawing(std::string_view text) {
  const auto paths = curve_app::svg_paths(text, "fuzz.svg");
  if (!paths) {
    FUZZ_CHECK(paths.error().code == ErrorCode::malformed && paths.error().line >= 1);
    return;
  }
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const auto& path : *paths) {
    FUZZ_CHECK(path.line >= 1 && path.line <= lines);
    read_as_path(path.d);
  }
}

void read_as_table(std::string_view text) {
  const auto data = curve_app::data_of_table(text, "fuzz.csv");
  if (!data) {
    const bool is_empty = data.error().code == ErrorCode::too_few_points;
    FUZZ_CHECK(is_empty == (data.error().line == 0));
    return;
  }
  FUZZ_CHECK(data->dim >= 1 && data->dim <= curves::kMaxDim);
  FUZZ_CHECK(data->values.size() == data->times.size() * std::size_t(data->dim));
  if (data->times.size() > 40) return;
  const auto fit = curves::reduce_data(data->times, data->values, 0.01, 3, data->dim);
  FUZZ_CHECK(!fit || fit->max_error <= 0.01);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  read_as_drawing(text);
  read_as_path(text);
  read_as_table(text);
  return 0;
}
