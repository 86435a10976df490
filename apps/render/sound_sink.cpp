// SPDX-License-Identifier: MIT
#include "sound_sink.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace knotwave::render {
namespace {

constexpr std::size_t kPendingSamples = 8192;

double decibels(double ratio) {
  return ratio > 0 ? 20 * std::log10(ratio) : -std::numeric_limits<double>::infinity();
}

}  // namespace

double Levels::peak_dbfs() const { return decibels(peak); }
double Levels::rms_dbfs() const {
  return samples > 0 ? decibels(std::sqrt(sum_of_squares / static_cast<double>(samples)))
                     : decibels(0);
}

SoundSink::SoundSink(std::string path, io::SoundWriter writer)
    : path_(std::move(path)), writer_(std::move(writer)) {}

Result<SoundSink> SoundSink::create(const io::SoundWriteConfig& config) {
  auto writer = io::SoundWriter::create(config);
  if (!writer) return std::move(writer).error();
  return SoundSink(config.path, std::move(writer).value());
}

Result<void> SoundSink::add(std::span<const float> left, std::span<const float> right) {
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (const float sample : {left[i], right[i]}) {
      const double x = static_cast<double>(sample);
      levels_.peak = std::max(levels_.peak, std::abs(x));
      levels_.sum_of_squares += x * x;
      pending_.push_back(sample);
    }
  }
  levels_.samples += 2 * static_cast<std::int64_t>(left.size());
  return pending_.size() < kPendingSamples ? Result<void>{} : flush();
}

Result<void> SoundSink::flush() {
  hash_.update(std::span<const float>(pending_));
  auto written = writer_.write(pending_);
  pending_.clear();
  return written;
}

Result<void> SoundSink::finish() {
  if (auto written = flush(); !written) return written;
  sha256_ = hash_.finish_hex();
  return writer_.finish();
}

}  // namespace knotwave::render
