// SPDX-License-Identifier: MIT
// FILE[#name] to a curve or surface.
#pragma once
#include <string>
#include <variant>

#include "knotwave/curves/curve_file.h"

namespace knotwave::curve_app {

/// A file as text, with what it says it is.
struct KnownFile {
  std::string text;
  curves::FileKind kind;
};
/// Errors: those of the file and of TOML; what read_file_kind() says.
Result<KnownFile> read_known_file(const std::string& path);

/// Every curve and surface of a curve file or a patch. Errors: those of the file; unsupported for
/// files that hold none (banks, envelope patches).
Result<curves::CurveSet> read_set(const std::string& path);

/// "file.toml#name" as its two halves; no name without a '#', or where a file is called so in
/// whole.
struct Reference {
  std::string path;
  std::string name;
};
Reference reference_of(const std::string& text);

using Item = std::variant<curves::NurbsCurve, curves::NurbsSurface>;
/// The one meant. Errors: as above; unknown_name with the nearest name; usage when the file holds
/// several and none is named.
Result<Item> read_item(const std::string& text);

}  // namespace knotwave::curve_app
