// SPDX-License-Identifier: MIT
// Volts to samples.
#include "knotwave/engine/voltage_output.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"

namespace knotwave::engine {
namespace {

using base::Node;
using base::TableReader;

constexpr double kLeastFullScale = 0.01, kMostFullScale = 1000, kMostOffset = 1000;
constexpr double kLeastRampSeconds = 0.001, kMostRampSeconds = 60;

/// 0..1 along 3 t^2 - 2 t^3.
double risen(std::int64_t passed, std::int64_t samples) KNOTWAVE_RT {
  const double t = std::clamp(static_cast<double>(passed) / static_cast<double>(samples), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

bool is_full_scale(double volts) {
  return std::abs(volts) >= kLeastFullScale && std::abs(volts) <= kMostFullScale;
}

std::string full_scale_words(double volts) {
  return "volts_full_scale is " + base::number_text(volts) + "; " +
         base::number_text(kLeastFullScale) + " to " + base::number_text(kMostFullScale) +
         " V are possible, with a minus where the interface inverts";
}

VoltageChannel read_channel(TableReader& reader, const Node& table) {
  VoltageChannel channel;
  channel.volts_full_scale =
      reader.number("volts_full_scale", channel.volts_full_scale, -kMostFullScale, kMostFullScale);
  channel.offset_v = reader.number("offset_v", channel.offset_v, -kMostOffset, kMostOffset);
  if (!is_full_scale(channel.volts_full_scale)) {
    const Node* at = table.find("volts_full_scale");
    reader.fail_at(at == nullptr ? table : *at, ErrorCode::value_out_of_range,
                   full_scale_words(channel.volts_full_scale));
  }
  return channel;
}

}  // namespace

Result<std::vector<VoltageChannel>> parse_calibration(std::string_view text,
                                                      std::string_view source_name) {
  const auto root = base::parse_document(text, source_name);
  if (!root) return root.error();
  TableReader top(*root, source_name, "calibration file");
  if (top.required("format") != nullptr) top.integer("format", 1, 1, 1);
  if (const Node* kind = top.required("kind"); kind != nullptr) {
    if (top.string("kind") != "calibration") {
      top.fail_at(*kind, ErrorCode::unsupported,
                  "this file's kind is '" + kind->text +
                      "'; a calibration (kind = \"calibration\") is needed here");
    }
  }
  const Node* tables = top.array("channels");
  if (const auto fine = top.finish(); !fine) return fine.error();
  std::vector<VoltageChannel> channels;
  if (tables == nullptr) return channels;
  for (const Node& table : tables->items) {
    const std::string name = "channel " + std::to_string(channels.size() + 1);
    if (table.kind != Node::Kind::table) {
      Error error =
          fail(ErrorCode::wrong_type, "channels are tables; begin each with [[channels]]");
      error.source = source_name;
      error.line = table.line;
      error.column = table.column;
      return error;
    }
    TableReader reader(table, source_name, name);
    channels.push_back(read_channel(reader, table));
    if (const auto fine = reader.finish(); !fine) return fine.error();
  }
  return channels;
}

Result<VoltageOutput> VoltageOutput::create(const VoltageConfig& config, int channel) {
  const auto out_of_range = [](const std::string& words) {
    return fail(ErrorCode::value_out_of_range, words);
  };
  if (channel < 1) {
    return out_of_range("audio channel " + std::to_string(channel) + "; they count from 1");
  }
  if (!(config.rate_hz >= 8000 && config.rate_hz <= 768000)) {
    return out_of_range("the rate is " + base::number_text(config.rate_hz) +
                        " Hz; 8000 to 768000 are possible");
  }
  if (!(config.ramp_s >= kLeastRampSeconds && config.ramp_s <= kMostRampSeconds)) {
    return out_of_range("the ramp takes " + base::number_text(config.ramp_s) +
                        " s; 0.001 to 60 are possible");
  }
  VoltageOutput output;
  const auto index = static_cast<std::size_t>(channel - 1);
  if (index < config.channels.size()) output.channel_ = config.channels[index];
  if (!is_full_scale(output.channel_.volts_full_scale)) {
    return out_of_range("audio channel " + std::to_string(channel) + ": " +
                        full_scale_words(output.channel_.volts_full_scale));
  }
  if (!(std::abs(output.channel_.offset_v) <= kMostOffset)) {
    return out_of_range("audio channel " + std::to_string(channel) + " has an offset of " +
                        base::number_text(output.channel_.offset_v) +
                        " V; -1000 to 1000 are possible");
  }
  output.is_direct_ = config.direct_current;
  output.ramp_samples_ =
      static_cast<std::int64_t>(std::floor(config.ramp_s * config.rate_hz + 0.5));
  // The bilinear transform of s / (s + w), whose corner is at kProtectHz exactly.
  const auto [sin, cos] = base::sin_cos_cycles(0.5 * kProtectHz / config.rate_hz);
  output.coefficient_ = (cos - sin) / (cos + sin);
  return output;
}

double VoltageOutput::gain(std::int64_t sample) const KNOTWAVE_RT {
  const double in = risen(sample - ramp_in_from_, ramp_samples_);
  return is_ramping_out_ ? in * (1 - risen(sample - ramp_out_from_, ramp_samples_)) : in;
}

void VoltageOutput::render(std::int64_t first, std::span<const double> volts,
                           std::span<float> out) KNOTWAVE_RT {
  KNOTWAVE_ASSERT(volts.size() == out.size());
  if (!has_begun_) ramp_in_from_ = first;
  has_begun_ = true;
  for (std::size_t i = 0; i < volts.size(); ++i) {
    const double wanted = volts[i] == volts[i] ? volts[i] : 0;
    const double ramp = gain(first + static_cast<std::int64_t>(i));
    double sample = ramp * (wanted - channel_.offset_v) / channel_.volts_full_scale;
    if (!is_direct_) sample = protect(ramp * wanted / channel_.volts_full_scale);
    if (sample > 1 || sample < -1) ++clamped_;
    out[i] = static_cast<float>(std::clamp(sample, -1.0, 1.0));
  }
}

double VoltageOutput::protect(double in) KNOTWAVE_RT {
  const double inside = std::clamp(in, -1e6, 1e6);
  high_pass_ = base::snap_to_zero(coefficient_ * high_pass_ +
                                  0.5 * (1 + coefficient_) * (inside - last_in_));
  last_in_ = inside;
  return high_pass_;
}

void VoltageOutput::ramp_out(std::int64_t sample) KNOTWAVE_RT {
  if (is_ramping_out_) return;
  is_ramping_out_ = true;
  ramp_out_from_ = sample;
}

void VoltageOutput::begin_again() {
  has_begun_ = is_ramping_out_ = false;
  high_pass_ = last_in_ = 0;
}

bool VoltageOutput::is_silent(std::int64_t sample) const KNOTWAVE_RT {
  const bool is_still = is_direct_ || std::abs(high_pass_) < 0x1p-24;
  return is_ramping_out_ && sample >= ramp_out_from_ + ramp_samples_ && is_still;
}

}  // namespace knotwave::engine
