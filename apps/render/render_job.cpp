// SPDX-License-Identifier: MIT
// The render loop. What it hands to the engine depends on --block, what comes out does not.
#include "render_job.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "knotwave/engine/engine.h"

#include "missing_patches.h"
#include "output_places.h"
#include "progress.h"
#include "song/event_feed.h"
#include "sound_sink.h"

namespace knotwave::render {
namespace {

namespace fs = std::filesystem;
constexpr double kLongestAutoTailSeconds = 30;
/// Silence is looked for on this grid of samples after the song's end, whatever the block size, so
/// that --block does not decide where the file ends.
constexpr std::int64_t kTailGridFrames = 1024;

std::string seconds_text(double seconds) { return fixed(seconds, 1) + " s"; }

class RenderJob {
 public:
  RenderJob(const RenderOptions& options, const RenderInput& input)
      : options_(options),
        input_(input),
        feed_(input.song, options.rate_hz),
        song_frames_(base::first_sample(feed_.end())) {}

  Result<RenderReport> run();

 private:
  Result<void> check_length() const;
  Result<void> open();
  Result<void> open_stems();
  Result<void> render_until(std::int64_t end);
  Result<void> render_block(std::int64_t frames);
  Result<void> render_tail();
  Result<void> finish();
  RenderReport report(double elapsed_s) const;
  void add_closing_warnings(RenderReport& report) const;

  io::SoundWriteConfig sink_config(const std::string& path, std::uint64_t seed) const;
  std::int64_t frames_of(double seconds) const {
    return static_cast<std::int64_t>(std::floor(seconds * options_.rate_hz + 0.5));
  }
  std::int64_t longest_tail() const {
    return options_.tail_s ? frames_of(*options_.tail_s) : frames_of(kLongestAutoTailSeconds);
  }

  const RenderOptions& options_;
  const RenderInput& input_;
  song::EventFeed feed_;
  std::int64_t song_frames_;
  std::unique_ptr<engine::Engine> engine_;
  std::vector<float> left_, right_;
  std::optional<SoundSink> mix_;
  std::array<std::optional<SoundSink>, kMidiChannels> stems_;
  std::vector<float> stem_samples_;  ///< [channel][left, right][block]
  std::vector<engine::Engine::Stem> stem_buffers_;
  std::optional<Progress> progress_;
  bool still_sounding_ = false;
};

Result<RenderReport> RenderJob::run() {
  if (auto good = check_length(); !good) return good.error();
  if (auto good = open(); !good) return good.error();
  const auto start = std::chrono::steady_clock::now();
  progress_.emplace(!options_.quiet);
  if (auto good = render_until(song_frames_); !good) return good.error();
  if (auto good = render_tail(); !good) return good.error();
  if (auto good = finish(); !good) return good.error();
  progress_.reset();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return report(elapsed.count());
}

Result<void> RenderJob::check_length() const {
  const double seconds =
      static_cast<double>(song_frames_) / options_.rate_hz + options_.tail_s.value_or(0);
  if (seconds <= options_.max_length_s) return {};
  Error error = fail(ErrorCode::value_out_of_range, "the song lasts " + seconds_text(seconds) +
                                                        "; --max-length allows " +
                                                        seconds_text(options_.max_length_s));
  error.source = input_.score_name;
  return error;
}

io::SoundWriteConfig RenderJob::sink_config(const std::string& path, std::uint64_t seed) const {
  return {.path = path,
          .rate_hz = options_.rate_hz,
          .channels = 2,
          .format = options_.format,
          .expected_frames = song_frames_ + longest_tail() + kTailGridFrames,
          .dither_seed = seed};
}

Result<void> RenderJob::open() {
  auto engine = engine::Engine::create({.rate_hz = static_cast<double>(options_.rate_hz),
                                        .seed = options_.seed,
                                        .threads = options_.threads},
                                       input_.bank.get());
  if (!engine) return std::move(engine).error();
  engine_ = std::move(engine).value();
  auto mix = SoundSink::create(sink_config(options_.output, options_.seed));
  if (!mix) return std::move(mix).error();
  mix_.emplace(std::move(mix).value());
  left_.resize(static_cast<std::size_t>(options_.block_frames));
  right_.resize(left_.size());
  return options_.stems.empty() ? Result<void>{} : open_stems();
}

/// One file for each channel that plays a note, dithered apart from each other and from the mix.
Result<void> RenderJob::open_stems() {
  std::error_code code;
  fs::create_directories(options_.stems, code);
  if (code) {
    return fail(ErrorCode::io_failed,
                "cannot make the folder '" + options_.stems + "': " + code.message());
  }
  stem_samples_.resize(2 * std::size_t{kMidiChannels} * left_.size());
  for (int channel = 0; channel < kMidiChannels; ++channel) {
    if ((feed_.channels() >> channel & 1) == 0) continue;
    const std::uint64_t seed = options_.seed + static_cast<std::uint64_t>(channel) + 1;
    auto sink = SoundSink::create(sink_config(stem_path(options_, channel), seed));
    if (!sink) return std::move(sink).error();
    stems_[static_cast<std::size_t>(channel)].emplace(std::move(sink).value());
  }
  return {};
}

Result<void> RenderJob::render_until(std::int64_t end) {
  while (engine_->now() < end) {
    const auto block = static_cast<std::int64_t>(options_.block_frames);
    if (auto good = render_block(std::min(block, end - engine_->now())); !good) return good;
    const double rate_hz = options_.rate_hz;
    progress_->show(static_cast<double>(engine_->now()) / rate_hz,
                    static_cast<double>(std::max(song_frames_, end)) / rate_hz);
  }
  return {};
}

Result<void> RenderJob::render_block(std::int64_t frames) {
  const auto count = static_cast<std::size_t>(frames);
  const auto events = feed_.before(engine_->now() + frames);
  const auto left = std::span(left_).first(count);
  const auto right = std::span(right_).first(count);
  if (stem_samples_.empty()) {
    engine_->process(events, left, right);
    return mix_->add(left, right);
  }
  stem_buffers_.clear();
  for (std::size_t channel = 0; channel < kMidiChannels; ++channel) {
    const std::span<float> both = std::span(stem_samples_).subspan(2 * channel * left_.size());
    stem_buffers_.push_back({both.first(count), both.subspan(left_.size(), count)});
  }
  engine_->process(events, left, right, stem_buffers_);
  for (std::size_t channel = 0; channel < kMidiChannels; ++channel) {
    if (!stems_[channel]) continue;
    const auto& stem = stem_buffers_[channel];
    if (auto good = stems_[channel]->add(stem.left, stem.right); !good) return good;
  }
  return mix_->add(left, right);
}

Result<void> RenderJob::render_tail() {
  const std::int64_t last = song_frames_ + longest_tail();
  if (options_.tail_s) return render_until(last);
  do {
    if (auto good = render_until(std::min(engine_->now() + kTailGridFrames, last)); !good) {
      return good;
    }
  } while (!engine_->is_idle() && engine_->now() < last);
  still_sounding_ = !engine_->is_idle();
  return {};
}

Result<void> RenderJob::finish() {
  for (auto& stem : stems_) {
    if (!stem) continue;
    if (auto good = stem->finish(); !good) return good;
  }
  return mix_->finish();
}

RenderReport RenderJob::report(double elapsed_s) const {
  const engine::EngineCounters& counters = engine_->counters();
  RenderReport report;
  report.path = mix_->path();
  report.frames = mix_->frames();
  report.rate_hz = options_.rate_hz;
  report.peak_dbfs = mix_->levels().peak_dbfs();
  report.rms_dbfs = mix_->levels().rms_dbfs();
  report.seed = options_.seed;
  report.sha256 = mix_->sha256();
  report.sha256_file = mix_->writer().file_sha256();
  report.realtime_factor = elapsed_s > 0 ? report.seconds() / elapsed_s : 0;
  report.voices_peak = counters.voices_peak;
  report.voices_stolen = counters.voices_stolen;
  report.notes_without_patch = counters.notes_without_patch;
  report.clipped_samples = mix_->writer().clipped();
  for (int channel = 0; channel < kMidiChannels; ++channel) {
    const auto& stem = stems_[static_cast<std::size_t>(channel)];
    if (!stem) continue;
    report.stems.push_back({stem->path(), channel + 1, stem->sha256(), stem->writer().file_sha256(),
                            stem->levels().peak_dbfs()});
  }
  report.warnings = input_.warnings;
  add_closing_warnings(report);
  return report;
}

void RenderJob::add_closing_warnings(RenderReport& report) const {
  const engine::EngineCounters& counters = engine_->counters();
  const auto add = [&](const std::string& what) {
    report.warnings.push_back(report.path + ": warning: " + what);
  };
  if (still_sounding_) {
    add("the sound was cut " + seconds_text(kLongestAutoTailSeconds) + " after the song's end");
  }
  if (report.clipped_samples > 0) {
    add(std::to_string(report.clipped_samples) +
        " samples were beyond full scale and are clipped; lower a gain_db or use --bits 32f");
  }
  if (counters.notes_dropped > 0) {
    add(std::to_string(counters.notes_dropped) + " notes found no voice and are missing");
  }
  if (const std::string what = missing_patches(counters); !what.empty()) {
    report.warnings.push_back(input_.score_name + ": warning: " + what);
  }
}

}  // namespace

Result<RenderReport> render(const RenderOptions& options, const RenderInput& input) {
  return RenderJob(options, input).run();
}

}  // namespace knotwave::render
