// SPDX-License-Identifier: MIT
#include "knotwave/curves/fit.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "curve_output.h"
#include "data_file.h"

namespace knotwave::curve_app {
namespace {

constexpr std::size_t kMaxData = 1 << 18;  // about half a minute

/// As asked, else what the file is called where that is a name.
std::string name_of(const CurveOptions& options) {
  if (!options.name.empty()) return options.name;
  const std::string stem = std::filesystem::path(options.files.front()).stem().string();
  return curves::is_valid_name(stem) ? stem : "fitted";
}

}  // namespace

Result<Made> fitted(const CurveOptions& options) {
  const auto data = read_data(options.files.front());
  if (!data) return data.error();
  if (data->times.size() > kMaxData) {
    return told_of(options.files.front(),
                   fail(ErrorCode::file_too_large, std::to_string(data->times.size()) +
                                                       " data; a fit takes at most " +
                                                       std::to_string(kMaxData)));
  }
  double largest = 0;
  for (const double value : data->values) largest = std::max(largest, std::abs(value));
  if (largest == 0) largest = 1;
  const int degree = options.degree > 0 ? options.degree : 3;
  const auto fit =
      options.points > 0
          ? curves::approximate(data->times, data->values, data->dim, degree, options.points)
          : curves::reduce_data(data->times, data->values, tolerance_of(options, largest), degree,
                                data->dim);
  if (!fit) return told_of(options.files.front(), fit.error());
  const auto named = renamed(fit->curve, name_of(options));
  if (!named) return named.error();
  const std::string where =
      options.points > 0 ? " data; at them within " : " data; between them too within ";
  return made_of({{*named}, {}},
                 std::to_string(data->times.size()) + where + error_text(fit->max_error, largest));
}

}  // namespace knotwave::curve_app
