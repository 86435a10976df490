// SPDX-License-Identifier: MIT
// A bank compiled: what the engine plays. Immutable, pointer-stable, freed on the control thread.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/bank.h"

namespace knotwave::engine {

class PatchProgram;  // patch_program.h

/// Sampled cycles of a wave_file, read by the caller (the engine knows no files of sound).
struct WaveCycles {
  std::string file;
  int frame = 0;
  int rows = 0;
  std::vector<float> samples;
};

class BankProgram {
 public:
  /// Compiles every patch. [control] `cycles` must hold every wave_file of the spec. Errors: what
  /// the parts say, with the patch's file and name in front.
  static Result<std::unique_ptr<const BankProgram>> create(const BankSpec& spec,
                                                           std::span<const WaveCycles> cycles = {});
  ~BankProgram();
  BankProgram(const BankProgram&) = delete;
  BankProgram& operator=(const BankProgram&) = delete;

  /// What one note is played by.
  struct Choice {
    const PatchProgram* patch = nullptr;  ///< null: nothing plays
    double note = 60;
    double gain_lin = 1;
    int choke_group = 0;
    bool drum = false;
  };
  /// [audio] channel 0..15. The entry for this very bank, else the one that names no bank; a
  /// program or drum key without either plays nothing.
  Choice choose(int channel, int bank_msb, int bank_lsb, int program, int key) const KNOTWAVE_RT;

  double gain_lin() const KNOTWAVE_RT { return gain_lin_; }
  std::span<const std::unique_ptr<const PatchProgram>> patches() const { return patches_; }
  /// Lines worth telling: measured errors, tables, memory.
  const std::vector<std::string>& report() const { return report_; }

 private:
  BankProgram();
  std::vector<std::unique_ptr<const PatchProgram>> patches_;
  std::vector<BankEntry> entries_;
  std::vector<int> entry_patch_;
  std::vector<double> entry_gain_;
  int drum_channel_ = 9;    ///< from 0; -1 = none
  bool has_drums_ = false;  ///< some entry has a key
  double gain_lin_ = 1;
  std::vector<std::string> report_;
};

}  // namespace knotwave::engine
