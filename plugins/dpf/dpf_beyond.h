// SPDX-License-Identifier: MIT
// What DPF 1.6 has no word for, or says wrongly: the mended copy of its sources (mends.cmake) asks
// the plugin itself. docs/decisions/dpf.md tells why, point by point.
#pragma once
#include <cstdint>
#include <string>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

/// What LV2 says of the song at one moment. NaN: not told.
struct BarsAndBeats {
  double bar, bar_beat, beat, beat_unit, beats_per_bar, beats_per_minute, speed;
};

class DpfBeyond {
 public:
  virtual ~DpfBeyond() = default;

  /// A point of automation in the block that run() is called with next; `normalized` counts the
  /// parameter's range from 0 to 1. The value that DPF is to show for it. [audio]
  virtual float add_point(std::uint32_t index, double normalized,
                          std::int64_t sample) KNOTWAVE_RT = 0;
  /// Where no block follows: all points count at once. [audio]
  virtual void flush_points() KNOTWAVE_RT = 0;
  /// In place of DPF's own position, of the block that run() is called with next. [audio]
  virtual void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT = 0;
  virtual void hear_song(const BarsAndBeats& told, std::int64_t sample) KNOTWAVE_RT = 0;
  virtual std::int64_t tail() const KNOTWAVE_RT = 0;  ///< Plugin::tail_samples(). [any]

  virtual std::string save() const = 0;            ///< [control]
  virtual bool load(const std::string& text) = 0;  ///< All or nothing. [control]

  /// Text of a value and back, in words and digits that no locale changes. [control]
  virtual std::string text(std::uint32_t index, double normalized) const = 0;
  /// NaN: says nothing.
  virtual double normalized(std::uint32_t index, const std::string& text) const = 0;
};

/// `plugin` is what DPF calls Plugin.
DpfBeyond& dpf_beyond(void* plugin);

/// `text` within """ of a Turtle file.
std::string turtle_text(const char* text);

}  // namespace knotwave::plugins
