// SPDX-License-Identifier: MIT
// Patches and banks from text and files.
#include "knotwave/base/file.h"
#include "knotwave/engine/bank.h"

#include "bank_reader.h"
#include "envelope_patch_reader.h"
#include "patch_reader.h"

namespace knotwave::engine {
namespace {

Error wrong_kind(const base::Node& root, const std::string& source, curves::FileKind kind,
                 const std::string& needed) {
  Error error = kind == curves::FileKind::envelope
                    ? fail(ErrorCode::unsupported,
                           "this is a patch of the envelope generator (kind = \"envelope\"), which "
                           "makes no sound: knotwave-env plays it")
                    : fail(ErrorCode::unsupported,
                           "this file's kind is '" + root.find("kind")->text + "'; " + needed);
  error.source = source;
  error.line = root.find("kind")->line;
  error.column = root.find("kind")->column;
  return error;
}

}  // namespace

Result<PatchSpec> parse_patch_text(std::string_view text, const std::string& source,
                                   FileShelf& shelf) {
  const auto root = base::parse_document(text, source);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, source);
  if (!kind) return kind.error();
  if (*kind != curves::FileKind::patch) {
    return wrong_kind(*root, source, *kind, "a patch (kind = \"patch\") is needed here");
  }
  return read_patch(*root, source, shelf);
}

Result<PatchSpec> parse_patch(std::string_view text, std::string_view source_name) {
  FileShelf shelf;
  const std::string source(source_name);
  const FileShelf::Link link(shelf, source);
  return parse_patch_text(text, source, shelf);
}

BankSpec bank_of(PatchSpec patch) {
  BankSpec bank;
  bank.name = patch.name;
  bank.source_name = patch.source_name;
  bank.drum_channel = 0;
  bank.entries.emplace_back();
  bank.entries.back().patch_file = patch.source_name;
  bank.entry_patch.push_back(0);
  bank.patches.push_back(std::move(patch));
  return bank;
}

namespace {

Result<BankSpec> read_bank_file(const std::string& path, FileShelf& shelf) {
  const FileShelf::Link link(shelf, path);
  const auto text = shelf.read_first(path);
  if (!text) return text.error();
  const auto root = base::parse_document(*text, path);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, path);
  if (!kind) return kind.error();
  if (*kind == curves::FileKind::bank) return BankReader(*root, path, shelf).read();
  if (*kind != curves::FileKind::patch) {
    return wrong_kind(*root, path, *kind, "a patch or a bank is needed here");
  }
  auto patch = read_patch(*root, path, shelf);
  if (!patch) return patch.error();
  return bank_of(std::move(*patch));
}

Result<BankSpec> read_bank_from(const std::string& path, FileShelf shelf) {
  auto bank = read_bank_file(path, shelf);
  if (!bank) return bank;
  bank->files = shelf.paths();
  bank->texts = std::move(shelf.texts());
  return bank;
}

}  // namespace

Result<BankSpec> read_bank(const std::string& path) { return read_bank_from(path, FileShelf()); }

Result<BankSpec> read_bank(const std::string& path, std::span<const FileText> texts) {
  return read_bank_from(path, FileShelf(texts));
}

namespace {

Result<EnvelopePatchSpec> parse_envelope_text(std::string_view text, const std::string& source,
                                              FileShelf& shelf) {
  const auto root = base::parse_document(text, source);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, source);
  if (!kind) return kind.error();
  if (*kind == curves::FileKind::envelope) {
    return EnvelopePatchReader(*root, source, shelf).read();
  }
  const bool has_sound = *kind == curves::FileKind::patch || *kind == curves::FileKind::bank;
  return wrong_kind(*root, source, *kind,
                    std::string("a patch of the envelope generator (kind = \"envelope\") is "
                                "needed here") +
                        (has_sound ? "; knotwave-synth and knotwave-render play this one" : ""));
}

}  // namespace

Result<EnvelopePatchSpec> parse_envelope_patch(std::string_view text,
                                               std::string_view source_name) {
  FileShelf shelf;
  const std::string source(source_name);
  const FileShelf::Link link(shelf, source);
  return parse_envelope_text(text, source, shelf);
}

namespace {

Result<EnvelopePatchSpec> read_envelope_patch_from(const std::string& path, FileShelf shelf) {
  const FileShelf::Link link(shelf, path);
  const auto text = shelf.read_first(path);
  if (!text) return text.error();
  auto spec = parse_envelope_text(*text, path, shelf);
  if (spec) spec->texts = std::move(shelf.texts());
  return spec;
}

}  // namespace

Result<EnvelopePatchSpec> read_envelope_patch(const std::string& path) {
  return read_envelope_patch_from(path, FileShelf());
}

Result<EnvelopePatchSpec> read_envelope_patch(const std::string& path,
                                              std::span<const FileText> texts) {
  return read_envelope_patch_from(path, FileShelf(texts));
}

}  // namespace knotwave::engine
