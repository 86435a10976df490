// SPDX-License-Identifier: MIT
#include <cstdio>

#include "knotwave/engine/envelope_patch_program.h"
#include "knotwave/engine/midi_learn.h"
#include "knotwave/engine/voltage_output.h"

#include "bank_input/bank_input.h"
#include "bank_input/patch_warnings.h"
#include "curve_input.h"
#include "verbs.h"

namespace knotwave::curve_app {
namespace {

std::string count_of(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

std::string count_of(const curves::CurveSet& set) {
  return count_of(set.curves.size(), "curve") + ", " + count_of(set.surfaces.size(), "surface");
}

Result<std::string> checked_envelope_patch(const std::string& path) {
  const auto spec = engine::read_envelope_patch(path);
  if (!spec) return spec.error();
  const auto program = engine::EnvelopePatchProgram::create(*spec);
  if (!program) return program.error();
  for (const auto& warning : bank_input::patch_warnings(*spec)) {
    std::fprintf(stderr, "%s\n", warning.c_str());
  }
  return "envelope patch, " + count_of(spec->patch.curves) + ", " +
         count_of(spec->patch.maps.size(), "map") + ", " + count_of(spec->outputs.size(), "output");
}

/// What a file holds; warnings go to standard error.
Result<std::string> checked(const std::string& path) {
  const auto file = read_known_file(path);
  if (!file) return file.error();
  if (file->kind == curves::FileKind::curve) {
    const auto set = curves::parse_curves(file->text, path);
    if (!set) return set.error();
    return "curve file, " + count_of(*set);
  }
  if (file->kind == curves::FileKind::midi_learn) {
    const auto learnt = engine::parse_midi_learn(file->text, path);
    if (!learnt) return learnt.error();
    return "MIDI learn file, " + count_of(learnt->knobs.size(), "knob");
  }
  if (file->kind == curves::FileKind::calibration) {
    const auto channels = engine::parse_calibration(file->text, path);
    if (!channels) return channels.error();
    return "calibration, " + count_of(channels->size(), "channel");
  }
  if (file->kind == curves::FileKind::envelope) return checked_envelope_patch(path);
  // Compiled as for playing: what is ok here can be rendered.
  const auto bank = bank_input::read(path);
  if (!bank) return bank.error();
  for (const auto& warning : bank->warnings) std::fprintf(stderr, "%s\n", warning.c_str());
  const engine::BankSpec& spec = bank->spec;
  if (file->kind == curves::FileKind::bank) {
    return "bank, " + std::to_string(spec.patches.size()) + " patches, " +
           std::to_string(spec.entries.size()) + " entries";
  }
  const engine::PatchSpec& patch = spec.patches.front();
  return "patch, " + count_of(patch.curves) + ", " + count_of(patch.maps.size(), "map");
}

}  // namespace

std::string check_text(const CurveOptions& options, bool& failed) {
  std::string text;
  for (const std::string& path : options.files) {
    const auto what = checked(path);
    if (what) {
      text += path + ": ok: " + *what + "\n";
      continue;
    }
    failed = true;
    Error error = what.error();
    if (error.source.empty()) error.source = path;
    const std::string name = reference_of(path).name;
    if (error.code == ErrorCode::file_not_found && !name.empty()) {
      error.message = "no such file; check reads whole files: leave out '#" + name + "'";
    }
    std::fprintf(stderr, "%s\n", error.to_string().c_str());
  }
  return text;
}

}  // namespace knotwave::curve_app
