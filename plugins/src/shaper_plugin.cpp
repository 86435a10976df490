// SPDX-License-Identifier: MIT
// Knotwave Shaper: two curves and a morph between them, over dsp::Shaper.
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/dsp/filter.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/plugins/effect.h"
#include "knotwave/plugins/exchange.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "parameter_kinds.h"
#include "shipped_curves.h"

namespace knotwave::plugins {
namespace {

using dsp::ShaperProgram;

struct Place {
  enum : std::size_t { curve_a, curve_b, morph, drive, bias, mix, output, dc_block };
};

constexpr std::size_t kChannels = 2;
constexpr std::size_t kSlots = 2;  ///< A and B
constexpr std::string_view kFile = "curves/shapers.toml";
constexpr ShippedCurve kShipped[] = {
    {"Straight", kFile, "straight"}, {"Round", kFile, "round"}, {"Knee", kFile, "knee"},
    {"Clip", kFile, "clip"},         {"Valve", kFile, "valve"}, {"Fold", kFile, "fold"},
    {"Fifth", kFile, "fifth"},       {"Full", kFile, "full"},   {"Steps", kFile, "steps"},
};
constexpr int kStraight = 1, kKnee = 3;
constexpr OwnCurve kOwn[] = {{"a", Place::curve_a}, {"b", Place::curve_b}};

/// The highest corner of a high-pass nobody hears, and how long it rings until -120 dB:
/// (1 + w t) e^(-w t) = 1e-6 at w t = 16.7.
constexpr float kDcBlockHz = 5;
constexpr double kDcBlockTailSeconds = 16.7 / (2 * 3.14159265358979 * 5);

std::span<const ShaperProgram> shipped() {
  static const auto all = shipped_programs<ShaperProgram>(
      kShipped, [](const curves::NurbsCurve& curve) { return ShaperProgram::create(curve); });
  return all;
}

const ParameterTable& table() {
  static const ParameterTable all({
      choice_parameter("curve_a", "Curve A", "Curves", curve_choices(kShipped), kKnee),
      choice_parameter("curve_b", "Curve B", "Curves", curve_choices(kShipped), kStraight),
      number_parameter("morph", "Morph", "Curves", "", {0, 1, 0}),
      number_parameter("drive", "Drive", "Input", "dB", {-24, 48, 0}),
      number_parameter("bias", "Bias", "Input", "", {-1, 1, 0}),
      number_parameter("mix", "Mix", "Output", "", {0, 1, 1}),
      number_parameter("output", "Output", "Output", "dB", {-48, 24, 0}),
      choice_parameter("dc_block", "DC block", "Output", {"Off", "On"}, 1),
  });
  return all;
}

class ShaperPlugin final : public Effect {
 public:
  ShaperPlugin() : Effect(shaper_info(), kOwn), shipped_(shipped()) {}

  std::int64_t tail_samples() const KNOTWAVE_RT override {
    return 1 + static_cast<std::int64_t>(kDcBlockTailSeconds * rate_hz());
  }
  bool may_sleep() const KNOTWAVE_RT override { return true; }

 private:
  /// A curve that is not there is a straight line.
  struct Own final : Compiled {
    std::array<ShaperProgram, kSlots> programs;
  };

  Result<std::unique_ptr<const Compiled>> compile(const curves::CurveSet& own) const override {
    auto compiled = std::make_unique<Own>();
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      compiled->programs[slot] = shipped_[kStraight - 1];
      const curves::NurbsCurve* const curve = own.find_curve(kOwn[slot].name);
      if (curve == nullptr) continue;
      auto program = ShaperProgram::create(*curve);
      if (!program) return program.error();
      compiled->programs[slot] = *std::move(program);
    }
    return std::unique_ptr<const Compiled>(std::move(compiled));
  }

  const ShaperProgram* chosen(std::size_t slot, int number) const KNOTWAVE_RT {
    return number == 0 ? &own_->programs[slot] : &shipped_[static_cast<std::size_t>(number - 1)];
  }

  void clear(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      slots_[slot].reset(chosen(slot, choice(kOwn[slot].parameter)), glide_samples());
    }
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      shapers_[channel].reset(heard(Place::bias));
      filters_[channel].reset();
    }
  }

  void install(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      slots_[slot].choose(chosen(slot, choice(kOwn[slot].parameter)));
    }
  }

  bool uses(const Compiled& own) const KNOTWAVE_RT override {
    const auto& programs = static_cast<const Own&>(own).programs;
    return slots_[0].uses(programs[0]) || slots_[1].uses(programs[1]);
  }

  void choose(std::size_t place, int number) KNOTWAVE_RT override {
    if (place <= Place::curve_b) slots_[place].choose(chosen(place, number));
    // Faded in, the filter begins with what it is given. However a block is split: at 0 it may have
    // rested, elsewhere never.
    if (place != Place::dc_block || value_now(place) != 0) return;
    for (auto& filter : filters_) filter.reset();
  }

  std::size_t begin_part() KNOTWAVE_RT override {
    std::size_t samples = kPart;
    for (auto& slot : slots_) {
      slot.begin(now());
      samples = std::min(samples, slot.steady(now()));
    }
    return samples;
  }

  /// The curves that are heard, each with its weight. At rest: A, B or both.
  std::span<const dsp::ShaperLayer> layers() KNOTWAVE_RT {
    const std::size_t n = part_size();
    std::size_t count = 0;
    const auto add = [&](const ShaperProgram& program) -> PartValues& {
      layers_[count] = {&program, std::span(weights_[count].at).first(n)};
      return weights_[count++];
    };
    glide(Place::morph, morphs_);
    const auto& morph = morphs_.at;
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      const auto share = [&](std::size_t i) { return slot == 0 ? 1 - morph[i] : morph[i]; };
      if (morphs_.is_one && share(0) == 0) continue;  // unheard
      PartValues& to = add(slots_[slot].to());
      if (slots_[slot].is_still() && morphs_.is_one) {
        to.fill(share(0));
        continue;
      }
      to.is_one = false;
      if (slots_[slot].is_still()) {
        for (std::size_t i = 0; i < n; ++i) to.at[i] = share(i);
        continue;
      }
      PartValues& from = add(slots_[slot].from());
      from.is_one = false;
      slots_[slot].weights(now(), std::span(to.at).first(n));
      for (std::size_t i = 0; i < n; ++i) {
        from.at[i] = share(i) * (1 - to.at[i]);
        to.at[i] = share(i) * to.at[i];
      }
    }
    return std::span(layers_).first(count);
  }

  /// Of the drive's gains, as floats.
  void render_drives() KNOTWAVE_RT {
    glide_gain(Place::drive, driven_);
    const bool is_one = driven_.gain.is_one;
    if (is_one && drives_are_one_ && drives_[0] == static_cast<float>(driven_.gain.at[0])) return;
    drives_are_one_ = is_one;
    const std::size_t n = is_one ? kPart : part_size();
    for (std::size_t i = 0; i < n; ++i) drives_[i] = static_cast<float>(driven_.gain.at[i]);
  }

  /// The direct current taken away, as far as that is wanted, and the output's gain. A filter that
  /// nobody hears rests.
  void finish(std::size_t channel) KNOTWAVE_RT {
    const std::span<float> out = output(channel);
    const std::size_t n = part_size();
    const bool is_open = levels_.is(0), is_closed = levels_.is(1);
    if (!is_open) {
      filters_[channel].render(dsp::FilterKind::high, rate_hz(), std::span(corners_).first(n),
                               std::span(resonances_).first(n), out,
                               is_closed ? out : std::span(blocked_).first(n));
    }
    const auto& gain = gains_.gain;
    if (!is_open && !is_closed) {
      for (std::size_t i = 0; i < n; ++i) {
        const double level = levels_.at[i], open = static_cast<double>(out[i]);
        const double closed = static_cast<double>(blocked_[i]);
        out[i] = static_cast<float>(gain.at[i] * (level * closed + (1 - level) * open));
      }
    } else if (!gain.is(1)) {
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = static_cast<float>(gain.at[i] * static_cast<double>(out[i]));
      }
    }
  }

  void render_part() KNOTWAVE_RT override {
    const std::size_t n = part_size();
    const auto curves = layers();
    render_drives();
    glide_gain(Place::output, gains_);
    glide(Place::bias, biases_);
    glide(Place::mix, mixes_);
    glide(Place::dc_block, levels_);
    const auto part = [n](const auto& values) { return std::span(values).first(n); };
    const dsp::ShaperMotion motion{part(drives_), part(biases_.at), part(levels_.at),
                                   part(mixes_.at),
                                   curves.size() == 1 && drives_are_one_ && biases_.is_one &&
                                       levels_.is_one && mixes_.is_one && weights_[0].is_one};
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      shapers_[channel].render(curves, motion, input(channel), output(channel));
      finish(channel);
    }
  }

  std::span<const ShaperProgram> shipped_;
  const Own* own_ = nullptr;
  std::array<Exchange<ShaperProgram>, kSlots> slots_;
  std::array<dsp::Shaper, kChannels> shapers_;
  std::array<dsp::StateVariableFilter, kChannels> filters_;

  // Of a part.
  using Floats = std::array<float, kPart>;
  std::array<dsp::ShaperLayer, dsp::Shaper::kMostLayers> layers_;
  std::array<PartValues, dsp::Shaper::kMostLayers> weights_{};
  PartValues morphs_, biases_, mixes_, levels_;
  PartGains driven_, gains_;
  Floats drives_{}, blocked_{};
  bool drives_are_one_ = false;
  const Floats resonances_{};
  const Floats corners_ = [] {
    Floats corners;
    corners.fill(kDcBlockHz);
    return corners;
  }();
};

}  // namespace

const PluginInfo& shaper_info() {
  static constexpr AudioPort kInputs[] = {{"Input", 2}};
  static constexpr AudioPort kOutputs[] = {{"Output", 2}};
  static const std::vector<std::string> presets = preset_names(effect_presets("shaper"));
  static const PluginInfo info = [] {
    PluginInfo all;
    all.key = "shaper";
    all.name = "Knotwave Shaper";
    all.description = "Any curve as a waveshaper, two of them with a morph, anti-aliased";
    all.inputs = kInputs;
    all.outputs = kOutputs;
    all.kind = PluginInfo::Kind::distortion;
    all.parameters = &table();
    all.presets = presets;
    all.create = [] { return std::unique_ptr<Plugin>(std::make_unique<ShaperPlugin>()); };
    return all;
  }();
  return info;
}

}  // namespace knotwave::plugins
