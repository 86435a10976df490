// SPDX-License-Identifier: MIT
#include "report.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command_line/json.h"
#include "progress.h"

namespace knotwave::render {
namespace {

using testing::HasSubstr;
using testing::Not;

RenderReport example() {
  RenderReport report;
  report.path = "out.wav";
  report.frames = 384000;
  report.rate_hz = 48000;
  report.peak_dbfs = -6.0206;
  report.rms_dbfs = -20.5;
  report.seed = 7;
  report.sha256 = "ab12";
  report.sha256_file = "cd34";
  report.realtime_factor = 41.25;
  report.voices_peak = 12;
  return report;
}

TEST(RenderReport, OneLineSaysAll) {
  EXPECT_EQ(report_line(example()),
            "out.wav: 8.000 s, 48000 Hz, 2 channels, peak -6.02 dBFS, rms -20.50 dBFS, seed 7, "
            "sha256 ab12, 41.2 times real time");
}

TEST(RenderReport, TheLineSaysHowManyNotesTheBankHasNoPatchFor) {
  RenderReport report = example();
  report.notes_without_patch = 3;
  EXPECT_THAT(report_line(report), HasSubstr("41.2 times real time, 3 notes without a patch"));
}

TEST(RenderReport, SilenceIsMinusInfinityAndNullInJson) {
  RenderReport report = example();
  report.peak_dbfs = report.rms_dbfs = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(report_line(report), HasSubstr("peak -inf dBFS, rms -inf dBFS"));
  EXPECT_THAT(report_json(report), HasSubstr("\"peak_dbfs\": null"));
}

TEST(JsonNumber, HasNoInfinityAndNoNan) {
  using Limits = std::numeric_limits<double>;
  for (const double none :
       {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN()}) {
    EXPECT_EQ(command_line::json_number(none), "null");
    RenderReport report = example();
    report.peak_dbfs = report.rms_dbfs = report.realtime_factor = none;
    EXPECT_THAT(report_json(report), Not(HasSubstr("inf")));
    EXPECT_THAT(report_json(report), Not(HasSubstr("nan")));
  }
  EXPECT_EQ(command_line::json_number(0.1), "0.10000000000000001");
  EXPECT_EQ(command_line::json_number(-Limits::max()), "-1.7976931348623157e+308");
  EXPECT_EQ(command_line::json_number(Limits::denorm_min()), "4.9406564584124654e-324");
}

TEST(RenderReport, JsonHasItsKeysInOrder) {
  EXPECT_EQ(report_json(example()), R"({
  "path": "out.wav",
  "seconds": 8.000000,
  "frames": 384000,
  "rate_hz": 48000,
  "channels": 2,
  "peak_dbfs": -6.02,
  "rms_dbfs": -20.50,
  "seed": 7,
  "sha256": "ab12",
  "sha256_file": "cd34",
  "realtime_factor": 41.25,
  "voices_peak": 12,
  "voices_stolen": 0,
  "notes_without_patch": 0,
  "clipped_samples": 0,
  "stems": [],
  "warnings": []
}
)");
}

TEST(RenderReport, TextIsSafeInJsonAndOnATerminal) {
  RenderReport report = example();
  report.path = "a\"b\\c\x1b[31m\n.wav";
  EXPECT_THAT(report_json(report), HasSubstr("\"path\": \"a\\\"b\\\\c\\u001b[31m\\n.wav\""))
      << "nothing is lost";
  EXPECT_THAT(report_line(report), HasSubstr("c?[31m?.wav: "));
}

TEST(RenderReport, APipeHasNoFileHash) {
  RenderReport report = example();
  report.sha256_file.clear();
  EXPECT_THAT(report_json(report), HasSubstr("\"sha256_file\": null"));
}

TEST(Progress, TheLineShowsShareSpeedAndTimeLeft) {
  EXPECT_EQ(progress_line(15, 60, 0.5),
            "[=======>                      ]  25 %  15.0 of 60.0 s  30.0x  0:02 left");
  EXPECT_EQ(progress_line(60, 60, 130),
            "[==============================] 100 %  60.0 of 60.0 s  0.5x  0:00 left");
  EXPECT_THAT(progress_line(1, 100, 60), HasSubstr("99:00 left"));
  EXPECT_THAT(progress_line(0, 0, 0), HasSubstr("100 %"));
}

}  // namespace
}  // namespace knotwave::render
