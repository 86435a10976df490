// SPDX-License-Identifier: MIT
// Several curves as one shaper.
#include <algorithm>
#include <array>
#include <limits>

#include "knotwave/base/fit_input.h"
#include "knotwave/dsp/shaper.h"

namespace knotwave::dsp {
namespace {

/// What moves one layer, at one sample.
struct OneLayer {
  double drive, bias, level, weight, wet;

  OneLayer(const ShaperLayer& layer, const ShaperMotion& motion, std::size_t i) KNOTWAVE_RT
      : drive(static_cast<double>(motion.drive[i])),
        bias(motion.bias[i]),
        level(motion.level[i]),
        weight(layer.weight[i]<0 || layer.weight[i]> 0 ? layer.weight[i] : 0),
        wet(motion.mix[i] > 0 ? std::min(motion.mix[i], 1.0) : 0.0) {}
};

}  // namespace

/// Where the layers are: each has pieces of its own.
struct Shaper::Blend {
  std::span<const ShaperLayer> layers;
  std::array<ShaperProgram::Input, kMostLayers> last{};
  double bias = std::numeric_limits<double>::quiet_NaN();  ///< not known yet
  std::array<double, kMostLayers> at_rest{};               ///< values at `bias`

  explicit Blend(std::span<const ShaperLayer> all) KNOTWAVE_RT
      : layers(all.first(std::min(all.size(), kMostLayers))) {}

  void start(double x, int hint) KNOTWAVE_RT {
    for (std::size_t k = 0; k < layers.size(); ++k) last[k] = layers[k].program->locate(x, hint);
  }
  void rest_at(double x) KNOTWAVE_RT {
    bias = x;
    for (std::size_t k = 0; k < layers.size(); ++k) at_rest[k] = layers[k].program->at(x);
  }
  /// The blend's mean from the last input to x, less `level` of what it is at rest.
  double step(double x, double level, std::size_t i) KNOTWAVE_RT {
    double sum = 0;
    bool is_first = true;
    for (std::size_t k = 0; k < layers.size(); ++k) {
      const ShaperProgram& program = *layers[k].program;
      const ShaperProgram::Input input = program.locate(x, last[k].piece);
      const double weight = layers[k].weight[i];
      if (weight < 0 || weight > 0) {
        const double mean = program.mean(last[k], input, {});
        const double part = weight * (level == 0 ? mean : mean - level * at_rest[k]);
        sum = is_first ? part : sum + part;
        is_first = false;
      }
      last[k] = input;
    }
    return sum;
  }
};

template <bool rests>
void Shaper::render_one(const ShaperLayer& layer, const ShaperMotion& motion,
                        std::span<const float> in, std::span<float> out) KNOTWAVE_RT {
  if (out.empty()) return;
  const ShaperProgram& program = *layer.program;
  ShaperProgram::Input last = program.locate(last_, last_piece_);
  OneLayer now(layer, motion, 0);
  double at_rest = now.level == 0 ? 0 : program.at(now.bias), taken = now.level * at_rest;
  double last_dry = last_dry_;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if constexpr (!rests) {
      const double bias = now.bias, level = now.level;
      now = OneLayer(layer, motion, i);
      if (now.level != 0 && (now.bias != bias || level == 0)) at_rest = program.at(now.bias);
      taken = now.level == 0 ? 0 : now.level * at_rest;
    }
    const double dry = base::fit_input(static_cast<double>(in[i]));
    const ShaperProgram::Input input = program.locate(now.drive * dry + now.bias, last.piece);
    double shaped = 0;
    if (now.weight != 0) {
      shaped = now.weight * (program.still_mean(last, input) - taken);
    }
    out[i] = static_cast<float>(now.wet * shaped + (1 - now.wet) * (0.5 * (dry + last_dry)));
    last = input;
    last_dry = dry;
  }
  last_dry_ = last_dry;
  last_ = last.x;
  last_piece_ = last.piece;
}

void Shaper::render(std::span<const ShaperLayer> layers, const ShaperMotion& motion,
                    std::span<const float> in, std::span<float> out) KNOTWAVE_RT {
  if (layers.size() == 1 && layers[0].program->control_count() == 0) {
    return motion.rests ? render_one<true>(layers[0], motion, in, out)
                        : render_one<false>(layers[0], motion, in, out);
  }
  Blend blend(layers);
  blend.start(last_, last_piece_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double dry = base::fit_input(static_cast<double>(in[i]));
    const double bias = motion.bias[i];
    const double level = motion.level[i];
    if (level != 0 && bias != blend.bias) blend.rest_at(bias);
    last_ = base::fit_input(static_cast<double>(motion.drive[i]) * dry + bias);
    const double shaped = blend.step(last_, level, i);
    const double wet = motion.mix[i] > 0 ? std::min(motion.mix[i], 1.0) : 0.0;
    out[i] = static_cast<float>(wet * shaped + (1 - wet) * (0.5 * (dry + last_dry_)));
    last_dry_ = dry;
  }
  if (!blend.layers.empty()) last_piece_ = blend.last[0].piece;
}

}  // namespace knotwave::dsp
