// SPDX-License-Identifier: MIT
#include "knotwave/engine/tuning.h"

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"
#include "knotwave/base/file.h"

namespace knotwave::engine {
namespace {

std::string tuning_file(const std::string& name) {
  const auto text = base::read_file(KNOTWAVE_SOURCE_DIR "/examples/tunings/" + name, 1 << 20);
  EXPECT_TRUE(text) << text.error().to_string();
  return text ? *text : "";
}

Tuning from_files(const std::string& scl, const std::string& kbm = "") {
  const auto tuning = Tuning::create(scl.empty() ? "" : tuning_file(scl), scl,
                                     kbm.empty() ? "" : tuning_file(kbm), kbm);
  EXPECT_TRUE(tuning) << tuning.error().to_string();
  return tuning ? *tuning : Tuning();
}

std::string scl_error(const std::string& text) {
  const auto tuning = Tuning::create(text, "x.scl", "", "");
  return tuning ? "no error" : tuning.error().to_string();
}
std::string kbm_error(const std::string& text) {
  const auto tuning = Tuning::create("", "", text, "x.kbm");
  return tuning ? "no error" : tuning.error().to_string();
}

constexpr const char* kEqualTwelve =
    "! twelve.scl\n12-TET\n 12\n100.\n200.\n300.\n400.\n500.\n600.\n700.\n800.\n900.\n1000.\n"
    "1100.0\n2/1\n";

TEST(Tuning, WithoutFilesANoteIsItsOwnPitchToTheBit) {
  const Tuning tuning;
  for (int note = 0; note < 128; ++note) {
    EXPECT_EQ(tuning.midi_pitch(note), note);
    EXPECT_TRUE(tuning.is_mapped(note));
  }
  EXPECT_EQ(tuning.hz(69), 440.0);
  EXPECT_EQ(tuning.midi_pitch(60.25), 60.25);
}

TEST(Tuning, AScaleOfHundredsOfCentsIsTwelveToneEqualTemperamentToTheBit) {
  const auto tuning = Tuning::create(kEqualTwelve, "twelve.scl", "", "");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  for (int note = 0; note < 128; ++note) EXPECT_EQ(tuning->midi_pitch(note), note);
}

TEST(Tuning, JustIntonationHasItsRatiosAboveEveryC) {
  const Tuning tuning = from_files("just.scl", "c_261.kbm");
  const double ratios[] = {1,         16.0 / 15, 9.0 / 8, 6.0 / 5, 5.0 / 4, 4.0 / 3,
                           45.0 / 32, 3.0 / 2,   8.0 / 5, 5.0 / 3, 9.0 / 5, 15.0 / 8};
  for (int note = 0; note < 128; ++note) {
    const double octave = std::ldexp(1.0, (note + 12 * 20 - 60) / 12 - 20);
    const double expected = 261.6255653005986 * octave * ratios[(note + 12 * 20 - 60) % 12];
    EXPECT_NEAR(tuning.hz(note) / expected, 1, 1e-14) << note;
  }
}

TEST(Tuning, PythagoreanFifthsArePure) {
  const Tuning tuning = from_files("pythagorean.scl");
  EXPECT_EQ(tuning.hz(69), 440);
  for (const int note : {60, 62, 64, 65, 67, 69, 71}) {
    if (note == 71) continue;  // B to F sharp leaves the chain by a comma's spelling
    EXPECT_NEAR(tuning.hz(note + 7) / tuning.hz(note), 1.5, 2e-14) << note;
  }
}

TEST(Tuning, NineteenEqualStepsMakeAnOctave) {
  const Tuning tuning = from_files("19-edo.scl");
  EXPECT_EQ(tuning.hz(69), 440);
  EXPECT_NEAR(tuning.hz(69 + 19), 880, 1e-11);
  for (int note = 0; note < 127; ++note) {
    EXPECT_NEAR(tuning.midi_pitch(note + 1) - tuning.midi_pitch(note), 12.0 / 19, 1e-10) << note;
  }
}

TEST(Tuning, BohlenPierceRepeatsAtTheTwelfth) {
  const Tuning tuning = from_files("bohlen-pierce.scl");
  for (int note = 0; note + 13 < 128; ++note) {
    EXPECT_NEAR(tuning.hz(note + 13) / tuning.hz(note), 3, 4e-14) << note;
  }
  EXPECT_NEAR(tuning.hz(60 + 6) / tuning.hz(60), 5.0 / 3, 2e-14);
}

TEST(Tuning, AMappingLeavesKeysOutAndTheySoundAsTheNeighbourBelow) {
  // A seven-note scale on the white keys.
  const char* kbm = "12\n0\n127\n60\n60\n264\n7\n0\nx\n1\nx\n2\n3\nx\n4\nx\n5\nx\n6\n";
  const auto tuning =
      Tuning::create("white\n7\n9/8\n5/4\n4/3\n3/2\n5/3\n15/8\n2\n", "w.scl", kbm, "w.kbm");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_NEAR(tuning->hz(69), 440, 1e-12);
  EXPECT_NEAR(tuning->hz(72), 528, 1e-12);
  EXPECT_NEAR(tuning->hz(36), 66, 1e-12);
  EXPECT_FALSE(tuning->is_mapped(61));
  EXPECT_TRUE(tuning->is_mapped(62));
  EXPECT_EQ(tuning->midi_pitch(61), tuning->midi_pitch(60));
  EXPECT_FALSE(tuning->is_mapped(1));
  EXPECT_EQ(tuning->midi_pitch(1), tuning->midi_pitch(0));
}

TEST(Tuning, KeysBeforeTheFirstMappedOneSoundAsThatOne) {
  const auto tuning = Tuning::create("", "", "3\n0\n127\n2\n2\n440\n12\n0\nx\nx\n", "k.kbm");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_FALSE(tuning->is_mapped(0));
  EXPECT_EQ(tuning->midi_pitch(0), tuning->midi_pitch(2));
  EXPECT_EQ(tuning->hz(2), 440);
}

TEST(Tuning, NotesOutsideTheMappedRangeStayInTwelveToneEqualTemperament) {
  const auto tuning = Tuning::create("", "", "0\n60\n71\n60\n69\n432\n12\n", "k.kbm");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_EQ(tuning->midi_pitch(59), 59);
  EXPECT_EQ(tuning->midi_pitch(72), 72);
  EXPECT_NEAR(tuning->hz(69), 432, 1e-12);
}

TEST(Tuning, TheFormalOctaveIsTheStepBetweenPatterns) {
  // Seven keys in a pattern, the pattern repeats a fifth up.
  const auto tuning = Tuning::create(kEqualTwelve, "t.scl",
                                     "7\n0\n127\n60\n60\n440\n7\n0\n1\n2\n3\n4\n5\n6\n", "k.kbm");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_EQ(tuning->midi_pitch(60), 69);
  EXPECT_EQ(tuning->midi_pitch(67), 76);
  EXPECT_EQ(tuning->midi_pitch(53), 62);
}

TEST(Tuning, TrailingKeysOfAMappingMayBeLeftOut) {
  const auto tuning = Tuning::create("", "", "12\n0\n127\n60\n60\n440\n12\n0\n1\n2\n", "k.kbm");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_TRUE(tuning->is_mapped(62));
  EXPECT_FALSE(tuning->is_mapped(63));
}

TEST(Tuning, FractionalNotesLieBetweenTheirNeighboursAndEveryInputHasAnOutput) {
  const Tuning tuning = from_files("bohlen-pierce.scl");
  EXPECT_NEAR(tuning.midi_pitch(60.5), (tuning.midi_pitch(60) + tuning.midi_pitch(61)) / 2, 1e-12);
  EXPECT_EQ(tuning.midi_pitch(-3), tuning.midi_pitch(0) - 3);
  EXPECT_EQ(tuning.midi_pitch(130), tuning.midi_pitch(127) + 3);
  EXPECT_EQ(tuning.midi_pitch(std::numeric_limits<double>::quiet_NaN()), tuning.midi_pitch(0));
  EXPECT_FALSE(tuning.is_mapped(-1));
  EXPECT_FALSE(tuning.is_mapped(128));
}

TEST(Tuning, CoherentFrequenciesAreMetWithinOnePartInTenToTheFourteen) {
  // tools/make_coherent_tuning.py: note n sounds at odd k[n] * 48000 / 65536 Hz.
  const Tuning tuning = from_files("coherent_48000.scl", "coherent_48000.kbm");
  const double step = 48000.0 / 65536;
  for (int note = 0; note < 128; ++note) {
    const double nominal = base::note_to_hz(note) / step;
    const double k = 2 * std::floor(nominal / 2) + 1;  // the odd number on nominal's side
    EXPECT_NEAR(tuning.hz(note) / (k * step), 1, 1e-14) << note;
  }
}

TEST(Tuning, CommentsBlankDescriptionsLineEndsAndTrailingTextAreAccepted) {
  const auto tuning = Tuning::create(
      "\xEF\xBB\xBF! a comment\r\n\r\n! another\r\n 2 notes\r\n\t701.955 a fifth\r\n2/1 octave\r\n"
      "the end\r\n",
      "x.scl", "", "");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_NEAR(tuning->midi_pitch(71) - tuning->midi_pitch(69), 12, 1e-12);
}

TEST(Tuning, AScaleOfNoNotesIsOnePitch) {
  const auto tuning = Tuning::create("one\n0\n", "x.scl", "", "");
  ASSERT_TRUE(tuning) << tuning.error().to_string();
  EXPECT_EQ(tuning->hz(0), 440);
  EXPECT_EQ(tuning->hz(127), 440);
}

TEST(Tuning, FaultsOfAScaleAreNamedWithLineAndColumn) {
  EXPECT_EQ(scl_error("\n"), "x.scl:1:1: error: the file ends before the number of notes");
  EXPECT_EQ(scl_error("! only\n! comments\n"),
            "x.scl:1:1: error: the file ends before the line that describes the scale");
  EXPECT_EQ(scl_error("d\ntwo\n"),
            "x.scl:2:1: error: 'two' is no whole number (the number of notes is expected)");
  EXPECT_EQ(scl_error("d\n-1\n"),
            "x.scl:2:1: error: the number of notes is -1, allowed are 0 to 4096");
  EXPECT_EQ(scl_error("d\n3\n100.\n! c\n 2/1\n"),
            "x.scl:5:2: error: the file ends before note 3 of 3");
  EXPECT_EQ(scl_error("d\n1\n100.\n200.\n"),
            "x.scl:4:1: error: the scale has 1 notes, here is one more");
  EXPECT_EQ(scl_error("d\n1\n -3/2\n"), "x.scl:3:2: error: the ratio '-3/2' is not positive");
  EXPECT_EQ(scl_error("d\n1\n3/0\n"), "x.scl:3:1: error: the ratio '3/0' is not positive");
  EXPECT_EQ(scl_error("d\n1\n3/2/1\n"),
            "x.scl:3:1: error: '3/2/1' is neither cents (with a '.') nor a ratio such as 3/2");
  EXPECT_EQ(scl_error("d\n1\n1.2.3\n"), "x.scl:3:1: error: '1.2.3' is no number of cents");
  EXPECT_EQ(scl_error("d\n1\n.nan\n"), "x.scl:3:1: error: '.nan' is no number of cents");
  EXPECT_EQ(scl_error("d\n1\n1.e9\n"), "x.scl:3:1: error: '1.e9' cents is more than 100 octaves");
  EXPECT_EQ(scl_error("d\n1\n12000.\n"),
            "x.scl:3:1: error: note 0 would be -690 octaves from A4, the limit is 100");
}

TEST(Tuning, FaultsOfAMappingAreNamedWithLineAndColumn) {
  EXPECT_EQ(kbm_error("12\n0\n127\n60\n69\n0\n12\n"),
            "x.kbm:6:1: error: the reference frequency is 0 Hz, allowed are 0.001 to 1000000 Hz");
  EXPECT_EQ(kbm_error("12\n0\n128\n"),
            "x.kbm:3:1: error: the last note is 128, allowed are 0 to 127");
  EXPECT_EQ(kbm_error("12\n60\n50\n"),
            "x.kbm:3:1: error: the last note is 50, allowed are 60 to 127");
  EXPECT_EQ(kbm_error("12\n0\n127\n60\n69\nA4\n"), "x.kbm:6:1: error: 'A4' is no frequency in Hz");
  EXPECT_EQ(kbm_error("12\n0\n127\n"), "x.kbm:3:1: error: the file ends before the middle note");
  EXPECT_EQ(kbm_error("2\n0\n127\n60\n60\n440\n12\n0\n1\n2\n"),
            "x.kbm:10:1: error: the mapping has 2 keys, here is one more");
  EXPECT_EQ(kbm_error("2\n0\n127\n60\n60\n440\n12\n0\ny\n"),
            "x.kbm:9:1: error: 'y' is neither a scale degree nor 'x' (unmapped)");
  EXPECT_EQ(kbm_error("2\n0\n127\n60\n61\n440\n12\n0\nx\n"),
            "x.kbm:5:1: error: the reference note 61 is unmapped ('x'), so nothing has a pitch");
}

}  // namespace
}  // namespace knotwave::engine
