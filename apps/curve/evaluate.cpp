// SPDX-License-Identifier: MIT
#include <charconv>

#include "knotwave/base/document.h"
#include "knotwave/curves/map_grid.h"

#include "command_line/json.h"
#include "curve_input.h"
#include "verbs.h"

namespace knotwave::curve_app {
namespace {

using command_line::json_number;
using curves::NurbsCurve;
using curves::NurbsSurface;

/// A row of output: where, and the value with its derivatives, each of `dim` numbers.
struct Row {
  Parameter at;
  std::vector<double> numbers;
};

Error outside(const char* letter, double value, double low, double high) {
  return fail(ErrorCode::parameter_out_of_range,
              std::string(letter) + " = " + base::number_text(value) + " is outside " +
                  base::number_text(low) + ".." + base::number_text(high));
}

Result<std::vector<Row>> rows_of(const NurbsCurve& curve, const CurveOptions& options) {
  std::vector<Parameter> places = options.at;
  const curves::MapGrid grid{curve.u_min(), curve.u_max(), options.grid};
  for (int i = 0; options.grid > 0 && i <= options.grid; ++i) places.push_back({grid.at(i), {}});
  std::vector<Row> rows;
  for (const Parameter place : places) {
    if (place.v) return fail(ErrorCode::usage, "--at u:v is for surfaces, this is a curve");
    if (!curve.is_periodic() && !(place.u >= curve.u_min() && place.u <= curve.u_max())) {
      return outside("u", place.u, curve.u_min(), curve.u_max());
    }
    Row row{place, std::vector<double>(std::size_t((options.derivatives + 1) * curve.dim()))};
    curve.derivatives(place.u, options.derivatives, curves::Side::right, row.numbers);
    rows.push_back(std::move(row));
  }
  return rows;
}

Result<std::vector<Row>> rows_of(const NurbsSurface& surface, const CurveOptions& options) {
  std::vector<Parameter> places = options.at;
  const curves::MapGrid u{surface.u_min(), surface.u_max(), options.grid};
  const curves::MapGrid v{surface.v_min(), surface.v_max(), options.grid};
  if (options.grid > 1000) return fail(ErrorCode::usage, "--grid of a surface: 1000 at most");
  for (int j = 0; options.grid > 0 && j <= options.grid; ++j) {
    for (int i = 0; i <= options.grid; ++i) places.push_back({u.at(i), v.at(j)});
  }
  const int order = options.derivatives, dim = surface.dim();
  std::vector<double> all(std::size_t((order + 1) * (order + 1) * dim));
  std::vector<Row> rows;
  for (const Parameter place : places) {
    if (!place.v) return fail(ErrorCode::usage, "a surface takes --at u:v");
    if (!surface.is_periodic_u() && !(place.u >= surface.u_min() && place.u <= surface.u_max())) {
      return outside("u", place.u, surface.u_min(), surface.u_max());
    }
    if (!(*place.v >= surface.v_min() && *place.v <= surface.v_max())) {
      return outside("v", *place.v, surface.v_min(), surface.v_max());
    }
    surface.derivatives(place.u, *place.v, order, all);
    Row row{place, {}};
    for (int total = 0; total <= order; ++total) {  // uu, uv, vv
      for (int l = 0; l <= total; ++l) {
        const int first = ((total - l) * (order + 1) + l) * dim;
        row.numbers.insert(row.numbers.end(), all.begin() + first, all.begin() + first + dim);
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// 17 significant digits: reads back as the same double.
std::string digits17(double value) {
  char text[40];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr;
  return {text, end};
}

std::string table_of(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    text += digits17(row.at.u);
    if (row.at.v) text += "\t" + digits17(*row.at.v);
    for (const double number : row.numbers) text += "\t" + digits17(number);
    text += "\n";
  }
  return text;
}

std::string json_of(const std::vector<Row>& rows, const std::string& name, int dim) {
  std::string text = "{\"name\": " + command_line::json_string(name) + ", \"rows\": [\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += "  {\"u\": " + json_number(rows[i].at.u);
    if (rows[i].at.v) text += ", \"v\": " + json_number(*rows[i].at.v);
    const auto list = [&](std::size_t first) {
      std::string numbers = "[";
      for (int c = 0; c < dim; ++c) {
        numbers += (c == 0 ? "" : ", ") + json_number(rows[i].numbers[first + std::size_t(c)]);
      }
      return numbers + "]";
    };
    text += ", \"value\": " + list(0);
    std::string derivatives;
    for (std::size_t k = std::size_t(dim); k < rows[i].numbers.size(); k += std::size_t(dim)) {
      derivatives += (derivatives.empty() ? "" : ", ") + list(k);
    }
    if (!derivatives.empty()) text += ", \"derivatives\": [" + derivatives + "]";
    text += i + 1 < rows.size() ? "},\n" : "}\n";
  }
  return text + "]}\n";
}

}  // namespace

Result<std::string> eval_text(const CurveOptions& options) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  return std::visit(
      [&options](const auto& shape) -> Result<std::string> {
        const auto rows = rows_of(shape, options);
        if (!rows) {
          Error error = rows.error();
          if (error.code != ErrorCode::usage) error.source = options.files.front();
          return error;
        }
        return options.json ? json_of(*rows, shape.name(), shape.dim()) : table_of(*rows);
      },
      *item);
}

}  // namespace knotwave::curve_app
