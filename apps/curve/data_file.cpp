// SPDX-License-Identifier: MIT
#include "data_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "knotwave/base/document.h"
#include "knotwave/base/file.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/io/sound_file.h"

#include "command_line/options.h"

namespace knotwave::curve_app {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{64} << 20;
constexpr auto kSoundEndings =
    std::to_array<std::string_view>({".wav", ".flac", ".aif", ".aiff", ".ogg", ".w64"});

Error too_wide(const std::string& path, int line, std::string message) {
  return {ErrorCode::dimension_mismatch, std::move(message), path, line, 0, -1};
}

Result<Data> data_of_sound(const std::string& path) {
  const auto sound = io::read_sound(path);
  if (!sound) return sound.error();
  if (sound->channels > curves::kMaxDim) {
    return too_wide(path, 0,
                    std::to_string(sound->channels) + " channels; a curve has at most " +
                        std::to_string(curves::kMaxDim) + " coordinates");
  }
  Data data{sound->channels, {}, {sound->samples.begin(), sound->samples.end()}};
  for (std::int64_t i = 0; i < sound->frames; ++i) {
    data.times.push_back(static_cast<double>(i) / sound->rate_hz);
  }
  return data;
}

/// A word of a row and where it begins, from 0.
struct Cell {
  std::string_view text;
  std::size_t column = 0;
};

constexpr std::string_view kBlanks = " \t\r";

std::vector<Cell> cells_of(std::string_view row) {
  const auto has = [row](char c) { return row.find(c) != std::string_view::npos; };
  const char mark = has(';') ? ';' : has('\t') ? '\t' : has(',') ? ',' : ' ';
  std::vector<Cell> cells;
  for (std::size_t at = 0; at <= row.size();) {
    const std::size_t end = std::min(row.find(mark, at), row.size());
    const std::size_t from = std::min(row.find_first_not_of(kBlanks, at), end);
    std::string_view text = row.substr(from, end - from);
    text = text.substr(0, text.find_last_not_of(kBlanks) + 1);
    if (mark != ' ' || !text.empty()) cells.push_back({text, from});
    at = end + 1;
  }
  return cells;
}

/// Rows one by one. The first fault is kept.
class Table {
 public:
  explicit Table(const std::string& path) : path_(path) {}

  Result<void> add(std::string_view row, int line) {
    const std::size_t start = row.find_first_not_of(kBlanks);
    if (start == std::string_view::npos || row[start] == '#') return {};
    const std::vector<Cell> cells = cells_of(row);
    const bool is_heading = !is_begun_ && !command_line::number_in(cells.front().text);
    is_begun_ = true;
    if (is_heading) return {};
    if (data_.dim == 0) {
      columns_ = cells.size();
      data_.dim = static_cast<int>(std::max<std::size_t>(columns_, 2) - 1);
      if (data_.dim > curves::kMaxDim) {
        return too_wide(path_, line,
                        std::to_string(columns_) + " columns; a time and 1 to 4 values are read");
      }
    }
    return add_numbers(cells, line);
  }

  Result<Data> data() && {
    if (data_.times.empty()) {
      return Error{ErrorCode::too_few_points, "no row of numbers", path_, 0, 0, -1};
    }
    return std::move(data_);
  }

 private:
  Result<void> add_numbers(const std::vector<Cell>& cells, int line) {
    if (cells.size() != columns_) {
      return Error{ErrorCode::malformed,
                   std::to_string(cells.size()) + " columns, but " + std::to_string(columns_) +
                       " in the rows before",
                   path_,
                   line,
                   0,
                   -1};
    }
    if (columns_ == 1) data_.times.push_back(static_cast<double>(data_.times.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto number = command_line::number_in(cells[i].text);
      if (!number) {
        return Error{ErrorCode::malformed,
                     "'" + std::string(cells[i].text) + "' is not a number (1.5, 2e-3)",
                     path_,
                     line,
                     static_cast<int>(cells[i].column) + 1,
                     -1};
      }
      const bool is_time = i == 0 && columns_ > 1;
      if (!is_time && std::abs(*number) > curves::kMaxCoordinate) {
        const std::size_t datum = data_.values.size() / static_cast<std::size_t>(data_.dim);
        return Error{ErrorCode::coordinate_out_of_range,
                     "datum " + std::to_string(datum) + " (" + base::number_text(*number) +
                         ") is outside -" + base::number_text(curves::kMaxCoordinate) + ".." +
                         base::number_text(curves::kMaxCoordinate),
                     path_,
                     line,
                     static_cast<int>(cells[i].column) + 1,
                     -1};
      }
      (is_time ? data_.times : data_.values).push_back(*number);
    }
    return {};
  }

  const std::string& path_;
  Data data_;
  std::size_t columns_ = 0;
  bool is_begun_ = false;
};

}  // namespace

Result<Data> data_of_table(std::string_view text, const std::string& source) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Table table(source);
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto added = table.add(text.substr(0, end), line); !added) return added.error();
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::move(table).data();
}

Result<Data> read_data(const std::string& path) {
  for (const auto ending : kSoundEndings) {
    if (base::has_ending(path, ending)) return data_of_sound(path);
  }
  const auto file = base::read_file(path, kMaxTableBytes);
  if (!file) return file.error();
  return data_of_table(*file, path);
}

}  // namespace knotwave::curve_app
