// SPDX-License-Identifier: MIT
// Knotwave Crossfade: two inputs, a law between them, over dsp::CrossfadeLaw.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"
#include "knotwave/curves/compile.h"
#include "knotwave/dsp/crossfade.h"
#include "knotwave/plugins/effect.h"
#include "knotwave/plugins/exchange.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "parameter_kinds.h"
#include "shipped_curves.h"

namespace knotwave::plugins {
namespace {

using curves::CurveProgram;
using dsp::CrossfadeLaw;

struct Place {
  enum : std::size_t {
    position,
    law,
    source,
    amount,
    motion,
    beats,
    phase,
    smooth,
    threshold,
    range,
    attack,
    release,
    output
  };
};

constexpr std::size_t kChannels = 2;
constexpr std::string_view kFades = "curves/crossfades.toml", kLfos = "curves/lfo.toml";
/// The laws behind the two that are no curves.
constexpr ShippedCurve kLaws[] = {
    {"Between", kFades, "between"}, {"Cut", kFades, "cut"}, {"Gap", kFades, "gap"}};
constexpr ShippedCurve kMotions[] = {{"Ramp", kFades, "ramp"},    {"Triangle", kFades, "triangle"},
                                     {"Swing", kFades, "swing"},  {"Halves", kFades, "halves"},
                                     {"Breath", kLfos, "breath"}, {"Steps", kLfos, "steps"},
                                     {"Gallop", kLfos, "gallop"}};
constexpr int kRamp = 1, kEqualPower = 1, kSwing = 3;
constexpr OwnCurve kOwn[] = {{"law", Place::law}, {"motion", Place::motion}};

struct Length {
  std::string_view word;
  double quarters;
};
constexpr Length kLengths[] = {
    {"1/8 beat", 0.125}, {"1/6 beat", 1.0 / 6}, {"1/4 beat", 0.25}, {"1/3 beat", 1.0 / 3},
    {"1/2 beat", 0.5},   {"2/3 beat", 2.0 / 3}, {"3/4 beat", 0.75}, {"1 beat", 1},
    {"1.5 beats", 1.5},  {"2 beats", 2},        {"3 beats", 3},     {"4 beats", 4},
    {"6 beats", 6},      {"8 beats", 8},        {"12 beats", 12},   {"16 beats", 16},
    {"32 beats", 32},    {"64 beats", 64},      {"128 beats", 128}};
constexpr int kFourBeats = 11;

struct Source {
  enum { position, motion, audio };
};

std::vector<std::string> law_choices() {
  std::vector<std::string> choices = curve_choices(kLaws);
  choices.insert(choices.begin() + 1, {"Equal power", "Equal gain"});
  return choices;
}

std::vector<std::string> length_choices() {
  std::vector<std::string> choices;
  for (const Length& length : kLengths) choices.emplace_back(length.word);
  return choices;
}

std::span<const CrossfadeLaw> laws() {
  static const auto all = [] {
    auto programs = shipped_programs<CrossfadeLaw>(
        kLaws, [](const curves::NurbsCurve& curve) { return CrossfadeLaw::create(curve); });
    programs.insert(programs.begin(), {CrossfadeLaw(), CrossfadeLaw::linear()});
    return programs;
  }();
  return all;
}

std::span<const CurveProgram> motions() {
  static const auto all = shipped_programs<CurveProgram>(
      kMotions, [](const curves::NurbsCurve& curve) { return curves::compile_function(curve); });
  return all;
}

const ParameterTable& table() {
  static const ParameterTable all({
      number_parameter("position", "Position", "Crossfade", "", {0, 1, 0.5}),
      choice_parameter("law", "Law", "Crossfade", law_choices(), kEqualPower),
      choice_parameter("source", "Source", "Crossfade", {"Position", "Motion", "Audio"}, 0),
      number_parameter("amount", "Amount", "Crossfade", "", {-1, 1, 1}),
      choice_parameter("motion", "Motion", "Motion", curve_choices(kMotions), kSwing),
      choice_parameter("beats", "Length", "Motion", length_choices(), kFourBeats),
      number_parameter("phase", "Phase", "Motion", "cycles", {0, 1, 0}),
      number_parameter("smooth", "Smooth", "Motion", "ms", {0, 100, 2}),
      number_parameter("threshold", "Threshold", "Audio", "dB", {-80, 0, -40}),
      number_parameter("range", "Range", "Audio", "dB", {1, 60, 12}),
      number_parameter("attack", "Attack", "Audio", "ms", {0.1, 500, 10}),
      number_parameter("release", "Release", "Audio", "ms", {1, 5000, 250}),
      number_parameter("output", "Output", "Output", "dB", {-48, 24, 0}),
  });
  return all;
}

class CrossfadePlugin final : public Effect {
 public:
  CrossfadePlugin() : Effect(crossfade_info(), kOwn), laws_(laws()), motions_(motions()) {}

 private:
  using Doubles = std::array<double, kPart>;
  using Floats = std::array<float, kPart>;

  /// A law that is not there is equal power, a motion the ramp.
  struct Own final : Compiled {
    CrossfadeLaw law;
    CurveProgram motion;
  };

  Result<std::unique_ptr<const Compiled>> compile(const curves::CurveSet& own) const override {
    auto compiled = std::make_unique<Own>();
    compiled->motion = motions_[kRamp - 1];
    if (const auto* const curve = own.find_curve("law")) {
      auto made = CrossfadeLaw::create(*curve);
      if (!made) return made.error();
      compiled->law = *std::move(made);
    }
    if (const auto* const curve = own.find_curve("motion")) {
      auto made = curves::compile_function(*curve);
      if (!made) return made.error();
      compiled->motion = *std::move(made);
    }
    return std::unique_ptr<const Compiled>(std::move(compiled));
  }

  template <class Thing>
  static const Thing* chosen(const Thing& own, std::span<const Thing> shipped,
                             int number) KNOTWAVE_RT {
    return number == 0 ? &own : &shipped[static_cast<std::size_t>(number - 1)];
  }
  const CrossfadeLaw* chosen_law() const KNOTWAVE_RT {
    return chosen(own_->law, laws_, choice(Place::law));
  }
  const CurveProgram* chosen_motion() const KNOTWAVE_RT {
    return chosen(own_->motion, motions_, choice(Place::motion));
  }
  bool is_unheard(const dsp::Smoother& by) const KNOTWAVE_RT {
    return by.is_still(now()) && by.target() == 0;
  }
  double share_of(int source) const KNOTWAVE_RT { return choice(Place::source) == source ? 1 : 0; }

  void clear(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    law_.reset(chosen_law(), glide_samples());
    motion_.reset(chosen_motion(), glide_samples());
    by_motion_.reset(share_of(Source::motion), glide_samples());
    by_audio_.reset(share_of(Source::audio), glide_samples());
    power_ = 0;
    is_first_ = true;
  }
  void install(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    law_.choose(chosen_law());
    motion_.choose(chosen_motion());
  }
  bool uses(const Compiled& own) const KNOTWAVE_RT override {
    const auto& all = static_cast<const Own&>(own);
    return law_.uses(all.law) || motion_.uses(all.motion);
  }
  void choose(std::size_t place, int) KNOTWAVE_RT override {
    if (place == Place::law) law_.choose(chosen_law());
    if (place == Place::motion) motion_.choose(chosen_motion());
    if (place != Place::source) return;
    if (is_unheard(by_motion_)) is_first_ = true;
    by_motion_.set_target(share_of(Source::motion), now());
    by_audio_.set_target(share_of(Source::audio), now());
  }
  std::size_t begin_part() KNOTWAVE_RT override {
    law_.begin(now());
    motion_.begin(now());
    return std::min({kPart, law_.steady(now()), motion_.steady(now())});
  }

  /// The first part_size() of them.
  template <class Array>
  auto part(Array& values) const KNOTWAVE_RT {
    return std::span(values).first(part_size());
  }

  /// of(value) of a gliding parameter at every sample.
  template <class Of>
  void gliding(std::size_t place, std::span<double> out, Of of) const KNOTWAVE_RT {
    glide(place, out);
    if (is_still(place)) {
      std::fill(out.begin(), out.end(), of(out[0]));
    } else {
      for (double& value : out) value = of(value);
    }
  }

  /// How much of its way a follower with this time constant goes in a sample.
  double pace(double milliseconds) const KNOTWAVE_RT {
    constexpr double kOctavesPerE = 1.4426950408889634;
    if (!(milliseconds > 0)) return 1;
    return 1 - base::exp2(-1000 * kOctavesPerE / (milliseconds * rate_hz()));
  }
  void paces(std::size_t place, std::span<double> out) const KNOTWAVE_RT {
    gliding(place, out, [this](double ms) { return pace(ms); });
  }

  /// The motion's curve by the song, smoothed.
  void render_motion(std::span<double> out) KNOTWAVE_RT {
    const double length = kLengths[static_cast<std::size_t>(choice(Place::beats))].quarters;
    glide(Place::phase, part(places_));
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double passes =
          song().quarters_at(now() + static_cast<std::int64_t>(i)) / length + places_[i];
      places_[i] = passes - std::floor(passes);
    }
    value_of(motion_.to(), out);
    if (!motion_.is_still()) {
      value_of(motion_.from(), part(other_));
      motion_.weights(now(), part(fade_));
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = mixed(other_[i], out[i], fade_[i]);
    }
    paces(Place::smooth, part(fade_));
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (std::exchange(is_first_, false)) smoothed_ = out[i];
      smoothed_ = base::snap_to_zero(mixed(smoothed_, out[i], fade_[i]));
      out[i] = smoothed_;
    }
  }
  /// Of one curve at places_, 0..1 over the whole of its domain.
  void value_of(const CurveProgram& program, std::span<double> out) const KNOTWAVE_RT {
    const double width = program.u_max() - program.u_min();
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = std::clamp(program.at_u(program.u_min() + places_[i] * width), 0.0, 1.0);
    }
  }
  static double mixed(double a, double b, double share) KNOTWAVE_RT {
    return share == 1 ? b : a + share * (b - a);
  }

  /// 0 up to the threshold of input B's loudness, 1 from `range` above it on.
  void render_audio(std::span<double> out) KNOTWAVE_RT {
    paces(Place::attack, part(places_));
    paces(Place::release, part(fade_));
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double left = static_cast<double>(input(2)[i]);
      const double right = static_cast<double>(input(3)[i]);
      const double power = 0.5 * (left * left + right * right);
      power_ = base::snap_to_zero(mixed(power_, power, power > power_ ? places_[i] : fade_[i]));
      out[i] = power_;
    }
    if (is_unheard(by_audio_)) return;
    glide(Place::threshold, part(places_));
    glide(Place::range, part(fade_));
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double level_db = 0.5 * base::gain_to_db(out[i]);
      out[i] = std::clamp((level_db - places_[i]) / fade_[i], 0.0, 1.0);
    }
  }

  /// From the parameter, `amount` of the way to what the source says.
  void render_positions(std::span<double> out) KNOTWAVE_RT {
    glide(Place::position, out);
    const auto add = [&](const dsp::Smoother& by, std::span<const double> wanted) {
      if (is_unheard(by)) return;
      by.render(now(), part(fade_));
      for (std::size_t i = 0; i < out.size(); ++i) {
        const double to = amounts_[i] < 0 ? 1 - wanted[i] : wanted[i];
        moves_[i] += fade_[i] * std::abs(amounts_[i]) * (to - out[i]);
      }
    };
    glide(Place::amount, part(amounts_));
    if (!is_unheard(by_motion_)) render_motion(part(by_song_));
    render_audio(part(by_level_));
    moves_.fill(0);
    add(by_motion_, part(by_song_));
    add(by_audio_, part(by_level_));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += moves_[i];
  }

  void render_part() KNOTWAVE_RT override {
    const std::size_t n = part_size();
    render_positions(part(positions_));
    law_.to().render(part(positions_), part(gains_a_), part(gains_b_));
    if (!law_.is_still()) {
      law_.from().render(part(positions_), part(old_a_), part(old_b_));
      law_.weights(now(), part(fade_));
      for (std::size_t i = 0; i < n; ++i) {
        const auto faded = [&](float from, float to) {
          return static_cast<float>(
              mixed(static_cast<double>(from), static_cast<double>(to), fade_[i]));
        };
        gains_a_[i] = faded(old_a_[i], gains_a_[i]);
        gains_b_[i] = faded(old_b_[i], gains_b_[i]);
      }
    }
    gliding(Place::output, part(fade_), [](double db) { return base::db_to_gain(db); });
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const auto a = input(channel), b = input(channel + kChannels);
      const auto out = output(channel);
      for (std::size_t i = 0; i < n; ++i) {
        const double sum = static_cast<double>(gains_a_[i]) * static_cast<double>(a[i]) +
                           static_cast<double>(gains_b_[i]) * static_cast<double>(b[i]);
        out[i] = static_cast<float>(fade_[i] * sum);
      }
    }
  }

  std::span<const CrossfadeLaw> laws_;
  std::span<const CurveProgram> motions_;
  const Own* own_ = nullptr;
  Exchange<CrossfadeLaw> law_;
  Exchange<CurveProgram> motion_;
  dsp::Smoother by_motion_, by_audio_;  ///< how much each source has to say
  double power_ = 0;                    ///< of input B, followed
  double smoothed_ = 0;                 ///< of the motion
  bool is_first_ = true;                ///< nothing is smoothed yet

  // Of a part.
  Doubles positions_{}, amounts_{}, moves_{}, by_song_{}, by_level_{}, places_{}, other_{}, fade_{};
  Floats gains_a_{}, gains_b_{}, old_a_{}, old_b_{};
};

}  // namespace

const PluginInfo& crossfade_info() {
  static constexpr AudioPort kInputs[] = {{"Input A", 2}, {"Input B", 2}};
  static constexpr AudioPort kOutputs[] = {{"Output", 2}};
  static const std::vector<std::string> presets = preset_names(effect_presets("crossfade"));
  static const PluginInfo info = [] {
    PluginInfo all;
    all.key = "crossfade";
    all.name = "Knotwave Crossfade";
    all.description = "From one input to another along any law: by hand, by the beat or by ear";
    all.inputs = kInputs;
    all.outputs = kOutputs;
    all.kind = PluginInfo::Kind::mixer;
    all.parameters = &table();
    all.presets = presets;
    all.create = [] { return std::unique_ptr<Plugin>(std::make_unique<CrossfadePlugin>()); };
    return all;
  }();
  return info;
}

}  // namespace knotwave::plugins
