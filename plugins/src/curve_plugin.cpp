// SPDX-License-Identifier: MIT
// Knotwave Curve: a drawn curve along the bars of the song moves gain, filter and place.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"
#include "knotwave/curves/compile.h"
#include "knotwave/dsp/elementary_block.h"
#include "knotwave/dsp/filter.h"
#include "knotwave/plugins/effect.h"
#include "knotwave/plugins/exchange.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "parameter_kinds.h"
#include "shipped_curves.h"

namespace knotwave::plugins {
namespace {

using curves::CurveProgram;

struct Place {
  enum : std::size_t {
    curve,
    length,
    beats,
    phase,
    trigger,
    smooth,
    gain,
    filter,
    cutoff_low,
    cutoff_high,
    resonance,
    pan,
    mix,
    output
  };
};

constexpr std::size_t kChannels = 2;
constexpr std::string_view kFile = "curves/cycles.toml";
constexpr ShippedCurve kShipped[] = {
    {"Gate", kFile, "gate"},
    {"Pump", kFile, "pump"},
    {"Swell", kFile, "swell"},
    {"Fall", kFile, "fall"},
    {"Wave", kFile, "wave"},
    {"Triangle", kFile, "triangle"},
    {"Up", kFile, "up"},
    {"Down", kFile, "down"},
    {"Stairs", kFile, "stairs"},
    {"Trance", kFile, "trance"},
    {"Stutter", kFile, "stutter"},
    {"Wander", kFile, "wander"},
    {"Gallop", "curves/lfo.toml", "gallop"},
};
constexpr int kPump = 2;
constexpr OwnCurve kOwn[] = {{"own", Place::curve}};

/// In quarter notes; a bar has four. The last choice is the number `beats`.
struct Length {
  const char* word;
  double quarters;
};
constexpr Length kLengths[] = {
    {"1/16", 0.25},       {"1/8 triplet", 1.0 / 3},
    {"1/8", 0.5},         {"1/4 triplet", 2.0 / 3},
    {"1/8 dotted", 0.75}, {"1/4", 1},
    {"1/4 dotted", 1.5},  {"1/2", 2},
    {"1 bar", 4},         {"2 bars", 8},
    {"4 bars", 16},       {"8 bars", 32},
};
constexpr int kQuarter = 5;

enum Trigger { song_place, note, note_once };

/// Of the choices of the filter, in their order.
struct Filtering {
  bool is_on = false;
  dsp::FilterKind kind = dsp::FilterKind::low;
};
constexpr Filtering kFilterings[] = {{},
                                     {true, dsp::FilterKind::low},
                                     {true, dsp::FilterKind::band},
                                     {true, dsp::FilterKind::high},
                                     {true, dsp::FilterKind::notch}};
constexpr double kCutoffHz = 1000;  ///< of 0 octaves
/// A resonance of 1 (Q = 50) at 20 Hz has fallen by 120 dB after 13.8 Q / (pi f).
constexpr double kFilterTailSeconds = 11;

std::vector<std::string> length_choices() {
  std::vector<std::string> words;
  for (const Length& length : kLengths) words.emplace_back(length.word);
  words.emplace_back("Beats");
  return words;
}

/// Errors: those of compile_function(), value_out_of_range.
Result<CurveProgram> cycle_of(const curves::NurbsCurve& curve) {
  auto program = curves::compile_function(curve);
  if (!program) return program.error();
  if (program->low() < 0 || program->high() > 1) {
    return fail(ErrorCode::value_out_of_range,
                "the points of curve '" + curve.name() + "' lie from " +
                    base::number_text(program->low()) + " to " +
                    base::number_text(program->high()) + "; they must lie from 0 to 1");
  }
  return program;
}

std::span<const CurveProgram> shipped() {
  static const auto all = shipped_programs<CurveProgram>(kShipped, cycle_of);
  return all;
}

const ParameterTable& table() {
  static const ParameterTable all({
      choice_parameter("curve", "Curve", "Curve", curve_choices(kShipped), kPump),
      choice_parameter("length", "Length", "Curve", length_choices(), kQuarter),
      number_parameter("beats", "Beats", "Curve", "", {0.03125, 64, 4}),
      number_parameter("phase", "Phase", "Curve", "cycles", {-1, 1, 0}),
      choice_parameter("trigger", "Trigger", "Curve", {"Song", "Note", "Note, once"}, 0),
      number_parameter("smooth", "Smoothing", "Curve", "ms", {0, 200, 2}),
      number_parameter("gain", "Gain", "Targets", "", {0, 1, 1}),
      choice_parameter("filter", "Filter", "Filter",
                       {"Off", "Low-pass", "Band-pass", "High-pass", "Notch"}, 0),
      number_parameter("cutoff_low", "Cutoff at 0", "Filter", "octaves", {-5.5, 4.3, -2}),
      number_parameter("cutoff_high", "Cutoff at 1", "Filter", "octaves", {-5.5, 4.3, 4.3}),
      number_parameter("resonance", "Resonance", "Filter", "", {0, 1, 0.2}),
      number_parameter("pan", "Pan", "Targets", "", {-1, 1, 0}),
      number_parameter("mix", "Mix", "Output", "", {0, 1, 1}),
      number_parameter("output", "Output", "Output", "dB", {-48, 24, 0}),
  });
  return all;
}

class CurvePlugin final : public Effect {
 public:
  CurvePlugin() : Effect(curve_info(), kOwn), shipped_(shipped()) {}

  std::int64_t tail_samples() const KNOTWAVE_RT override {
    return 1 + (choice(Place::filter) == 0
                    ? 0
                    : static_cast<std::int64_t>(kFilterTailSeconds * rate_hz()));
  }

 private:
  using Doubles = std::array<double, kPart>;
  using Floats = std::array<float, kPart>;
  struct Own final : Compiled {
    CurveProgram program;
  };

  /// A curve that is not there is 0 throughout.
  Result<std::unique_ptr<const Compiled>> compile(const curves::CurveSet& own) const override {
    auto compiled = std::make_unique<Own>();
    if (const curves::NurbsCurve* const curve = own.find_curve(kOwn[0].name)) {
      auto program = cycle_of(*curve);
      if (!program) return program.error();
      compiled->program = *std::move(program);
    }
    return std::unique_ptr<const Compiled>(std::move(compiled));
  }

  const CurveProgram* chosen(int number) const KNOTWAVE_RT {
    return number == 0 ? &own_->program : &shipped_[static_cast<std::size_t>(number - 1)];
  }

  void clear(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    cycle_.reset(chosen(choice(Place::curve)), glide_samples());
    filtering_.reset(&kFilterings[choice(Place::filter)], glide_samples());
    for (auto& pair : filters_) {
      for (dsp::StateVariableFilter& filter : pair) filter.reset();
    }
    origin_ = 0;
    has_note_ = false;
    is_fresh_ = true;
  }
  void install(const Compiled& own) KNOTWAVE_RT override {
    own_ = static_cast<const Own*>(&own);
    cycle_.choose(chosen(choice(Place::curve)));
  }
  bool uses(const Compiled& own) const KNOTWAVE_RT override {
    return cycle_.uses(static_cast<const Own&>(own).program);
  }
  void choose(std::size_t place, int number) KNOTWAVE_RT override {
    if (place == Place::curve) cycle_.choose(chosen(number));
    if (place == Place::filter) filtering_.choose(&kFilterings[number]);
  }

  /// A key begins the cycle at its sample.
  void hear(const engine::Event& event) KNOTWAVE_RT override {
    const bool is_note = event.kind == engine::Event::Kind::midi &&
                         event.midi.status() == base::MidiStatus::note_on &&
                         event.midi.bytes[2] != 0;
    if (!is_note) return;
    origin_ = song().quarters_at(now());
    has_note_ = true;
  }
  /// What a note began goes on where the song jumps.
  void jump(const Song& there) KNOTWAVE_RT override {
    origin_ += there.quarters_at(now()) - song().quarters_at(now());
  }

  std::size_t begin_part() KNOTWAVE_RT override {
    cycle_.begin(now());
    const Filtering* const before = &filtering_.to();
    filtering_.begin(now());
    if (&filtering_.to() != before) {
      newest_filter_ = 1 - newest_filter_;
      for (auto& pair : filters_) pair[newest_filter_].reset();
    }
    return std::min({kPart, cycle_.steady(now()), filtering_.steady(now())});
  }

  /// Where in the cycle every sample is, 0..1.
  void place_each() KNOTWAVE_RT {
    const std::size_t n = part_size();
    const int mode = choice(Place::trigger);
    const auto number = static_cast<std::size_t>(choice(Place::length));
    const bool is_free = number == std::size(kLengths);
    if (is_free) glide(Place::beats, std::span(lengths_).first(n));
    glide(Place::phase, std::span(phases_).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const double quarters = song().quarters_at(now() + static_cast<std::int64_t>(i)) -
                              (mode == song_place ? 0 : origin_);
      const double cycles =
          quarters / (is_free ? lengths_[i] : kLengths[number].quarters) + phases_[i];
      if (mode == note_once) {
        places_[i] = has_note_ ? std::clamp(cycles, 0.0, 1.0) : 1;
      } else {
        places_[i] = cycles - std::floor(cycles);
      }
    }
  }

  void read(const CurveProgram& program, Doubles& out) KNOTWAVE_RT {
    const std::size_t n = part_size();
    const double low = program.u_min(), width = program.u_max() - low;
    for (std::size_t i = 0; i < n; ++i) out[i] = low + width * places_[i];
    curves::CurveCursor cursor;
    program.render(std::span<const double>(out).first(n), std::span(read_).first(n), cursor);
    out = read_;
  }

  /// The curve at every sample, smoothed.
  void follow_curve() KNOTWAVE_RT {
    const std::size_t n = part_size();
    read(cycle_.to(), values_);
    if (!cycle_.is_still()) {
      read(cycle_.from(), older_);
      cycle_.weights(now(), std::span(weights_).first(n));
      for (std::size_t i = 0; i < n; ++i) {
        values_[i] = weights_[i] * values_[i] + (1 - weights_[i]) * older_[i];
      }
    }
    glide(Place::smooth, std::span(lengths_).first(n));
    const bool is_steady = is_still(Place::smooth);
    double share = is_steady ? share_of(lengths_[0]) : 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_steady) share = share_of(lengths_[i]);
      smoothed_ =
          is_fresh_ ? values_[i] : base::snap_to_zero(smoothed_ + share * (values_[i] - smoothed_));
      is_fresh_ = false;
      values_[i] = smoothed_;
    }
  }
  /// Of the way that is left, at every sample: 1/e remains after so long.
  double share_of(double milliseconds) const KNOTWAVE_RT {
    constexpr double kLog2E = 1.4426950408889634;
    if (!(milliseconds > 0)) return 1;
    return 1 - base::exp2(-kLog2E / (milliseconds * 1e-3 * rate_hz()));
  }

  void follow_cutoff() KNOTWAVE_RT {
    const std::size_t n = part_size();
    glide(Place::cutoff_low, std::span(lengths_).first(n));
    glide(Place::cutoff_high, std::span(phases_).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      read_[i] = lengths_[i] + (phases_[i] - lengths_[i]) * values_[i];
    }
    dsp::exp2(std::span<const double>(read_).first(n), std::span(older_).first(n));
    for (std::size_t i = 0; i < n; ++i) cutoffs_[i] = static_cast<float>(kCutoffHz * older_[i]);
    glide(Place::resonance, std::span(lengths_).first(n));
    for (std::size_t i = 0; i < n; ++i) resonances_[i] = static_cast<float>(lengths_[i]);
  }

  void filter(const Filtering& how, std::size_t channel, std::size_t which,
              Floats& out) KNOTWAVE_RT {
    const std::size_t n = part_size();
    const auto in = input(channel);
    if (!how.is_on) {
      std::copy(in.begin(), in.end(), out.begin());
      return;
    }
    filters_[channel][which].render(how.kind, rate_hz(), std::span(cutoffs_).first(n),
                                    std::span(resonances_).first(n), in, std::span(out).first(n));
  }

  void render_part() KNOTWAVE_RT override {
    const std::size_t n = part_size();
    const auto part = [n](Doubles& values) { return std::span(values).first(n); };
    place_each();
    follow_curve();
    const bool fades = !filtering_.is_still();
    if (fades || filtering_.to().is_on) follow_cutoff();
    if (fades) filtering_.weights(now(), part(weights_));
    glide(Place::gain, part(gains_));
    glide(Place::pan, part(pans_));
    glide(Place::mix, part(mixes_));
    glide(Place::output, part(levels_));
    for (std::size_t i = 0; i < n; ++i) {
      gains_[i] = 1 + gains_[i] * (values_[i] - 1);
      pans_[i] *= 2 * values_[i] - 1;
    }
    const double level = base::db_to_gain(levels_[0]);
    const bool is_level = is_still(Place::output);
    for (std::size_t i = 0; i < n; ++i)
      levels_[i] = is_level ? level : base::db_to_gain(levels_[i]);
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      filter(filtering_.to(), channel, newest_filter_, filtered_);
      if (fades) filter(filtering_.from(), channel, 1 - newest_filter_, faded_);
      const double side = channel == 0 ? -1 : 1;
      const auto in = input(channel);
      const auto out = output(channel);
      for (std::size_t i = 0; i < n; ++i) {
        double wet = static_cast<double>(filtered_[i]);
        if (fades) wet = weights_[i] * wet + (1 - weights_[i]) * static_cast<double>(faded_[i]);
        wet *= gains_[i] * std::min(1.0, 1 + side * pans_[i]);
        const double dry = static_cast<double>(in[i]);
        out[i] = static_cast<float>(levels_[i] * (mixes_[i] * wet + (1 - mixes_[i]) * dry));
      }
    }
  }

  std::span<const CurveProgram> shipped_;
  const Own* own_ = nullptr;
  Exchange<CurveProgram> cycle_;
  Exchange<Filtering> filtering_;
  std::array<std::array<dsp::StateVariableFilter, 2>, kChannels> filters_;  ///< of two kinds
  std::size_t newest_filter_ = 0;  ///< of filtering_.to(); the other is of filtering_.from()
  double origin_ = 0;              ///< quarter notes, of the last note
  bool has_note_ = false;
  bool is_fresh_ = true;  ///< nothing to be smoothed yet
  double smoothed_ = 0;

  // Of a part.
  Doubles places_{}, values_{}, older_{}, read_{}, weights_{}, lengths_{}, phases_{};
  Doubles gains_{}, pans_{}, mixes_{}, levels_{};
  Floats cutoffs_{}, resonances_{}, filtered_{}, faded_{};
};

}  // namespace

const PluginInfo& curve_info() {
  static constexpr AudioPort kInputs[] = {{"Input", 2}};
  static constexpr AudioPort kOutputs[] = {{"Output", 2}};
  static const std::vector<std::string> presets = preset_names(effect_presets("curve"));
  static const PluginInfo info = [] {
    PluginInfo all;
    all.key = "curve";
    all.name = "Knotwave Curve";
    all.description = "A drawn curve along the bars of the song moves gain, filter and pan";
    all.inputs = kInputs;
    all.outputs = kOutputs;
    all.kind = PluginInfo::Kind::filter;
    all.takes_midi = true;
    all.parameters = &table();
    all.presets = presets;
    all.create = [] { return std::unique_ptr<Plugin>(std::make_unique<CurvePlugin>()); };
    return all;
  }();
  return info;
}

}  // namespace knotwave::plugins
