// SPDX-License-Identifier: MIT
#include "bank_input/bank_input.h"

#include <algorithm>
#include <utility>

#include "knotwave/io/sound_file.h"

#include "bank_input/patch_warnings.h"

namespace knotwave::bank_input {
namespace {

std::string warning_text(const std::string& file, const std::string& what) {
  return file + ": warning: " + what;
}

Error placed(Error error, const engine::PatchSpec& patch, const std::string& path) {
  const engine::Place place = patch.place_of(path);
  error.source = patch.source_name;
  error.line = place.line;
  error.column = place.column;
  return error;
}

/// The engine knows cycles by their file, so a file is cut in one way only.
Error two_frames(const engine::PatchSpec& patch, const std::string& oscillator,
                 const engine::WaveCycles& known, int frame) {
  Error error = fail(ErrorCode::value_out_of_range,
                     "'" + known.file + "' is cut into cycles of " + std::to_string(known.frame) +
                         " frames elsewhere, and of " + std::to_string(frame) +
                         " here (wave_frame): use a copy of the file");
  return placed(std::move(error), patch, "oscillators." + oscillator + ".wave_frame");
}

/// A fault of the sound file itself, told where the patch names it.
Error bad_cycles(const engine::PatchSpec& patch, const std::string& oscillator,
                 const Error& fault) {
  Error error = fail(fault.code, "oscillator '" + oscillator + "': " + fault.to_string());
  return placed(std::move(error), patch, "oscillators." + oscillator + ".wave_file");
}

/// The cycles of every sound file the patches name, each read once.
Result<std::vector<engine::WaveCycles>> read_waves(const engine::BankSpec& spec,
                                                   std::vector<std::string>& warnings) {
  std::vector<engine::WaveCycles> waves;
  for (const engine::PatchSpec& patch : spec.patches) {
    for (const engine::OscillatorSpec& oscillator : patch.oscillators) {
      const std::string& file = oscillator.wave_file;
      const int frame = oscillator.wave_frame;
      if (file.empty()) continue;
      const auto known = std::find_if(waves.begin(), waves.end(),
                                      [&](const auto& wave) { return wave.file == file; });
      if (known != waves.end()) {
        if (frame > 0 && frame != known->frame)
          return two_frames(patch, oscillator.name, *known, frame);
        continue;
      }
      auto cycles = io::read_cycles(file, frame);
      if (!cycles) return bad_cycles(patch, oscillator.name, cycles.error());
      for (const auto& warning : cycles->warnings) {
        warnings.push_back(warning_text(file, warning));
      }
      waves.push_back({file, cycles->frame, cycles->rows, std::move(cycles->samples)});
    }
  }
  return waves;
}

Result<BankInput> compiled(Result<engine::BankSpec> spec) {
  BankInput input;
  if (!spec) return std::move(spec).error();
  for (const engine::PatchSpec& patch : spec->patches) {
    for (auto& warning : patch_warnings(patch)) input.warnings.push_back(std::move(warning));
  }
  auto waves = read_waves(*spec, input.warnings);
  if (!waves) return waves.error();
  for (const engine::WaveCycles& wave : *waves) input.sounds.push_back(wave.file);
  auto program = engine::BankProgram::create(*spec, *waves);
  if (!program) return std::move(program).error();
  input.spec = *std::move(spec);
  input.waves = *std::move(waves);
  input.program = *std::move(program);
  return input;
}

}  // namespace

Result<BankInput> read(const std::string& path) { return compiled(engine::read_bank(path)); }

Result<BankInput> read(const std::string& path, std::span<const engine::FileText> texts) {
  return compiled(engine::read_bank(path, texts));
}

}  // namespace knotwave::bank_input
