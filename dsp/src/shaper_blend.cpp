// SPDX-License-Identifier: MIT
// Several curves as one shaper.
#include <algorithm>
#include <array>
#include <limits>

#include "knotwave/dsp/shaper.h"

#include "shaper_input.h"

namespace knotwave::dsp {

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

void Shaper::render(std::span<const ShaperLayer> layers, const ShaperMotion& motion,
                    std::span<const float> in, std::span<float> out) KNOTWAVE_RT {
  Blend blend(layers);
  blend.start(last_, last_piece_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double dry = shaper_input(static_cast<double>(in[i]));
    const double bias = motion.bias[i];
    const double level = motion.level[i];
    if (level != 0 && bias != blend.bias) blend.rest_at(bias);
    last_ = shaper_input(static_cast<double>(motion.drive[i]) * dry + bias);
    const double shaped = blend.step(last_, level, i);
    const double wet = motion.mix[i] > 0 ? std::min(motion.mix[i], 1.0) : 0.0;
    out[i] = static_cast<float>(wet * shaped + (1 - wet) * (0.5 * (dry + last_dry_)));
    last_dry_ = dry;
  }
  if (!blend.layers.empty()) last_piece_ = blend.last[0].piece;
}

}  // namespace knotwave::dsp
