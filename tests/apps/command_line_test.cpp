// SPDX-License-Identifier: MIT
// Wrong command lines, each with the answer a user gets: what is wrong, what is allowed, and the
// nearest right word.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace {

using knotwave::support::run_program;
using testing::HasSubstr;

struct Wrong {
  std::vector<std::string> words;
  std::string answer;
};

void expect_usage_errors(const std::string& program, const std::vector<Wrong>& cases) {
  for (const Wrong& wrong : cases) {
    std::vector<std::string> words = wrong.words;
    words.insert(words.begin(), program);
    const auto done = run_program(words);
    EXPECT_EQ(done.exit_code, 2) << testing::PrintToString(words) << done.out << done.err;
    EXPECT_EQ(done.err, program + ": " + wrong.answer + "\nTry '" + program + " --help'.\n");
  }
}

/// With a patch, a score and an output, none of which is looked at.
std::vector<std::string> render_words(std::vector<std::string> more) {
  more.insert(more.begin(), {"a.toml", "a.mid", "-o", "a.wav"});
  return more;
}

TEST(RenderCommandLine, AWrongOptionIsNamedWithTheNearest) {
  expect_usage_errors(
      "knotwave-render",
      {
          {render_words({"--rat", "1"}), "unknown option '--rat'; did you mean '--rate'?"},
          {render_words({"--sed=3"}), "unknown option '--sed'; did you mean '--seed'?"},
          {render_words({"--QUIET"}), "unknown option '--QUIET'; did you mean '--quiet'?"},
          {render_words({"--max", "3"}), "unknown option '--max'; did you mean '--max-length'?"},
          {{"a.toml", "a.mid", "-output", "a.wav"},
           "unknown option '-output'; did you mean '--output'?"},
          {render_words({"-v"}), "unknown option '-v'"},
          {{"help"}, "'help' is no command; did you mean '--help'?"},
          {{"check", "a.toml", "a.mid"}, "'check' is no command; did you mean '--check'?"},
          {render_words({"b.mid"}),
           "'b.mid' is one word too many: PATCH and SCORE are given already"},
      });
}

TEST(RenderCommandLine, AMissingOrDoubleValueIsToldWithWhatIsWanted) {
  expect_usage_errors("knotwave-render",
                      {
                          {{"--demo", "-o", "a.wav"}, "--demo needs a value: NAME"},
                          {{"a.toml", "a.mid", "-o"}, "-o needs a value: FILE|-"},
                          {render_words({"--stems", ""}), "--stems needs a value: DIR"},
                          {render_words({"--stems="}), "--stems needs a value: DIR"},
                          {render_words({"--rate"}), "--rate needs a value: HZ"},
                          {{"a.toml", "a.mid", "-o=b.wav"},
                           "'-o=b.wav' has a '=' behind a short name; did you mean '-o b.wav' or "
                           "'--output=b.wav'?"},
                          {render_words({"-o", "b.wav"}), "-o is given twice"},
                          {render_words({"--output=b.wav"}), "--output is given twice"},
                          {render_words({"--quiet=3"}), "--quiet takes no value, but got '3'"},
                      });
}

TEST(RenderCommandLine, AWrongValueNamesTheRange) {
  expect_usage_errors(
      "knotwave-render",
      {
          {render_words({"--rate", "7"}), "--rate: '7' is not a whole number from 8000 to 768000"},
          {render_words({"--rate", "44.1"}),
           "--rate: '44.1' is not a whole number from 8000 to 768000"},
          {render_words({"--rate", "-1"}),
           "--rate: '-1' is not a whole number from 8000 to 768000"},
          {render_words({"--seed", "-1"}),
           "--seed: '-1' is not a whole number from 0 to 18446744073709551615"},
          {render_words({"--seed", "18446744073709551616"}),
           "--seed: '18446744073709551616' is not a whole number from 0 to 18446744073709551615"},
          {render_words({"--max-length", "nan"}),
           "--max-length: 'nan' is not a number from 0 to 1000000000"},
          {render_words({"--max-length", "1h"}),
           "--max-length: '1h' is not a number from 0 to 1000000000"},
          {render_words({"--tail", "-1"}),
           "--tail: '-1' is neither 'auto' nor a number of seconds from 0 to 3600"},
          {render_words({"--tail", "nan"}),
           "--tail: 'nan' is neither 'auto' nor a number of seconds from 0 to 3600"},
          {render_words({"--block", "0"}), "--block: '0' is not a whole number from 1 to 65536"},
          {render_words({"--threads", "100"}),
           "--threads: '100' is not a whole number from 1 to 64"},
          {render_words({"--bits", "32"}),
           "--bits: '32' is not 16, 24 or 32f; did you mean '32f'?"},
          {render_words({"--simd", "basline"}),
           "--simd: 'basline' is not best, avx2 or baseline; did you mean 'baseline'?"},
      });
}

TEST(RenderCommandLine, WordsThatDoNotGoTogetherAreTold) {
  expect_usage_errors(
      "knotwave-render",
      {
          {{}, "a PATCH and a SCORE are needed, or --demo NAME, or --journal FILE"},
          {{"a.toml", "-o", "a.wav"}, "after the patch 'a.toml' a SCORE is needed (.mid, .rmi)"},
          {{"a.mid", "a.toml", "-o", "a.wav"},
           "the patch comes before the score, but 'a.mid' is named as a MIDI file"},
          {{"a.toml", "a.mid"}, "where to? -o FILE.wav, -o FILE.flac, -o - or --check"},
          {{"a.toml", "a.mid", "-o", "a.mp3"},
           "--output: 'a.mp3' ends neither in .wav nor in .flac"},
          {{"a.toml", "a.mid", "-o", "a.flac", "--bits", "32f"},
           "FLAC holds 16 or 24 bits, not 32-bit float: use --bits 24 or a name that ends in .wav"},
          {render_words({"--check"}), "--check renders nothing; leave out --output 'a.wav'"},
          {{"a.toml", "a.mid", "--check", "--json", "a.json"},
           "--check renders nothing; leave out --json 'a.json'"},
          {{"a.toml", "a.mid", "--check", "--stems", "stems"},
           "--check renders nothing; leave out --stems 'stems'"},
          {{"a.toml", "a.mid", "-o", "a.flac", "--rate", "768000"},
           "FLAC holds rates to 65535 Hz, and multiples of 10 to 655350 Hz, not 768000 Hz: use "
           "another --rate or a name that ends in .wav"},
          {{"a.toml", "a.mid", "-o", "a.FLAC", "--rate", "65536"},
           "FLAC holds rates to 65535 Hz, and multiples of 10 to 655350 Hz, not 65536 Hz: use "
           "another --rate or a name that ends in .wav"},
          {{"a.MID", "a.toml", "-o", "a.wav"},
           "the patch comes before the score, but 'a.MID' is named as a MIDI file"},
          {{"a.toml", "a.mid", "-o", "-", "--json", "-"},
           "-o - and --json - cannot share standard output"},
          {{"a.toml", "--demo", "groove", "-o", "a.wav"},
           "--demo plays its own patch and score; leave out 'a.toml'"},
      });
  const auto demo = run_program({"knotwave-render", "--demo", "first-lite", "-o", "a.wav"});
  EXPECT_EQ(demo.exit_code, 2);
  EXPECT_THAT(demo.err, HasSubstr("no demo 'first-lite'; did you mean 'first-light'? (demos: "));
}

TEST(CurveCommandLine, AWrongCommandIsNamedWithTheNearest) {
  expect_usage_errors(
      "knotwave-curve",
      {
          {{},
           "what to do? check, info, eval, plot, split, insert-knot, elevate, simplify, morph, "
           "iso, "
           "fit, import or export"},
          {{"chek", "a.toml"}, "unknown command 'chek'; did you mean 'check'?"},
          {{"PLOT", "a.toml"}, "unknown command 'PLOT'; did you mean 'plot'?"},
          {{"help"}, "unknown command 'help'; did you mean '--help'?"},
          {{"a.toml"},
           "unknown command 'a.toml'; the commands are check, info, eval, plot, split, "
           "insert-knot, elevate, simplify, morph, iso, fit, import and export"},
          {{"split"}, "which curve? a FILE is needed, or FILE#NAME"},
          {{"fit"}, "which file? a FILE is needed"},
          {{"info"}, "which curve? a FILE is needed, or FILE#NAME"},
          {{"info", "a.toml", "b.toml"}, "'b.toml' is one word too many: FILE is given already"},
      });
}

TEST(CurveCommandLine, AnOptionOfAnotherCommandIsToldAsSuch) {
  expect_usage_errors(
      "knotwave-curve",
      {
          {{"--json", "info", "a.toml"},
           "--json is an option of 'info' and 'eval'; give it after the command"},
          {{"eval", "a.toml", "--size", "300x300"}, "--size is an option of 'plot', not of 'eval'"},
          {{"eval", "a.toml", "--gird", "4"}, "unknown option '--gird'; did you mean '--grid'?"},
          {{"plot", "a.toml", "--derivatives=1"},
           "--derivatives is an option of 'eval', not of 'plot'"},
      });
}

TEST(CurveCommandLine, AWrongValueNamesTheRange) {
  expect_usage_errors(
      "knotwave-curve",
      {
          {{"eval", "a.toml"}, "where? --at LIST or --grid STEPS"},
          {{"eval", "a.toml", "--at", "0", "--grid", "3"}, "--at and --grid exclude each other"},
          {{"eval", "a.toml", "--at", "0,x"},
           "--at: 'x' is neither a number u nor a pair u:v (no blanks around the commas)"},
          {{"eval", "a.toml", "--at", ""}, "--at needs a value: LIST"},
          {{"eval", "a.toml", "--grid", "0"},
           "--grid: '0' is not a whole number from 1 to 1000000"},
          {{"eval", "a.toml", "--grid", "4", "--derivatives", "16"},
           "--derivatives: '16' is not a whole number from 0 to 15"},
          {{"plot", "a.toml", "-o", "a.gif"}, "--output: 'a.gif' ends neither in .svg nor in .png"},
          {{"plot", "a.toml", "--size", "960*540"},
           "--size: '960*540' is not WIDTHxHEIGHT with sides of 200 to 8000 pixels"},
          {{"plot", "a.toml", "--columns", "5"},
           "--columns: '5' is not a whole number from 28 to 400"},
      });
}

TEST(HelpText, FitsATerminalOf80Columns) {
  const std::vector<std::vector<std::string>> asked = {
      {"knotwave-render", "--help"},         {"knotwave-curve", "--help"},
      {"knotwave-curve", "check", "--help"}, {"knotwave-curve", "info", "--help"},
      {"knotwave-curve", "eval", "--help"},  {"knotwave-curve", "plot", "--help"}};
  for (const auto& words : asked) {
    const auto help = run_program(words);
    EXPECT_EQ(help.exit_code, 0);
    std::size_t begin = 0;
    for (std::size_t end; (end = help.out.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
      const std::string line = help.out.substr(begin, end - begin);
      const bool is_example = line.starts_with("  knotwave-");
      EXPECT_LE(line.size(), is_example ? 100u : 80u) << line;
    }
  }
}

}  // namespace
