// SPDX-License-Identifier: MIT
// Control voltage: values in volts to samples of an audio interface, by its calibration, with slow
// ramps in and out; or, for loudspeakers, with the direct current taken out.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// One audio channel of an interface: sample = (volts - offset_v) / volts_full_scale.
struct VoltageChannel {
  double volts_full_scale = 10;  ///< that a sample of 1 gives; negative: the interface inverts
  double offset_v = 0;           ///< that a sample of 0 gives
};

struct VoltageConfig {
  bool direct_current = false;  ///< --cv; else a high-pass of kProtectHz keeps loudspeakers safe
  double ramp_s = 0.5;          ///< in and out: from a sample of 0, along the S-curve 3 t^2 - 2 t^3
  double rate_hz = 48000;
  std::vector<VoltageChannel> channels;  ///< missing ones are as the default
};

inline constexpr double kProtectHz = 20;  ///< first order

/// Reads a calibration file: format 1, kind "calibration", [[channels]] in order from 1, each with
/// volts_full_scale (0.01..1000, or as much below 0) and offset_v. [control] Errors with line and
/// column.
Result<std::vector<VoltageChannel>> parse_calibration(std::string_view text,
                                                      std::string_view source_name);

/// One channel's way to the samples.
class VoltageOutput {
 public:
  /// [control] `channel` from 1. Errors: value_out_of_range (a full scale of 0, a ramp below 1 ms
  /// or above 60 s, a rate outside 8000..768000).
  static Result<VoltageOutput> create(const VoltageConfig& config, int channel);

  /// Volts to samples, clamped to -1..1 (clamps are counted); any split gives the same bits. NaN is
  /// 0 V. The ramp in begins with the first sample; the high-pass comes after the ramps. With
  /// direct current a sample is within 2^-25 of the ideal one. [audio]
  void render(std::int64_t first, std::span<const double> volts, std::span<float> out) KNOTWAVE_RT;
  /// Begins the way to a sample of 0, as of a device that is closed, at `sample`. [audio]
  void ramp_out(std::int64_t sample) KNOTWAVE_RT;
  bool is_silent(std::int64_t sample) const KNOTWAVE_RT;  ///< it has come there
  /// The next sample is the first again: a device that was lost is back. [control, not rendering]
  void begin_again();
  std::int64_t clamped() const KNOTWAVE_RT { return clamped_; }

 private:
  VoltageOutput() = default;
  double gain(std::int64_t sample) const KNOTWAVE_RT;
  double protect(double in) KNOTWAVE_RT;

  VoltageChannel channel_;
  bool is_direct_ = false, has_begun_ = false, is_ramping_out_ = false;
  std::int64_t ramp_samples_ = 1, ramp_in_from_ = 0, ramp_out_from_ = 0;
  double high_pass_ = 0, last_in_ = 0, coefficient_ = 0;
  std::int64_t clamped_ = 0;
};

}  // namespace knotwave::engine
