// SPDX-License-Identifier: MIT
#include "render_journal.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "knotwave/base/document.h"

#include "progress.h"
#include "sound_sink.h"
#include "take/take.h"
#include "take/take_player.h"

namespace knotwave::render {
namespace {

Error about(Error error, const std::string& source) {
  if (error.source.empty()) error.source = source;
  return error;
}

Result<void> check(const engine::Journal& journal, const RenderOptions& options) {
  const auto rate_hz = static_cast<int>(std::clamp(journal.rate_hz, 0.0, 1e6));
  if (static_cast<double>(rate_hz) != journal.rate_hz || rate_hz < 8000 || rate_hz > 768000) {
    return fail(ErrorCode::value_out_of_range, "the take's rate is " +
                                                   base::number_text(journal.rate_hz) +
                                                   " Hz; it must be a whole number from 8000 to "
                                                   "768000");
  }
  const double seconds = static_cast<double>(journal.end) / journal.rate_hz;
  if (seconds <= options.max_length_s) return {};
  return fail(ErrorCode::value_out_of_range, "the take ends " + fixed(seconds, 1) +
                                                 " s after the start; --max-length allows " +
                                                 fixed(options.max_length_s, 1) + " s");
}

class JournalJob {
 public:
  JournalJob(const RenderOptions& options, const engine::Journal& journal, take::TakePlayer& player,
             SoundSink& sink)
      : options_(options), journal_(journal), player_(player), sink_(sink) {}

  /// Renders all and gives the hash of the take.
  Result<std::string> run() {
    Progress progress(!options_.quiet);
    std::vector<float> left(static_cast<std::size_t>(options_.block_frames)), right(left.size());
    while (player_.now() < journal_.end) {
      const std::int64_t from = player_.now();
      const auto n = std::min(left.size(), static_cast<std::size_t>(journal_.end - from));
      const auto out_left = std::span(left).first(n), out_right = std::span(right).first(n);
      if (auto good = player_.play(out_left, out_right); !good) return good.error();
      const std::int64_t before =
          std::clamp<std::int64_t>(journal_.first - from, 0, static_cast<std::int64_t>(n));
      if (auto good = keep(out_left.subspan(static_cast<std::size_t>(before)),
                           out_right.subspan(static_cast<std::size_t>(before)));
          !good)
        return good.error();
      progress.show(static_cast<double>(player_.now()) / journal_.rate_hz,
                    static_cast<double>(journal_.end) / journal_.rate_hz);
    }
    return hash_.finish_hex();
  }

 private:
  Result<void> keep(std::span<const float> left, std::span<const float> right) {
    interleaved_.clear();
    for (std::size_t i = 0; i < left.size(); ++i) {
      interleaved_.push_back(left[i]);
      interleaved_.push_back(right[i]);
    }
    hash_.update(std::span<const float>(interleaved_));
    return sink_.add(left, right);
  }

  const RenderOptions& options_;
  const engine::Journal& journal_;
  take::TakePlayer& player_;
  SoundSink& sink_;
  std::vector<float> interleaved_;
  base::Sha256 hash_;
};

RenderReport report_of(const engine::Journal& journal, const take::TakePlayer& player,
                       const SoundSink& sink) {
  RenderReport report;
  report.path = sink.path();
  report.frames = sink.frames();
  report.rate_hz = static_cast<int>(journal.rate_hz);
  report.peak_dbfs = sink.levels().peak_dbfs();
  report.rms_dbfs = sink.levels().rms_dbfs();
  report.seed = journal.seed;
  report.sha256 = sink.sha256();
  report.sha256_file = sink.writer().file_sha256();
  report.voices_peak = player.counters().voices_peak;
  report.voices_stolen = player.counters().voices_stolen;
  report.notes_without_patch = player.counters().notes_without_patch;
  report.clipped_samples = sink.writer().clipped();
  report.warnings = player.warnings();
  if (journal.sha256.empty()) {
    report.warnings.push_back(report.path +
                              ": warning: the journal has no hash of the take to compare with");
  }
  return report;
}

}  // namespace

Result<RenderReport> render_journal(const RenderOptions& options) {
  const auto journal = take::read_take(options.journal);
  if (!journal) return about(journal.error(), options.journal);
  if (auto good = check(*journal, options); !good) return about(good.error(), options.journal);
  auto player = take::TakePlayer::create(*journal, options.threads);
  if (!player) return about(player.error(), options.journal);
  auto sink = SoundSink::create({.path = options.output,
                                 .rate_hz = static_cast<int>(journal->rate_hz),
                                 .channels = 2,
                                 .format = options.format,
                                 .expected_frames = journal->end - journal->first,
                                 .dither_seed = journal->seed});
  if (!sink) return std::move(sink).error();
  const auto start = std::chrono::steady_clock::now();
  const auto hash = JournalJob(options, *journal, **player, *sink).run();
  if (!hash) return about(hash.error(), options.journal);
  if (!journal->sha256.empty() && *hash != journal->sha256) {
    return about(fail(ErrorCode::malformed, "the take does not sound as it did: its SHA-256 is " +
                                                *hash + ", the journal says " + journal->sha256),
                 options.journal);
  }
  if (auto good = sink->finish(); !good) return good.error();
  RenderReport report = report_of(*journal, **player, *sink);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  if (elapsed.count() > 0) report.realtime_factor = report.seconds() / elapsed.count();
  return report;
}

}  // namespace knotwave::render
