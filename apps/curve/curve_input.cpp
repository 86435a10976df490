// SPDX-License-Identifier: MIT
#include "curve_input.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "knotwave/base/file.h"
#include "knotwave/base/suggest.h"
#include "knotwave/engine/bank.h"
#include "knotwave/engine/envelope_patch.h"

namespace knotwave::curve_app {

Result<KnownFile> read_known_file(const std::string& path) {
  auto text = base::read_file(path, base::kMaxDocumentBytes);
  if (!text) return text.error();
  const auto root = base::parse_document(*text, path);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, path);
  if (!kind) return kind.error();
  if (*kind == curves::FileKind::plugin) {
    Error error = fail(ErrorCode::unsupported,
                       "this is the state of a plugin, which only the plugin itself can read");
    error.source = path;
    return error;
  }
  return KnownFile{std::move(*text), *kind};
}

Result<curves::CurveSet> read_set(const std::string& path) {
  const auto file = read_known_file(path);
  if (!file) return file.error();
  if (file->kind == curves::FileKind::curve) return curves::parse_curves(file->text, path);
  if (file->kind == curves::FileKind::bank) {
    Error error = fail(ErrorCode::unsupported, "a bank holds no curves; its patches do");
    error.source = path;
    return error;
  }
  const bool is_calibration = file->kind == curves::FileKind::calibration;
  if (is_calibration || file->kind == curves::FileKind::midi_learn) {
    Error error = fail(
        ErrorCode::unsupported,
        std::string(is_calibration ? "a calibration" : "a MIDI learn file") + " holds no curves");
    error.source = path;
    return error;
  }
  if (file->kind == curves::FileKind::envelope) {
    auto patch = engine::read_envelope_patch(path);
    if (!patch) return patch.error();
    return std::move(patch->patch.curves);
  }
  auto bank = engine::read_bank(path);
  if (!bank) return bank.error();
  return std::move(bank->patches.front().curves);
}

Reference reference_of(const std::string& text) {
  const auto hash = text.rfind('#');
  std::error_code failed;
  if (hash == std::string::npos || std::filesystem::is_regular_file(text, failed))
    return {text, ""};
  return {text.substr(0, hash), text.substr(hash + 1)};
}

Result<Item> read_item(const std::string& text) {
  const Reference reference = reference_of(text);
  auto set = read_set(reference.path);
  if (!set) return set.error();
  Error error;
  error.source = reference.path;
  std::string names;
  for (const auto name : set->names()) names += (names.empty() ? "" : ", ") + std::string(name);
  if (reference.name.empty()) {
    if (set->curves.size() == 1 && set->surfaces.empty()) return Item(set->curves.front());
    if (set->surfaces.size() == 1 && set->curves.empty()) return Item(set->surfaces.front());
    error.code = names.empty() ? ErrorCode::unknown_name : ErrorCode::usage;
    error.message = names.empty() ? "there is no curve in this file"
                                  : "which one? add #NAME; there are " + names;
    return error;
  }
  if (const auto* curve = set->find_curve(reference.name)) return Item(*curve);
  if (const auto* surface = set->find_surface(reference.name)) return Item(*surface);
  error.code = ErrorCode::unknown_name;
  const std::string near = base::suggestion(reference.name, set->names());
  error.message =
      "there is no '" + reference.name + "'" + (near.empty() ? "; there are " + names : near);
  return error;
}

}  // namespace knotwave::curve_app
