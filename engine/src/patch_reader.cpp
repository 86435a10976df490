// SPDX-License-Identifier: MIT
// A patch of sound: its own keys and its tuning.
#include "patch_reader.h"

namespace knotwave::engine {

Result<PatchSpec> read_patch(const base::Node& root, const std::string& source_name,
                             FileShelf& shelf) {
  return PatchReader(root, source_name, shelf).read();
}

Result<PatchSpec> PatchReader::read() {
  using Section = void (PatchReader::*)();
  // Top first, so that a misspelt section is named before what misses it; maps name all others.
  constexpr Section kSections[] = {&PatchReader::read_top,       &PatchReader::read_envelopes,
                                   &PatchReader::require_amp,    &PatchReader::read_oscillators,
                                   &PatchReader::read_noise,     &PatchReader::read_lfos,
                                   &PatchReader::read_crossfade, &PatchReader::read_shaper,
                                   &PatchReader::read_filter,    &PatchReader::read_maps};
  for (const Section section : kSections) {
    if (ok()) (this->*section)();
  }
  if (error_) return *error_;
  return std::move(patch_);
}

void PatchReader::read_top() {
  TableReader top(root_, source_, "patch");
  for (const char* section : {"oscillators", "noise", "crossfade", "shaper", "filter"}) {
    top.node(section);
  }
  read_common(top);
  patch_.gain_db = top.number("gain_db", patch_.gain_db, -96, 24);
  patch_.pan = top.number("pan", patch_.pan, 0, 1);
  patch_.polyphony = top.integer("polyphony", patch_.polyphony, 1, 128);
  patch_.glide_s = top.number("glide_s", patch_.glide_s, 0, 60);
  patch_.bend_semitones = top.number("bend_semitones", patch_.bend_semitones, 0, 96);
  patch_.velocity_db = top.number("velocity_db", patch_.velocity_db, 0, 96);
  const Node* glide = top.node("glide_curve");
  read_tuning(top);
  keep(top.finish());
  if (!ok()) return;
  read_curves();
  if (!ok() || glide == nullptr) return;
  TableReader again(root_, source_, "patch");
  patch_.glide_curve = curve_name(again, "glide_curve", Role::function);
  if (!again.ok()) keep(again.finish());
}

void PatchReader::read_tuning(TableReader& top) {
  std::string texts[2];
  std::string* paths[2] = {&patch_.tuning_file, &patch_.keymap_file};
  const char* keys[2] = {"tuning", "keymap"};
  for (int i = 0; i < 2; ++i) {
    const Node* at = top.node(keys[i]);
    const std::string name = top.string(keys[i], "");
    if (at == nullptr || !top.ok()) continue;
    *paths[i] = FileShelf::beside(source_, name);
    auto text = shelf_.read(*paths[i]);
    if (!text) return top.fail_at(*at, text.error().code, text.error().message);
    // A file that was asked for and is empty is a fault, not a default.
    texts[i] = text->empty() ? "\n" : std::move(*text);
  }
  if (!top.ok()) return;
  auto tuning = Tuning::create(texts[0], patch_.tuning_file, texts[1], patch_.keymap_file);
  if (!tuning) return keep(tuning.error());
  patch_.tuning = *tuning;
}

}  // namespace knotwave::engine
