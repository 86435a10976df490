// SPDX-License-Identifier: MIT
// The steps from a PatchSpec to a PatchProgram. [control]
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

class PatchCompiler {
 public:
  PatchCompiler(const PatchSpec& spec, std::span<const WaveCycles> cycles)
      : spec_(spec), cycles_(cycles) {}
  /// In this order: moved numbers first, because every curve is compiled with its own.
  Result<std::unique_ptr<const PatchProgram>> compile();

 private:
  /// What a message is about: what people call it, and where it is written (as Places has it).
  struct Part {
    std::string name;
    std::string path;
  };
  /// A number of a curve that a map moves.
  struct MovedNumber {
    std::string curve;
    curves::ControlRange range;
    int map = 0;
  };
  /// Where a compiled map comes from.
  struct MapOrigin {
    int number = 0;  ///< in spec_.maps
    bool is_rational = false;
  };

  Result<void> check_counts();
  Result<void> collect_moved_numbers();
  Result<void> compile_oscillators();
  Result<void> compile_wave(const OscillatorSpec& oscillator, PatchProgram::Source& source);
  Result<dsp::WaveTables> wave_of(const std::string& name, const std::vector<int>& moved) const;
  Result<dsp::WaveTables> cycles_of(const OscillatorSpec& oscillator) const;
  Result<void> link_envelope(const std::string& name, const Part& part,
                             PatchProgram::Source& source) const;
  Result<void> compile_envelopes();
  Result<void> add_default_amp();
  Result<void> compile_lfos();
  Result<void> compile_maps();
  Result<void> check_range(const MovedNumber& moved) const;
  Result<void> check_knot(const MovedNumber& moved) const;
  Result<void> check_source(MapSource source, int index) const;
  Result<void> check_target(const MapSpec& map) const;
  Result<void> check_map(const MapSpec& map, std::size_t number) const;
  Result<void> compile_map(const MapSpec& map, std::size_t number);
  /// Its curve or surface has weights that differ, or a map moves one of them.
  bool is_rational(const MapSpec& map) const;
  void drop_overridden_maps();
  Result<void> compile_rest();
  Result<void> add_curve(const MapSpec& map, std::size_t number, PatchProgram::MapPart& part) const;
  Result<void> add_surface(const MapSpec& map, PatchProgram::MapPart& part) const;
  Result<void> order_steps();
  Error circle(const std::vector<PatchProgram::Step>& stuck) const;
  Result<void> find_note_on_maps();
  bool velocity_is_loudness() const;
  void finish_flags();

  /// The curve, or unknown_name with a suggestion.
  Result<const curves::NurbsCurve*> curve(const std::string& name, const Part& part) const;
  /// The curve with the numbers that maps move, and the slots these are in. `is_function`: not
  /// possible on a 2-D curve, which is unsupported.
  struct MovedCurve {
    const curves::NurbsCurve* curve = nullptr;
    curves::CompileOptions options;
    std::vector<int> slots;
  };
  Result<MovedCurve> moved_curve(const std::string& name, const Part& part,
                                 bool is_function = true) const;
  std::vector<int> moved_numbers_of(const std::string& curve) const;
  int envelope_index(const std::string& name) const;
  Error placed(Error error, std::string_view path) const;
  Error about(Error error) const;
  /// The error with the part's name in front, and its place unless it has one.
  Error about(Error error, const Part& part) const;
  Part map_part(int number, const char* key = "") const;
  void tell(std::string line);

  const PatchSpec& spec_;
  std::span<const WaveCycles> cycles_;
  std::unique_ptr<PatchProgram> program_;
  std::vector<MovedNumber> moved_;
  std::vector<MapOrigin> map_origins_;  ///< of program_->maps_ until the overridden ones are out
  std::map<std::string, std::shared_ptr<const dsp::WaveTables>> waves_;
};

}  // namespace knotwave::engine
