// SPDX-License-Identifier: MIT
// Curve files: TOML in, TOML out. docs/curve-format.md is the format; design limits: 1 MiB, depth
// 32, 4096 points, degree 1..15. [control]
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/document.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::curves {

/// The curves and surfaces of one file, in the order of the file.
struct CurveSet {
  std::vector<NurbsCurve> curves;
  std::vector<NurbsSurface> surfaces;

  const NurbsCurve* find_curve(std::string_view name) const;
  const NurbsSurface* find_surface(std::string_view name) const;
  /// Every name, for suggestions.
  std::vector<std::string_view> names() const;
};

/// Text to curves. `source_name` is what errors begin with. Unknown keys are errors that suggest
/// the nearest known one; a curve's own faults carry the line and column of the number at fault.
Result<CurveSet> parse_curves(std::string_view text, std::string_view source_name);

/// Finds the curves of another file for a table that says `curve_file = "PATH#NAME"`; the argument
/// is PATH as written. An error without a source gets the place of the reference.
using CurveFileLookup = std::function<Result<const CurveSet*>(const std::string& path)>;

/// The [curves.*] and [surfaces.*] tables of a document that holds more than curves (a patch).
/// `root` is the document's root; other keys are left to the caller. Without a `lookup`, curve_file
/// is an error (unsupported).
Result<CurveSet> read_curve_tables(const base::Node& root, std::string_view source_name,
                                   const CurveFileLookup& lookup = {});

/// Whether a curve, an oscillator or the like may be called so: 1 to 64 letters (A-Z, a-z), digits,
/// '_' and '-', the bare keys of TOML.
bool is_valid_name(std::string_view name);

/// The version and the kind a file of ours states (`format = 1`, `kind = "curve"`).
enum class FileKind { curve, patch, bank, envelope, midi_learn, plugin, calibration };
/// Reads the two from a document's root. Errors: missing_key, wrong_type, unsupported_version,
/// unknown_name.
Result<FileKind> read_file_kind(const base::Node& root, std::string_view source_name);

/// Reads a file and parses it. Errors: file_not_found, file_too_large, io_failed and the above.
Result<CurveSet> read_curves(const std::string& path);

/// Text that parse_curves reads to equal curves; 17 significant digits, shortest form.
std::string write_curves(const CurveSet& set);
/// Its tables alone, for documents that hold more than curves.
std::string write_curve_tables(const CurveSet& set);

}  // namespace knotwave::curves
