// SPDX-License-Identifier: MIT
// Curve files as dictionaries.
#include <filesystem>

#include <pybind11/stl/filesystem.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using curves::CurveSet;

py::dict dict_of(CurveSet&& set) {
  py::dict made;
  for (auto& curve : set.curves) {
    const py::str name(curve.name());
    made[name] = std::move(curve);
  }
  for (auto& surface : set.surfaces) {
    const py::str name(surface.name());
    made[name] = std::move(surface);
  }
  return made;
}

void check_name(const CurveSet& set, const std::string& name) {
  if (!curves::is_valid_name(name)) {
    throw Fault{fail(ErrorCode::malformed,
                     "'" + name + "': a name is 1 to 64 letters, digits, '_' and '-'")};
  }
  for (const std::string_view other : set.names()) {
    if (other == name) {
      throw Fault{fail(ErrorCode::duplicate_name, "two curves are called '" + name + "'")};
    }
  }
}

std::string text_of(const py::iterable& items) {
  CurveSet set;
  for (const py::handle item : items) {
    if (py::isinstance<curves::NurbsSurface>(item)) {
      const auto& surface = item.cast<const curves::NurbsSurface&>();
      check_name(set, surface.name());
      set.surfaces.push_back(surface);
    } else if (py::isinstance<curves::NurbsCurve>(item)) {
      const auto& curve = item.cast<const curves::NurbsCurve&>();
      check_name(set, curve.name());
      set.curves.push_back(curve);
    } else {
      throw py::type_error("a curve file holds curves and surfaces, no " +
                           std::string(py::str(py::type::of(item).attr("__name__"))));
    }
  }
  return curves::write_curves(set);
}

}  // namespace

void add_files(py::module_& module) {
  module
      .def(
          "parse_curves",
          [](std::string_view text, std::string_view source_name) {
            return dict_of(take(curves::parse_curves(text, source_name)));
          },
          py::arg("text"), py::arg("source_name") = "",
          "The curves and surfaces of a TOML text, by name. source_name is what errors begin with.")
      .def(
          "read_curves",
          [](const std::filesystem::path& path) {
            return dict_of(take(curves::read_curves(path.string())));
          },
          py::arg("path"), "The curves and surfaces of a file, by name.")
      .def("curves_text", &text_of, py::arg("items"),
           "The text of a curve file that reads back to equal curves and surfaces. Each needs a\n"
           "name of its own.")
      .def(
          "write_curves",
          [](const std::filesystem::path& path, const py::iterable& items) {
            const auto written = base::write_file(path.string(), text_of(items));
            if (!written) throw Fault{written.error()};
          },
          py::arg("path"), py::arg("items"),
          "Writes that file; an old one is kept until the new one is complete.");
}

}  // namespace knotwave::python
