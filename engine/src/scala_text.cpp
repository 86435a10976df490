// SPDX-License-Identifier: MIT
// Parsers of .scl and .kbm.
#include "scala_text.h"

#include <charconv>
#include <cmath>
#include <cstdint>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/engine/tuning.h"

namespace knotwave::engine {
namespace {

constexpr double kMaxCents = 120'000;  // 100 octaves
constexpr int kMaxPattern = 4096;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

ScalaLine first_word(std::string_view text, int line) {
  std::size_t begin = 0;
  while (begin < text.size() && is_space(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_space(text[end])) ++end;
  return {text.substr(begin, end - begin), line, static_cast<int>(begin) + 1};
}

Error fault(ErrorCode code, std::string message, std::string_view source, const ScalaLine& at) {
  Error error = fail(code, std::move(message));
  error.source = source;
  error.line = at.line;
  error.column = at.column;
  return error;
}

std::string quoted(std::string_view word) { return "'" + std::string(word) + "'"; }

template <class Number>
bool parse_whole(std::string_view word, Number& out) {
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), out);
  return status == std::errc{} && end == word.data() + word.size();
}

Result<double> parse_cents(const ScalaLine& at, std::string_view source) {
  double cents = 0;
  if (!parse_whole(at.word, cents)) {
    return fault(ErrorCode::malformed, quoted(at.word) + " is no number of cents", source, at);
  }
  if (!(std::abs(cents) <= kMaxCents)) {
    return fault(ErrorCode::value_out_of_range, quoted(at.word) + " cents is more than 100 octaves",
                 source, at);
  }
  return cents / 100;
}

Result<double> parse_ratio(const ScalaLine& at, std::string_view source) {
  const std::size_t slash = at.word.find('/');
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;
  const bool ok =
      parse_whole(at.word.substr(0, slash), numerator) &&
      (slash == std::string_view::npos || parse_whole(at.word.substr(slash + 1), denominator));
  if (!ok) {
    return fault(ErrorCode::malformed,
                 quoted(at.word) + " is neither cents (with a '.') nor a ratio such as 3/2", source,
                 at);
  }
  if (numerator <= 0 || denominator <= 0) {
    return fault(ErrorCode::value_out_of_range, "the ratio " + quoted(at.word) + " is not positive",
                 source, at);
  }
  return 12 * base::log2(static_cast<double>(numerator) / static_cast<double>(denominator));
}

// "If the value contains a period, it is a cents value, otherwise a ratio."
Result<double> parse_pitch(const ScalaLine& at, std::string_view source) {
  const bool cents = at.word.find('.') != std::string_view::npos;
  return cents ? parse_cents(at, source) : parse_ratio(at, source);
}

// Hands out one line after another; the end of the text is an error that says what was missing.
class LineReader {
 public:
  LineReader(std::string_view text, std::string_view source)
      : lines_(scala_lines(text)), source_(source) {}

  const ScalaLine* next_line() { return next_ < lines_.size() ? &lines_[next_++] : nullptr; }
  const ScalaLine* next_word() {
    while (next_ < lines_.size() && lines_[next_].word.empty()) ++next_;
    return next_line();
  }
  Error missing(const std::string& what) const {
    const ScalaLine end = lines_.empty() ? ScalaLine{{}, 1, 1} : lines_.back();
    return fault(ErrorCode::malformed, "the file ends before " + what, source_, end);
  }
  Result<int> integer(const std::string& what, int low, int high) {
    const ScalaLine* at = next_word();
    if (at == nullptr) return missing(what);
    int value = 0;
    if (!parse_whole(at->word, value)) {
      return fault(ErrorCode::malformed,
                   quoted(at->word) + " is no whole number (" + what + " is expected)", source_,
                   *at);
    }
    if (value < low || value > high) {
      return fault(ErrorCode::value_out_of_range,
                   what + " is " + std::to_string(value) + ", allowed are " + std::to_string(low) +
                       " to " + std::to_string(high),
                   source_, *at);
    }
    last_ = *at;
    return value;
  }
  const ScalaLine& last() const { return last_; }

 private:
  std::vector<ScalaLine> lines_;
  std::string_view source_;
  std::size_t next_ = 0;
  ScalaLine last_;
};

Result<double> parse_reference_hz(LineReader& reader, std::string_view source, ScalaLine& place) {
  const ScalaLine* at = reader.next_word();
  if (at == nullptr) return reader.missing("the reference frequency");
  place = *at;
  double hz = 0;
  if (!parse_whole(at->word, hz)) {
    return fault(ErrorCode::malformed, quoted(at->word) + " is no frequency in Hz", source, *at);
  }
  if (!(hz >= 1e-3 && hz <= 1e6)) {
    return fault(ErrorCode::value_out_of_range,
                 "the reference frequency is " + base::number_text(hz) +
                     " Hz, allowed are 0.001 to 1000000 Hz",
                 source, *at);
  }
  return hz;
}

// The keys of the pattern; those left out at the end are unmapped.
Result<void> parse_pattern(LineReader& reader, std::string_view source, int size,
                           KeyboardMapping& mapping) {
  mapping.degrees.assign(static_cast<std::size_t>(size), std::nullopt);
  for (int key = 0;; ++key) {
    const ScalaLine* at = reader.next_word();
    if (at == nullptr) return {};
    if (key == size) {
      return fault(ErrorCode::malformed,
                   "the mapping has " + std::to_string(size) + " keys, here is one more", source,
                   *at);
    }
    if (at->word == "x" || at->word == "X") continue;
    int degree = 0;
    if (!parse_whole(at->word, degree)) {
      return fault(ErrorCode::malformed,
                   quoted(at->word) + " is neither a scale degree nor 'x' (unmapped)", source, *at);
    }
    if (degree < 0 || degree > kMaxScaleNotes) {
      return fault(ErrorCode::value_out_of_range,
                   "scale degree " + std::to_string(degree) + " is not in 0 to " +
                       std::to_string(kMaxScaleNotes),
                   source, *at);
    }
    mapping.degrees[static_cast<std::size_t>(key)] = degree;
  }
}

struct Division {
  int quotient = 0;
  int remainder = 0;
};
Division floor_divide(int a, int b) {
  int quotient = a / b;
  if (a % b < 0) --quotient;
  return {quotient, a - quotient * b};
}

}  // namespace

std::vector<ScalaLine> scala_lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<ScalaLine> lines;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view content = text.substr(0, end);
    if (!content.starts_with('!')) lines.push_back(first_word(content, line));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

double Scale::semitones(int degree) const {
  if (degrees.empty()) return 0;
  const auto [repeats, rest] = floor_divide(degree, static_cast<int>(degrees.size()));
  const double inner = rest == 0 ? 0 : degrees[static_cast<std::size_t>(rest - 1)];
  return repeats * degrees.back() + inner;
}

std::optional<KeyboardMapping::Place> KeyboardMapping::place(int note) const {
  if (degrees.empty()) return Place{note - middle_note, 0};
  const auto [pattern, key] = floor_divide(note - middle_note, static_cast<int>(degrees.size()));
  const auto& degree = degrees[static_cast<std::size_t>(key)];
  if (!degree) return std::nullopt;
  return Place{*degree, pattern};
}

Result<Scale> parse_scale(std::string_view text, std::string_view source) {
  LineReader reader(text, source);
  if (reader.next_line() == nullptr) return reader.missing("the line that describes the scale");
  const auto count = reader.integer("the number of notes", 0, kMaxScaleNotes);
  if (!count) return count.error();
  Scale scale;
  for (int i = 1; i <= *count; ++i) {
    const ScalaLine* at = reader.next_word();
    if (at == nullptr) {
      return reader.missing("note " + std::to_string(i) + " of " + std::to_string(*count));
    }
    const auto pitch = parse_pitch(*at, source);
    if (!pitch) return pitch.error();
    scale.degrees.push_back(*pitch);
    scale.lines.push_back(*at);
  }
  // Text after the last note is allowed, but one more pitch means that the count is wrong.
  if (const ScalaLine* at = reader.next_word(); at != nullptr && parse_pitch(*at, source)) {
    return fault(ErrorCode::malformed,
                 "the scale has " + std::to_string(*count) + " notes, here is one more", source,
                 *at);
  }
  return scale;
}

Result<KeyboardMapping> parse_mapping(std::string_view text, std::string_view source) {
  LineReader reader(text, source);
  KeyboardMapping mapping;
  const auto size = reader.integer("the size of the mapping", 0, kMaxPattern);
  if (!size) return size.error();
  const auto first = reader.integer("the first note", 0, 127);
  if (!first) return first.error();
  const auto last = reader.integer("the last note", *first, 127);
  if (!last) return last.error();
  const auto middle = reader.integer("the middle note", 0, 127);
  if (!middle) return middle.error();
  const auto reference = reader.integer("the reference note", 0, 127);
  if (!reference) return reference.error();
  mapping.reference_line = reader.last();
  const auto hz = parse_reference_hz(reader, source, mapping.hz_line);
  if (!hz) return hz.error();
  const auto octave = reader.integer("the formal octave", 0, kMaxScaleNotes);
  if (!octave) return octave.error();
  mapping.first_note = *first;
  mapping.last_note = *last;
  mapping.middle_note = *middle;
  mapping.reference_note = *reference;
  mapping.reference_hz = *hz;
  mapping.octave_degree = *octave;
  if (const auto pattern = parse_pattern(reader, source, *size, mapping); !pattern) {
    return pattern.error();
  }
  return mapping;
}

}  // namespace knotwave::engine
