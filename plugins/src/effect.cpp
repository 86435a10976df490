// SPDX-License-Identifier: MIT
// An effect's blocks; its text is in effect_state.cpp.
#include "knotwave/plugins/effect.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/fit_input.h"
#include "knotwave/base/fp_state.h"

namespace knotwave::plugins {
namespace {

constexpr double kLowestRate = 8000, kHighestRate = 768000;
constexpr float kQuiet = 1e-6F;

/// So many as compilers know, and nothing else is there: they make vectors of it.
void fit_part(const float* __restrict from, float* __restrict to) KNOTWAVE_RT {
  for (std::size_t i = 0; i < Effect::kPart; ++i) to[i] = base::fit_input(from[i]);
}

std::size_t channels(std::span<const AudioPort> ports) {
  std::size_t all = 0;
  for (const AudioPort& port : ports) all += static_cast<std::size_t>(port.channels);
  return all;
}

}  // namespace

Effect::Effect(const PluginInfo& info, std::span<const OwnCurve> own)
    : info_(&info),
      own_(own),
      values_(*info.parameters),
      glides_(info.parameters->size()),
      inputs_(channels(info.inputs)),
      outputs_(channels(info.outputs)) {}

Effect::~Effect() {
  if (leaving_ != nullptr) curves_.release(leaving_);
  if (playing_ != nullptr) curves_.release(playing_);
}

Result<void> Effect::activate(double rate_hz) {
  if (!(rate_hz >= kLowestRate && rate_hz <= kHighestRate)) {
    return fail(ErrorCode::value_out_of_range,
                "the rate is " + base::number_text(rate_hz) + " Hz; it must be in 8000 to 768000");
  }
  if (playing_ == nullptr && curves_.objects_out() == 0) {
    auto compiled = compile(own_curves_);
    if (!compiled) return compiled.error();
    curves_.publish(*std::move(compiled));
  }
  rate_hz_ = rate_hz;
  glide_samples_ = std::max(1, static_cast<int>(std::floor(kGlideSeconds * rate_hz + 0.5)));
  if (leaving_ != nullptr) curves_.release(leaving_);
  leaving_ = nullptr;
  take_curves();
  values_.forget_heard();
  values_.take_news([](std::size_t, double) {});
  start();
  is_active_ = true;
  return {};
}

/// From here on as if new, with the parameters and curves there are.
void Effect::start() KNOTWAVE_RT {
  now_ = 0;
  quiet_samples_ = 0;
  song_.reset(rate_hz_);
  for (std::size_t place = 0; place < glides_.size(); ++place) {
    glides_[place].reset(values_.heard(place), glide_samples_);
  }
  clear(*playing_);
  if (leaving_ != nullptr) curves_.release(leaving_);
  leaving_ = nullptr;
}

void Effect::reset() KNOTWAVE_RT { start(); }

void Effect::set_parameter(std::size_t place, double value) KNOTWAVE_RT {
  values_.set(place, value);
}
double Effect::parameter(std::size_t place) const KNOTWAVE_RT { return values_.get(place); }

void Effect::change(std::size_t place, double value) KNOTWAVE_RT {
  glides_[place].set_target(value, now_);
  if (!(*info_->parameters)[place].choices.empty()) choose(place, static_cast<int>(value));
}

/// The newest curves there are. One set leaves at a time: the next waits for it.
bool Effect::take_curves() KNOTWAVE_RT {
  if (leaving_ != nullptr) {
    if (uses(*leaving_)) return false;
    curves_.release(leaving_);
    leaving_ = nullptr;
  }
  const Compiled* newest = nullptr;
  while (const Compiled* next = curves_.acquire()) {
    if (newest != nullptr) curves_.release(newest);
    newest = next;
  }
  if (newest == nullptr) return false;
  leaving_ = playing_;
  playing_ = newest;
  return true;
}

void Effect::begin(const Block& block) KNOTWAVE_RT {
  block_ = block;
  done_ = 0;
  if (take_curves()) install(*playing_);
  values_.take_news([this](std::size_t place, double value) { change(place, value); });
}

void Effect::glide(std::size_t place, PartValues& out) const KNOTWAVE_RT {
  const dsp::Smoother& glide = glides_[place];
  if (glide.is_still(now_)) return out.fill(glide.target());
  out.is_one = false;
  glide.render(now_, std::span(out.at).first(part_size_));
}

void Effect::glide_gain(std::size_t place, PartGains& out) const KNOTWAVE_RT {
  const bool was_one = out.db.is_one && out.gain.is_one;
  const double before = out.db.at[0];
  glide(place, out.db);
  if (out.db.is_one) {
    if (!was_one || before != out.db.at[0]) out.gain.fill(base::db_to_gain(out.db.at[0]));
    return;
  }
  out.gain.is_one = false;
  for (std::size_t i = 0; i < part_size_; ++i) out.gain.at[i] = base::db_to_gain(out.db.at[i]);
}

void Effect::add(const engine::Event& event) KNOTWAVE_RT {
  render_until(event.time().sample);
  hear(event);
}

void Effect::add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT {
  if (place >= glides_.size()) return;
  render_until(sample);
  change(place, values_.set_heard(place, value));
}

void Effect::add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT {
  render_until(sample);
  Song there = song_;
  if (there.follow(transport, now_)) jump(there);
  song_ = there;
}

void Effect::render() KNOTWAVE_RT { render_until(static_cast<std::int64_t>(block_.frames)); }

void Effect::render_until(std::int64_t sample) KNOTWAVE_RT {
  const auto end = static_cast<std::size_t>(
      std::clamp<std::int64_t>(sample, 0, static_cast<std::int64_t>(block_.frames)));
  if (end <= done_) return;
  const base::FpStateGuard fp_state;
  while (done_ < end) {
    part_size_ = std::min({begin_part(), kPart, end - done_});
    read_inputs();
    render_part();
    write_outputs();
    done_ += part_size_;
    now_ += static_cast<std::int64_t>(part_size_);
  }
}

void Effect::read_inputs() KNOTWAVE_RT {
  for (std::size_t channel = 0; channel < inputs_; ++channel) {
    const float* const from = channel < block_.in.size() ? block_.in[channel] : nullptr;
    std::array<float, kPart>& in = in_[channel];
    if (from == nullptr) {
      std::fill_n(in.begin(), part_size_, 0.0F);
      continue;
    }
    if (part_size_ == kPart) {
      fit_part(from + done_, in.data());
    } else {
      for (std::size_t i = 0; i < part_size_; ++i) in[i] = base::fit_input(from[done_ + i]);
    }
  }
}

void Effect::write_outputs() KNOTWAVE_RT {
  std::size_t quiet = part_size_;  // at the part's end
  const auto stop_at = [&](const std::array<float, kPart>& samples, float limit) {
    std::size_t here = 0;
    while (here < quiet && std::abs(samples[part_size_ - 1 - here]) <= limit) ++here;
    quiet = here;
  };
  for (std::size_t channel = 0; channel < inputs_; ++channel) stop_at(in_[channel], 0);
  for (std::size_t channel = 0; channel < outputs_; ++channel) {
    stop_at(out_[channel], kQuiet);
    float* const to = channel < block_.out.size() ? block_.out[channel] : nullptr;
    if (to != nullptr) std::copy_n(out_[channel].begin(), part_size_, to + done_);
  }
  const auto samples = static_cast<std::int64_t>(quiet);
  quiet_samples_ = quiet == part_size_ ? quiet_samples_ + samples : samples;
}

}  // namespace knotwave::plugins
