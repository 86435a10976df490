// SPDX-License-Identifier: MIT
// A journal from text. docs/journal-format.md. Memory is at most a few times the text.
#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "knotwave/engine/journal.h"
#include "knotwave/engine/target_words.h"

#include "journal_words.h"

namespace knotwave::engine {
namespace {

constexpr std::size_t kMaxBanks = 65536;
constexpr std::int32_t kMaxNote = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kMaxSample = std::int64_t{1} << 62;
constexpr std::int64_t kMaxSongClocks = std::int64_t{1} << 53;
constexpr int kMaxVoices = 4096;  // as Engine::create() has it
constexpr std::size_t kHashDigits = 64;

/// A line of the text, read word by word. The first fault is kept.
class Reader {
 public:
  Reader(std::string_view text, const std::string& source) : text_(text), source_(source) {}
  Result<Journal> read();

 private:
  // Lines and words.
  bool next_line();
  std::string_view word();
  bool skip(std::string_view expected);
  void finish_line();
  void fault(ErrorCode code, std::string message);
  bool ok() const { return !error_; }

  // Values of the line. `what` names them in messages.
  template <class Number>
  Number number(const char* what, Number low, Number high);
  double real(const char* what);
  std::uint8_t byte();
  std::string hash();
  std::string barred();

  void read_settings(Journal& journal);
  void key(std::string_view expected);
  void read_take(Journal& journal);
  void read_banks(Journal& journal);
  void read_records(Journal& journal);
  void read_record(const Journal& journal, JournalRecord& record);
  void read_time(std::string_view text, JournalRecord& record);
  void read_midi(JournalRecord& record);
  void read_target(JournalRecord& record);
  void read_set_note(JournalRecord& record);
  void read_note(JournalRecord& record);
  void read_channel(JournalRecord& record);
  void read_slot(JournalRecord& record);

  std::string_view text_;
  const std::string& source_;
  std::string_view line_;
  std::size_t next_ = 0;  ///< in text_
  std::size_t at_ = 0;    ///< in line_
  std::size_t word_ = 0;  ///< where the last word began
  int number_ = 0;        ///< of the line
  std::optional<Error> error_;
};

void Reader::fault(ErrorCode code, std::string message) {
  if (error_) return;
  error_ = fail(code, std::move(message));
  error_->source = source_;
  error_->line = number_;
  error_->column = static_cast<int>(std::min<std::size_t>(word_, 1 << 30)) + 1;
}

bool Reader::next_line() {
  if (!ok()) return false;
  ++number_;
  at_ = word_ = 0;
  line_ = {};
  const std::size_t end = text_.find('\n', next_);
  if (end == std::string_view::npos) {
    fault(ErrorCode::malformed, next_ == text_.size()
                                    ? "the journal ends before its line 'end'"
                                    : "the last line has no end: the journal was cut off");
    return false;
  }
  line_ = text_.substr(next_, end - next_);
  next_ = end + 1;
  return true;
}

std::string_view Reader::word() {
  if (at_ < line_.size() && at_ > 0) ++at_;  // one space
  word_ = at_;
  const std::size_t end = std::min(line_.find(' ', at_), line_.size());
  const std::string_view found = line_.substr(at_, end - at_);
  at_ = end;
  return found;
}

/// The next word, if it is that.
bool Reader::skip(std::string_view expected) {
  const std::size_t before = at_, word_before = word_;
  if (word() == expected) return true;
  at_ = before;
  word_ = word_before;
  return false;
}

void Reader::finish_line() {
  if (at_ == line_.size()) return;
  word_ = at_ + 1;
  fault(ErrorCode::syntax, "there is more on the line than belongs there");
}

template <class Number>
Number Reader::number(const char* what, Number low, Number high) {
  const std::string_view text = word();
  Number value{};
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc::result_out_of_range ||
      (status == std::errc{} && (value < low || value > high))) {
    fault(ErrorCode::value_out_of_range,
          std::string(what) + " must be " + std::to_string(low) + " to " + std::to_string(high));
    return low;
  }
  if (status != std::errc{} || end != text.data() + text.size()) {
    fault(ErrorCode::wrong_type, std::string(what) + " must be a whole number here");
    return low;
  }
  return value;
}

double Reader::real(const char* what) {
  const std::string_view text = word();
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc{} && end == text.data() + text.size()) return value;
  fault(ErrorCode::wrong_type, std::string(what) + " must be a number here");
  return 0;
}

std::uint8_t Reader::byte() {
  const std::string_view text = word();
  std::uint8_t value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (status != std::errc{} || text.size() != 2 || end != text.data() + 2) {
    fault(ErrorCode::wrong_type, "a byte in two hexadecimal digits must be here");
  }
  return value;
}

std::string Reader::hash() {
  const std::string_view text = word();
  if (text.size() != kHashDigits ||
      text.find_first_not_of("0123456789abcdef") != std::string_view::npos) {
    fault(ErrorCode::wrong_type, "a SHA-256 in 64 hexadecimal digits must be here");
  }
  return std::string(text);
}

std::string Reader::barred() {
  std::string bytes;
  if (!next_line()) return bytes;
  if (!line_.starts_with('|')) {
    fault(ErrorCode::syntax, "a line that begins with '|' must be here");
    return bytes;
  }
  bytes = line_.substr(1);
  while (next_ < text_.size() && text_[next_] == '|' && next_line()) {
    bytes += '\n';
    bytes += line_.substr(1);
  }
  return bytes;
}

void Reader::key(std::string_view expected) {
  if (!next_line()) return;
  if (word() != expected) {
    fault(ErrorCode::missing_key, "'" + std::string(expected) + "' must be here");
  }
}

void Reader::read_settings(Journal& journal) {
  const std::string_view start = text_.substr(0, kMagic.size());
  if (start != kMagic.substr(0, start.size())) {
    number_ = 1;
    return fault(ErrorCode::missing_key,
                 "this is no journal: one begins with '" + std::string(kMagic) + "'");
  }
  key(kMagic);
  if (!ok()) return;
  if (const std::string_view version = word(); version != "1") {
    fault(ErrorCode::unsupported_version, "this program reads journals of version 1, not '" +
                                              std::string(version.substr(0, 20)) + "'");
  }
  finish_line();
  key("rate_hz");
  journal.rate_hz = real("the rate");
  finish_line();
  key("max_voices");
  journal.max_voices = number("the number of voices", 1, kMaxVoices);
  finish_line();
  key("seed");
  journal.seed = number<std::uint64_t>("the seed", 0, std::numeric_limits<std::uint64_t>::max());
  finish_line();
  key("volume_db");
  journal.volume_db = real("the volume");
  finish_line();
}

void Reader::read_take(Journal& journal) {
  key("take");
  journal.first = number<std::int64_t>("the take's first sample", 0, kMaxSample);
  journal.end = number<std::int64_t>("the take's end", journal.first, kMaxSample);
  if (ok() && line_.substr(at_) == " -") {
    word();
  } else {
    journal.sha256 = hash();
  }
  finish_line();
}

void Reader::read_banks(Journal& journal) {
  while (next_line()) {
    const std::string_view what = word();
    if (what == "events") return finish_line();
    if (what == "bank") {
      finish_line();
      if (journal.banks.size() == kMaxBanks) {
        return fault(ErrorCode::value_out_of_range,
                     "a journal holds at most " + std::to_string(kMaxBanks) + " banks");
      }
      journal.banks.emplace_back().path = barred();
    } else if (what == "file" && !journal.banks.empty()) {
      finish_line();
      FileText file;
      file.path = barred();
      key("holds");
      finish_line();
      file.bytes = barred();
      journal.banks.back().files.push_back(std::move(file));
    } else if (what == "sound" && !journal.banks.empty()) {
      JournalBank::Sound sound;
      sound.sha256 = hash();
      finish_line();
      sound.path = barred();
      journal.banks.back().sounds.push_back(std::move(sound));
    } else {
      return fault(ErrorCode::syntax, journal.banks.empty()
                                          ? "'bank' or 'events' must be here"
                                          : "'bank', 'file', 'sound' or 'events' must be here");
    }
  }
}

void Reader::read_records(Journal& journal) {
  while (next_line()) {
    if (line_ == "end") {
      if (next_ == text_.size()) return;
      ++number_;
      return fault(ErrorCode::syntax, "there is more after the journal's end");
    }
    JournalRecord record;
    read_record(journal, record);
    finish_line();
    if (ok() && !journal.records.empty() && record.time < journal.records.back().time) {
      word_ = 0;
      fault(ErrorCode::value_out_of_range, "this is earlier than the line before");
    }
    if (ok()) journal.records.push_back(record);
  }
}

void Reader::read_time(std::string_view text, JournalRecord& record) {
  const char* const end = text.data() + text.size();
  auto read = std::from_chars(text.data(), end, record.time.sample);
  if (read.ec == std::errc{} && read.ptr != end && *read.ptr == '+') {
    read = std::from_chars(read.ptr + 1, end, record.time.fraction);
  }
  if (read.ec == std::errc{} && read.ptr == end && record.time.sample >= 0 &&
      record.time.sample <= kMaxSample)
    return;
  fault(ErrorCode::wrong_type, "a time must be here: a sample, or SAMPLE+FRACTION in 2^-32");
}

void Reader::read_record(const Journal& journal, JournalRecord& record) {
  read_time(word(), record);
  const std::string_view what = word();
  if (what == "midi") {
    read_midi(record);
  } else if (what == "numbered") {
    record.note = number<std::int32_t>("a note's number", 0, kMaxNote);
    read_midi(record);
  } else if (what == "modulation" || what == "expression") {
    record.is_expression = what == "expression";
    read_set_note(record);
  } else if (what == "choke") {
    record.kind = Event::Kind::choke;
    read_note(record);
  } else if (what == "tempo") {
    record.kind = Event::Kind::tempo;
    record.number = real("microseconds per quarter note");
    if (!(record.number >= 0 && record.number <= 0xFFFFFFFFu)) {
      fault(ErrorCode::value_out_of_range, "microseconds per quarter note must be 0 to 4294967295");
    }
  } else if (what == "position") {
    record.kind = Event::Kind::position;
    record.number = static_cast<double>(
        number<std::int64_t>("the song position in MIDI clocks", 0, kMaxSongClocks));
  } else if (what == "bank") {
    record.kind = Event::Kind::install_bank;
    record.index = number<std::uint32_t>("a bank's number", 0, kMaxBanks);
    if (record.index >= journal.banks.size()) {
      fault(ErrorCode::value_out_of_range,
            "there is no bank " + std::to_string(record.index) + "; the journal holds " +
                std::to_string(journal.banks.size()) + ", counted from 0");
    }
  } else if (what == "notes_off") {
    record.kind = Event::Kind::all_notes_off;
  } else if (what == "target") {
    read_target(record);
  } else {
    fault(ErrorCode::unknown_name,
          "'midi', 'numbered', 'tempo', 'position', 'bank', 'notes_off', 'target', "
          "'modulation', 'expression' or 'choke' must be here after a time");
  }
}

void Reader::read_midi(JournalRecord& record) {
  for (std::uint8_t& out : record.bytes) out = byte();
  while (ok() && at_ < line_.size()) {
    if (record.sysex_size == record.sysex.size()) {
      word();
      return fault(ErrorCode::value_out_of_range, "a system exclusive of a journal has at most " +
                                                      std::to_string(record.sysex.size()) +
                                                      " bytes");
    }
    record.sysex[record.sysex_size++] = byte();
  }
}

void Reader::read_target(JournalRecord& record) {
  record.kind = Event::Kind::set_target;
  read_channel(record);
  read_slot(record);
}

void Reader::read_channel(JournalRecord& record) {
  record.every_channel = skip(kEveryWord);
  if (record.every_channel) return;
  record.bytes[0] = static_cast<std::uint8_t>(number("a channel", 1, 16) - 1);
}

void Reader::read_set_note(JournalRecord& record) {
  record.kind = Event::Kind::set_note;
  read_note(record);
  read_slot(record);
}

void Reader::read_note(JournalRecord& record) {
  if (skip(kNoteWord)) {
    record.note = number<std::int32_t>("a note's number", 0, kMaxNote);
  } else {
    read_channel(record);
    record.bytes[1] = skip(kEveryWord) ? static_cast<std::uint8_t>(Event::kEveryKey)
                                       : static_cast<std::uint8_t>(number("a key", 0, 127));
  }
}

void Reader::read_slot(JournalRecord& record) {
  const bool is_of_note = record.kind == Event::Kind::set_note;
  const std::string_view name = word();
  std::uint32_t slot = 0;
  const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), slot);
  if (const auto known = slot_of_word(name)) {
    record.index = static_cast<std::uint32_t>(*known);
  } else if (is_of_note && name == kPressureWord) {
    record.index = Event::kNotePressure;
  } else if (is_of_note && name == kTimbreWord) {
    record.index = Event::kNoteTimbre;
  } else if (!is_of_note && name == kEverySlotWord) {
    record.index = Event::kEverySlot;
  } else if (status == std::errc{} && end == name.data() + name.size() && slot <= 0xFFFF) {
    record.index = slot;
  } else {
    fault(ErrorCode::unknown_name, "a target must be here, such as amp or oscillator.1.level");
  }
  record.number = real("a target's number");
}

Result<Journal> Reader::read() {
  Journal journal;
  read_settings(journal);
  if (ok()) read_take(journal);
  if (ok()) read_banks(journal);
  if (ok()) read_records(journal);
  if (error_) return *std::move(error_);
  return journal;
}

}  // namespace

Result<Journal> read_journal(std::string_view text, const std::string& source_name) {
  return Reader(text, source_name).read();
}

}  // namespace knotwave::engine
