// SPDX-License-Identifier: MIT
// What effects have in common: parameters that glide to the sample, curves of their own, a state
// that is text (docs/plugin-state.md), blocks of any size. An effect itself sees parts of at most
// kPart samples, with every channel there and every input finite.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/hand_over.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/smoother.h"
#include "knotwave/plugins/parameter_values.h"
#include "knotwave/plugins/plugin.h"
#include "knotwave/plugins/song.h"

namespace knotwave::plugins {

/// A curve that the state may hold: `[curves.NAME]`, played where `parameter` is its choice 0.
struct OwnCurve {
  std::string_view name;
  std::size_t parameter = 0;
};

class Effect : public Plugin {
 public:
  /// How long a parameter, a choice or a curve takes to become another.
  static constexpr double kGlideSeconds = 0.005;
  static constexpr std::size_t kPart = 64;

  ~Effect() override;
  const PluginInfo& info() const final { return *info_; }

  /// Every parameter that the preset doesn't name goes to its initial value.
  Result<void> load_preset(std::size_t number) final;
  /// A plugin's state; or a curve file: its curves in their order become those of the effect's own,
  /// and are chosen. Errors with line and column: those of base::parse_document() and
  /// curves::read_curve_tables(), unsupported (another plugin's, too many curves), unknown_key,
  /// unknown_name, wrong_type, value_out_of_range, and what a curve's role asks for.
  Result<void> load_state(std::string_view text) final;
  std::string state() const final;

  Result<void> activate(double rate_hz) final;
  void deactivate() final { is_active_ = false; }
  bool is_active() const final { return is_active_; }
  void collect() final { curves_.collect(); }

  void set_parameter(std::size_t place, double value) KNOTWAVE_RT final;
  double parameter(std::size_t place) const KNOTWAVE_RT final;

  void begin(const Block& block) KNOTWAVE_RT final;
  void add(const engine::Event& event) KNOTWAVE_RT final;
  void add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT final;
  void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT final;
  void render() KNOTWAVE_RT final;
  /// As if just activated: time 0.
  void reset() KNOTWAVE_RT final;
  /// Nothing came in and nothing above -120 dB came out for as long as its tail.
  bool is_idle() const KNOTWAVE_RT final { return quiet_samples_ > tail_samples(); }

 protected:
  /// What the audio thread plays of the curves of its own. Immutable.
  struct Compiled {
    virtual ~Compiled() = default;
  };

  /// [control] `own` stays. `info` needs no more than key, ports and parameters yet.
  Effect(const PluginInfo& info, std::span<const OwnCurve> own);

  /// [control] `own` has some of the own curves, by name. Errors: a curve that is none for its
  /// role. Without any curve it succeeds.
  virtual Result<std::unique_ptr<const Compiled>> compile(const curves::CurveSet& own) const = 0;

  // All [audio].

  /// Nothing sounds any more, and nothing glides: choices and curves are there at once.
  virtual void clear(const Compiled& own) KNOTWAVE_RT = 0;
  /// These are its own curves from now on. The ones before are kept while uses() says so.
  virtual void install(const Compiled& own) KNOTWAVE_RT = 0;
  virtual bool uses(const Compiled& own) const KNOTWAVE_RT = 0;
  /// A parameter with choices was set.
  virtual void choose(std::size_t place, int choice) KNOTWAVE_RT = 0;
  virtual void hear(const engine::Event& event) KNOTWAVE_RT { static_cast<void>(event); }
  /// The song is about to jump from song() to `there`, at now().
  virtual void jump(const Song& there) KNOTWAVE_RT { static_cast<void>(there); }
  /// Before every part: how many samples it may have, >= 1.
  virtual std::size_t begin_part() KNOTWAVE_RT { return kPart; }
  /// Fills every output() from every input().
  virtual void render_part() KNOTWAVE_RT = 0;

  double rate_hz() const KNOTWAVE_RT { return rate_hz_; }
  int glide_samples() const KNOTWAVE_RT { return glide_samples_; }
  std::int64_t now() const KNOTWAVE_RT { return now_; }  ///< the part's first sample
  std::size_t part_size() const KNOTWAVE_RT { return part_size_; }
  /// NaN is 0, below 1e-20 is 0, and what is beyond 1e6 is 1e6.
  std::span<const float> input(std::size_t channel) const KNOTWAVE_RT {
    return std::span(in_[channel]).first(part_size_);
  }
  std::span<float> output(std::size_t channel) KNOTWAVE_RT {
    return std::span(out_[channel]).first(part_size_);
  }
  /// The part's values of a parameter as it glides, in its unit.
  void glide(std::size_t place, std::span<double> out) const KNOTWAVE_RT {
    glides_[place].render(now_, out);
  }
  /// A part's values of a number, kept from part to part: while it rests nothing is worked out.
  struct PartValues {
    std::array<double, kPart> at{};
    bool is_one = true;  ///< at[0] everywhere, behind the part too

    void fill(double value) KNOTWAVE_RT {
      if (!is_one || at[0] != value) at.fill(value);
      is_one = true;
    }
    bool is(double value) const KNOTWAVE_RT { return is_one && at[0] == value; }
  };
  void glide(std::size_t place, PartValues& out) const KNOTWAVE_RT;
  /// Of a parameter in decibels.
  struct PartGains {
    PartValues db, gain{.at = {}, .is_one = false};
  };
  void glide_gain(std::size_t place, PartGains& out) const KNOTWAVE_RT;
  /// Of a parameter as it glides, at now().
  double value_now(std::size_t place) const KNOTWAVE_RT { return glides_[place].value_at(now_); }
  bool is_still(std::size_t place) const KNOTWAVE_RT { return glides_[place].is_still(now_); }
  double heard(std::size_t place) const KNOTWAVE_RT { return values_.heard(place); }
  int choice(std::size_t place) const KNOTWAVE_RT { return static_cast<int>(heard(place)); }
  const Song& song() const KNOTWAVE_RT { return song_; }

 private:
  struct State;
  Result<State> read_state(const base::Node& root) const;
  Result<State> read_curve_file(std::string_view text) const;
  void change(std::size_t place, double value) KNOTWAVE_RT;
  void start() KNOTWAVE_RT;
  bool take_curves() KNOTWAVE_RT;
  void render_until(std::int64_t sample) KNOTWAVE_RT;
  void read_inputs() KNOTWAVE_RT;
  void write_outputs() KNOTWAVE_RT;

  const PluginInfo* info_;
  std::span<const OwnCurve> own_;
  curves::CurveSet own_curves_;  ///< [control]
  ParameterValues values_;
  base::HandOver<const Compiled> curves_;
  bool is_active_ = false;

  // The audio thread.
  const Compiled* playing_ = nullptr;
  const Compiled* leaving_ = nullptr;
  double rate_hz_ = 48000;
  int glide_samples_ = 1;
  std::vector<dsp::Smoother> glides_;  ///< [parameters]
  Song song_;
  Block block_;
  std::size_t done_ = 0;  ///< samples of this block that are rendered
  std::int64_t now_ = 0;
  std::int64_t quiet_samples_ = 0;
  std::size_t inputs_ = 0, outputs_ = 0;  ///< channels
  std::size_t part_size_ = 0;
  std::array<std::array<float, kPart>, Block::kMostChannels> in_{}, out_{};
};

}  // namespace knotwave::plugins
