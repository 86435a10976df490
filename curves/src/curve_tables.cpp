// SPDX-License-Identifier: MIT
// [curves.*] and [surfaces.*] tables to checked curves; every fault at the number that has it.
#include <algorithm>
#include <set>

#include "knotwave/base/suggest.h"
#include "knotwave/curves/curve_file.h"

#include "spec_checks.h"

namespace knotwave::curves {
namespace {

using base::Node;
using base::TableReader;

// Where each number of a spec stands. Points and weights are in the flat order of the spec.
struct Places {
  const Node* table = nullptr;
  const Node* degree = nullptr;
  const Node* degree_v = nullptr;
  const Node* points = nullptr;
  const Node* weights = nullptr;
  const Node* knots = nullptr;
  const Node* knots_v = nullptr;
  const Node* jumps = nullptr;
};

// Number `index` of nested arrays, counted in reading order; the array itself if there is none.
const Node* number_at(const Node& array, int& index) {
  for (const Node& item : array.items) {
    if (item.kind == Node::Kind::array) {
      const Node* found = number_at(item, index);
      if (index < 0) return found;
    } else if (index-- == 0) {
      return &item;
    }
  }
  return &array;
}

const Node& place_of(const SpecFault& fault, const Places& places) {
  const Node* part = nullptr;
  switch (fault.part) {
    case SpecFault::Part::degree:
      part = places.degree;
      break;
    case SpecFault::Part::degree_v:
      part = places.degree_v;
      break;
    case SpecFault::Part::points:
      part = places.points;
      break;
    case SpecFault::Part::weights:
      part = places.weights;
      break;
    case SpecFault::Part::knots:
      part = places.knots;
      break;
    case SpecFault::Part::knots_v:
      part = places.knots_v;
      break;
    case SpecFault::Part::jumps:
      part = places.jumps;
      break;
  }
  if (part == nullptr) return *places.table;
  int index = fault.index;
  return index < 0 ? *part : *number_at(*part, index);
}

Error error_of(SpecFault fault, const Places& places, std::string_view source) {
  const Node& at = place_of(fault, places);
  fault.error.source = source;
  fault.error.line = at.line;
  fault.error.column = at.column;
  return std::move(fault.error);
}

// One point, a number or an array of up to four, to the end of `out`. The first decides `dim`.
bool read_point(TableReader& reader, const Node& point, int& dim, std::vector<double>& out) {
  const bool scalar = point.is_number();
  if (!scalar && point.kind != Node::Kind::array) {
    reader.fail_at(point, ErrorCode::wrong_type,
                   "a point must be a number or an array of up to " + std::to_string(kMaxDim));
    return false;
  }
  const int count = scalar ? 1 : static_cast<int>(std::min<std::size_t>(point.items.size(), 99));
  if (dim == 0) dim = count;
  if (count < 1 || count > kMaxDim) {
    reader.fail_at(point, ErrorCode::dimension_mismatch,
                   "a point has " + std::to_string(count) + " coordinates, 1 to " +
                       std::to_string(kMaxDim) + " are possible");
    return false;
  }
  if (count != dim) {
    reader.fail_at(point, ErrorCode::dimension_mismatch,
                   "this point has " + std::to_string(count) + " coordinates, the first has " +
                       std::to_string(dim));
    return false;
  }
  if (scalar) {
    out.push_back(point.number);
    return true;
  }
  for (const Node& coordinate : point.items) {
    if (!coordinate.is_number()) {
      reader.fail_at(coordinate, ErrorCode::wrong_type, "a coordinate must be a number");
      return false;
    }
    out.push_back(coordinate.number);
  }
  return true;
}

bool read_row(TableReader& reader, const Node& row, int& dim, std::vector<double>& out) {
  return std::all_of(row.items.begin(), row.items.end(),
                     [&](const Node& point) { return read_point(reader, point, dim, out); });
}

// Rows of equal length. For weights pass the dim 1.
bool read_rows(TableReader& reader, const Node& rows, std::string_view what, int& dim, int& count_u,
               std::vector<double>& out) {
  for (const Node& row : rows.items) {
    if (row.kind != Node::Kind::array) {
      reader.fail_at(row, ErrorCode::wrong_type,
                     std::string(what) + " of a surface are rows: [[...], [...]]");
      return false;
    }
    const int count = static_cast<int>(row.items.size());
    if (count_u == 0) count_u = count;
    if (count != count_u || count == 0) {
      reader.fail_at(row, ErrorCode::dimension_mismatch,
                     "this row has " + std::to_string(count) + " " + std::string(what) +
                         ", the first has " + std::to_string(count_u));
      return false;
    }
    if (!read_row(reader, row, dim, out)) return false;
  }
  return true;
}

int read_degree(TableReader& reader, std::string_view key, const Node*& place) {
  place = reader.required(key);
  return reader.integer(key, 1, 1, kMaxDegree);
}

const Node* read_numbers(TableReader& reader, std::string_view key, std::vector<double>& out) {
  out = reader.numbers(key);
  return reader.node(key);
}

Result<NurbsCurve> read_curve(const Node& table, const std::string& name, std::string_view source) {
  TableReader reader(table, source, "curve '" + name + "'");
  CurveSpec spec;
  Places places;
  spec.name = name;
  spec.dim = 0;
  places.table = &table;
  spec.degree = read_degree(reader, "degree", places.degree);
  places.points = reader.required("points") != nullptr ? reader.array("points") : nullptr;
  if (places.points != nullptr) read_row(reader, *places.points, spec.dim, spec.points);
  if (spec.dim == 0) spec.dim = 1;
  places.weights = read_numbers(reader, "weights", spec.weights);
  places.knots = read_numbers(reader, "knots", spec.knots);
  places.jumps = read_numbers(reader, "jumps", spec.jumps);
  spec.periodic = reader.boolean("periodic", false);
  if (const auto read = reader.finish(); !read) return read.error();
  if (auto fault = find_fault(spec)) return error_of(std::move(*fault), places, source);
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsSurface> read_surface(const Node& table, const std::string& name,
                                  std::string_view source) {
  TableReader reader(table, source, "surface '" + name + "'");
  SurfaceSpec spec;
  Places places;
  spec.name = name;
  spec.dim = 0;
  places.table = &table;
  spec.degree_u = read_degree(reader, "degree_u", places.degree);
  spec.degree_v = read_degree(reader, "degree_v", places.degree_v);
  places.points = reader.required("points") != nullptr ? reader.array("points") : nullptr;
  if (places.points != nullptr) {
    read_rows(reader, *places.points, "points", spec.dim, spec.count_u, spec.points);
    spec.count_v = static_cast<int>(places.points->items.size());
  }
  if (spec.dim == 0) spec.dim = 1;
  if (places.weights = reader.array("weights"); places.weights != nullptr) {
    int one = 1;
    int count_u = spec.count_u;
    read_rows(reader, *places.weights, "weights", one, count_u, spec.weights);
  }
  places.knots = read_numbers(reader, "knots_u", spec.knots_u);
  places.knots_v = read_numbers(reader, "knots_v", spec.knots_v);
  spec.periodic_u = reader.boolean("periodic_u", false);
  if (const auto read = reader.finish(); !read) return read.error();
  if (auto fault = find_fault(spec)) return error_of(std::move(*fault), places, source);
  return NurbsSurface::create(std::move(spec));
}

// What a reference stands for: the curve or surface of another file under the name of this table.
template <class Item>
Result<Item> read_reference(const Node& table, const std::string& name, std::string_view source,
                            const std::string& what, const CurveFileLookup& lookup,
                            const Item* (CurveSet::*find)(std::string_view) const) {
  TableReader reader(table, source, what);
  const std::string reference = reader.string("curve_file");
  const Node& at = *table.find("curve_file");
  if (table.members.size() > 1) {
    reader.fail_at(at, ErrorCode::malformed, "a table with curve_file has no other key");
  }
  if (const auto read = reader.finish(); !read) return read.error();
  if (!lookup) {
    reader.fail_at(at, ErrorCode::unsupported,
                   "curve_file is for patches; a curve file holds its own points");
    return reader.finish().error();
  }
  const std::size_t hash = reference.find('#');
  const std::string wanted = hash == std::string::npos ? name : reference.substr(hash + 1);
  const auto set = lookup(reference.substr(0, hash));
  if (!set) {
    if (!set.error().source.empty()) return set.error();
    reader.fail_at(at, set.error().code, set.error().message);
    return reader.finish().error();
  }
  const Item* found = ((**set).*find)(wanted);
  if (found == nullptr) {
    reader.fail_at(at, ErrorCode::unknown_name,
                   "there is no '" + wanted + "' of this kind in " + reference.substr(0, hash) +
                       base::suggestion(wanted, (**set).names()));
    return reader.finish().error();
  }
  auto spec = found->spec();
  spec.name = name;
  return Item::create(std::move(spec));
}

Error fault_at(const Node::Member& member, std::string_view source, ErrorCode code,
               std::string message) {
  Error error = fail(code, std::move(message));
  error.source = source;
  error.line = member.line;
  error.column = member.column;
  return error;
}

Result<void> check_member(const Node::Member& member, std::string_view kind,
                          std::string_view source, std::set<std::string_view>& names) {
  const std::string what = std::string(kind) + " '" + member.key + "'";
  if (member.value.kind != Node::Kind::table) {
    return fault_at(member, source, ErrorCode::wrong_type, what + " must be a table");
  }
  if (!is_valid_name(member.key)) {
    return fault_at(member, source, ErrorCode::malformed,
                    what + ": a name is 1 to 64 letters, digits, '_' and '-'");
  }
  if (!names.insert(member.key).second) {
    return fault_at(member, source, ErrorCode::duplicate_name,
                    what + ": a curve of this file has the same name");
  }
  return {};
}

}  // namespace

Result<CurveSet> read_curve_tables(const base::Node& root, std::string_view source_name,
                                   const CurveFileLookup& lookup) {
  CurveSet set;
  std::set<std::string_view> names;
  TableReader reader(root, source_name, "file");
  const Node* curves = reader.table("curves");
  const Node* surfaces = reader.table("surfaces");
  if (!reader.ok()) return reader.finish().error();
  if (curves != nullptr) {
    for (const Node::Member& member : curves->members) {
      if (auto ok = check_member(member, "curve", source_name, names); !ok) return ok.error();
      auto curve =
          member.value.find("curve_file") == nullptr
              ? read_curve(member.value, member.key, source_name)
              : read_reference(member.value, member.key, source_name, "curve '" + member.key + "'",
                               lookup, &CurveSet::find_curve);
      if (!curve) return curve.error();
      set.curves.push_back(std::move(*curve));
    }
  }
  if (surfaces != nullptr) {
    for (const Node::Member& member : surfaces->members) {
      if (auto ok = check_member(member, "surface", source_name, names); !ok) return ok.error();
      auto surface =
          member.value.find("curve_file") == nullptr
              ? read_surface(member.value, member.key, source_name)
              : read_reference(member.value, member.key, source_name,
                               "surface '" + member.key + "'", lookup, &CurveSet::find_surface);
      if (!surface) return surface.error();
      set.surfaces.push_back(std::move(*surface));
    }
  }
  return set;
}

}  // namespace knotwave::curves
