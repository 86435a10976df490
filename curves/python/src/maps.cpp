// SPDX-License-Identifier: MIT
// knotwave.MapSet: one coordinate drives many targets; and curves as few straight steps.
#include <array>

#include "knotwave/curves/map.h"
#include "knotwave/curves/tessellate.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using curves::Map1;
using curves::Map2;
using curves::MapKey;
using curves::MapSet;
using curves::MapValues;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::Target;

using Range = std::pair<double, double>;

std::array<std::string_view, curves::kTargetCount> target_names() {
  std::array<std::string_view, curves::kTargetCount> names;
  for (std::size_t t = 0; t < names.size(); ++t) names[t] = to_string(static_cast<Target>(t));
  return names;
}

Target target_of(std::string_view word) {
  return static_cast<Target>(choice("the target", word, target_names()));
}

std::string text_of(const MapKey& key) {
  return std::string("MapKey('") + to_string(key.target) +
         "', parameters=" + std::to_string(key.parameters) +
         ", width=" + std::to_string(key.width) + (key.rational ? ", rational=True)" : ")");
}

/// A number, or an array of more.
py::object numbers_of(const MapValues& values, Target target) {
  const auto all = values.of(target);
  if (all.size() == 1) return py::float_(all[0]);
  return new_array(all, {static_cast<py::ssize_t>(all.size())});
}

/// work(target) for each that was evaluated, under its name.
template <class Work>
py::dict evaluated(const MapValues& values, Work work) {
  py::dict made;
  for (int t = 0; t < curves::kTargetCount; ++t) {
    const auto target = static_cast<Target>(t);
    if (values.is_evaluated(target)) made[to_string(target)] = work(target);
  }
  return made;
}

py::dict evaluate(const MapSet& maps, double u, std::optional<double> v) {
  MapValues values;
  if (v) {
    maps.evaluate(u, *v, values);
  } else {
    maps.evaluate(u, values);
  }
  return evaluated(values, [&](Target target) { return numbers_of(values, target); });
}

py::dict slopes(const MapSet& maps, double u, std::optional<double> v) {
  MapValues by_u, by_v;
  if (!v) {
    maps.evaluate_slopes(u, by_u);
    return evaluated(by_u, [&](Target target) { return numbers_of(by_u, target); });
  }
  maps.evaluate_slopes(u, *v, by_u, by_v);
  return evaluated(by_u, [&](Target target) {
    return py::make_tuple(numbers_of(by_u, target), numbers_of(by_v, target));
  });
}

/// Errors: value_out_of_range.
void check_within(const char* name, std::int64_t value, std::int64_t least) {
  constexpr std::int64_t kMost = std::int64_t{1} << 53;  // beyond, doubles skip whole numbers
  if (value >= least && value <= kMost) return;
  throw Fault{fail(ErrorCode::value_out_of_range, std::string(name) + " = " +
                                                      std::to_string(value) + " is not within " +
                                                      std::to_string(least) + "..2^53")};
}

py::array_t<double> grid(const MapSet& maps, std::string_view target, std::int64_t n, Range u,
                         std::int64_t first, std::optional<std::int64_t> count, int coordinate) {
  check_within("n", n, 1);
  check_within("first", first, 0);
  const std::int64_t nodes = count.value_or(n + 1 - first);
  check_within("count", nodes, 0);
  py::array_t<double> out(static_cast<py::ssize_t>(nodes));
  const MapSet::Channel channel{target_of(target), coordinate, numbers(out)};
  maps.evaluate_grid({u.first, u.second, n}, first, {&channel, 1});
  return out;
}

py::array_t<double> mesh(const MapSet& maps, std::string_view target, std::int64_t n_u,
                         std::int64_t n_v, Range u, Range v, int coordinate) {
  check_within("n_u", n_u, 1);
  check_within("n_v", n_v, 1);
  py::array_t<double> out(Shape{n_v + 1, n_u + 1});
  const MapSet::Channel channel{target_of(target), coordinate, numbers(out)};
  maps.evaluate_mesh({u.first, u.second, n_u}, 0, n_u + 1, {v.first, v.second, n_v}, 0,
                     {&channel, 1});
  return out;
}

py::object defined(const MapSet& maps, const MapKey& key) {
  if (const Map1* map = maps.map1(key); map != nullptr && key.parameters == 1) {
    return py::make_tuple(map->curve, Range{map->u1, map->u2});
  }
  if (const Map2* map = maps.map2(key); map != nullptr && key.parameters == 2) {
    return py::make_tuple(map->surface, Range{map->u1, map->u2}, Range{map->v1, map->v2});
  }
  return py::none();
}

void add_key(py::module_& module) {
  py::class_<MapKey>(module, "MapKey", "A map's place in a set: one map each.")
      .def(py::init([](std::string_view target, int parameters, int width, bool rational) {
             return MapKey{target_of(target), parameters, width, rational};
           }),
           py::arg("target"), py::arg("parameters") = 1, py::arg("width") = 1,
           py::arg("rational") = false,
           "parameters: 1 = curve, 2 = surface. width: coordinates. rational: weights differ.")
      .def_property_readonly("target", [](const MapKey& key) { return to_string(key.target); })
      .def_readonly("parameters", &MapKey::parameters)
      .def_readonly("width", &MapKey::width)
      .def_readonly("rational", &MapKey::rational)
      .def(
          "__eq__", [](const MapKey& a, const MapKey& b) { return a == b; }, py::is_operator())
      .def("__repr__", &text_of);
}

void add_definitions(py::class_<MapSet>& maps) {
  maps.def(
          "define",
          [](MapSet& self, std::string_view target, const NurbsCurve& curve, Range u,
             double max_error) {
            return take(self.define(Map1{target_of(target), u.first, u.second, curve, max_error}));
          },
          py::arg("target"), py::arg("curve"), py::arg("u") = Range{0, 1},
          py::arg("max_error") = 1e-7,
          "Binds a curve to a target over (u1, u2), in place of the map with the same key, and\n"
          "disabled. Gives the key.")
      .def(
          "define",
          [](MapSet& self, std::string_view target, const NurbsSurface& surface, Range u, Range v) {
            return take(self.define(
                Map2{target_of(target), u.first, u.second, v.first, v.second, surface}));
          },
          py::arg("target"), py::arg("surface"), py::arg("u") = Range{0, 1},
          py::arg("v") = Range{0, 1}, "The same for a surface over (u1, u2) and (v1, v2).")
      .def("defined", &defined, py::arg("key"),
           "What was defined: (curve, (u1, u2)) or (surface, (u1, u2), (v1, v2)); None without.")
      .def("enable", &MapSet::enable, py::arg("key"), py::arg("on") = true,
           "False, and no effect, for a map that was never defined. Of one target the widest\n"
           "enabled map counts, and of two of that width the rational one.")
      .def("is_enabled", &MapSet::is_enabled, py::arg("key"), "Whether there is one and it is on.")
      .def(
          "set_current",
          [](MapSet& self, std::string_view target, const Array& value) {
            self.set_current(target_of(target), row("value", value));
          },
          py::arg("target"), py::arg("value"),
          "The value a target has where no map drives it: a number, or up to 4.")
      .def(
          "current",
          [](const MapSet& self, std::string_view target) {
            const auto value = self.current(target_of(target));
            return new_array(value, {static_cast<py::ssize_t>(value.size())});
          },
          py::arg("target"), "That value: as many numbers as the target's widest map.");
}

void add_evaluation(py::class_<MapSet>& maps) {
  maps.def("evaluate", &evaluate, py::arg("u"), py::arg("v") = py::none(),
           "All enabled maps of curves at u, or of surfaces at (u, v): a dict from target to a\n"
           "number, or to an array [width]. Targets without such a map are not in it.")
      .def("slopes", &slopes, py::arg("u"), py::arg("v") = py::none(),
           "Derivatives by u instead of values; with v pairs, by u and by v.")
      .def(
          "grid", &grid, py::arg("target"), py::arg("n"), py::arg("u") = Range{0, 1},
          py::arg("first") = 0, py::arg("count") = py::none(), py::arg("coordinate") = 0,
          "A target at nodes first, first + 1, ... of n steps from u1 to u2; node n is exactly "
          "u2.\n"
          "count: all up to node n if left out. Any split gives the same bits. Without an enabled\n"
          "map the current value.")
      .def("mesh", &mesh, py::arg("target"), py::arg("n_u"), py::arg("n_v"),
           py::arg("u") = Range{0, 1}, py::arg("v") = Range{0, 1}, py::arg("coordinate") = 0,
           "A target of surfaces at all nodes of n_u by n_v steps: [n_v + 1, n_u + 1], rows of u.");
}

curves::Sampling policy_of(std::optional<double> steps_per_u, std::optional<double> error_db,
                           double full_scale, std::optional<double> max_step) {
  if (int(steps_per_u.has_value()) + int(error_db.has_value()) + int(max_step.has_value()) != 1) {
    throw Fault{fail(ErrorCode::usage, "give one of steps_per_u, error_db and max_step")};
  }
  if (steps_per_u) return curves::FixedStep{*steps_per_u};
  if (error_db) return curves::MaxError{*error_db, full_scale};
  return curves::MaxStep{*max_step};
}

/// A stretch that is being called back.
struct Rows {
  std::vector<double> u, values, slopes;
};

py::list tessellated(const NurbsCurve& curve, std::optional<double> steps_per_u,
                     std::optional<double> error_db, double full_scale,
                     std::optional<double> max_step, int max_values) {
  const auto policy = policy_of(steps_per_u, error_db, full_scale, max_step);
  std::vector<Rows> stretches;
  curves::TessellatorCalls calls;
  calls.begin = [&](double) { stretches.emplace_back(); };
  calls.value = [&](double u, std::span<const double> value) {
    stretches.back().u.push_back(u);
    stretches.back().values.insert(stretches.back().values.end(), value.begin(), value.end());
  };
  calls.slope = [&](double, std::span<const double> slope) {
    stretches.back().slopes.insert(stretches.back().slopes.end(), slope.begin(), slope.end());
  };
  const auto done = [&] {
    const py::gil_scoped_release others_go_on;
    return tessellate(curve, policy, calls, max_values);
  }();
  if (!done) throw Fault{done.error()};
  py::list made;
  for (const Rows& rows : stretches) {
    const Shape shape = {static_cast<py::ssize_t>(rows.u.size())};
    made.append(py::make_tuple(new_array(rows.u, shape),
                               new_array(rows.values, with_dim(shape, curve.dim())),
                               new_array(rows.slopes, with_dim(shape, curve.dim()))));
  }
  return made;
}

}  // namespace

void add_maps(py::module_& module) {
  add_key(module);
  py::class_<MapSet> maps(
      module, "MapSet",
      "Maps from one or two coordinates to targets ('amp', 'pitch', ...), which of them are\n"
      "enabled, and the current values. docs/from-opengl.md tells where it comes from.");
  maps.def(py::init<>());
  add_definitions(maps);
  add_evaluation(maps);
  module.def(
      "tessellate", &tessellated, py::arg("curve"), py::arg("steps_per_u") = py::none(),
      py::arg("error_db") = py::none(), py::arg("full_scale") = 1.0,
      py::arg("max_step") = py::none(), py::arg("max_values") = 1 << 20,
      "A curve as few straight steps, by one of three policies: at least steps_per_u equal\n"
      "steps for each unit of u; no farther from the curve than error_db re full_scale; no\n"
      "coordinate moves by more than max_step within a step. The last two are proved. A list\n"
      "of stretches between jumps: (u [n], values [n] or [n, dim], slopes like values).");
}

}  // namespace knotwave::python
