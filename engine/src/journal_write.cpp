// SPDX-License-Identifier: MIT
// A journal as text. docs/journal-format.md.
#include <charconv>

#include "knotwave/engine/journal.h"
#include "knotwave/engine/target_words.h"

#include "journal_words.h"

namespace knotwave::engine {
namespace {

class Writer {
 public:
  std::string write(const Journal& journal) {
    words({kMagic, "1"});
    number("rate_hz", journal.rate_hz);
    integer("max_voices", journal.max_voices);
    out_ += "seed ";
    put(journal.seed);
    out_ += '\n';
    number("volume_db", journal.volume_db);
    out_ += "take ";
    put(journal.first);
    out_ += ' ';
    put(journal.end);
    out_ += ' ';
    out_ += journal.sha256.empty() ? "-" : journal.sha256;
    out_ += '\n';
    for (const JournalBank& bank : journal.banks) write_bank(bank);
    out_ += "events\n";
    for (const JournalRecord& record : journal.records) write_record(record);
    out_ += "end\n";
    return std::move(out_);
  }

 private:
  template <class Number>
  void put(Number value, int base = 10) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value, base).ptr;
    out_.append(text, end);
  }
  void put_double(double value) {
    char text[40];
    out_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
  }
  void put_byte(std::uint8_t byte) {
    constexpr char kDigits[] = "0123456789abcdef";
    out_ += kDigits[byte >> 4];
    out_ += kDigits[byte & 15];
  }
  void words(std::initializer_list<std::string_view> all) {
    for (const std::string_view word : all) (out_ += word) += ' ';
    out_.back() = '\n';
  }
  void number(std::string_view key, double value) {
    (out_ += key) += ' ';
    put_double(value);
    out_ += '\n';
  }
  void integer(std::string_view key, std::int64_t value) {
    (out_ += key) += ' ';
    put(value);
    out_ += '\n';
  }
  /// Bytes as lines that begin with a bar: what was between two of them is a line end.
  void lines(std::string_view bytes) {
    out_ += '|';
    for (const char c : bytes) {
      out_ += c;
      if (c == '\n') out_ += '|';
    }
    out_ += '\n';
  }

  void write_bank(const JournalBank& bank) {
    out_ += "bank\n";
    lines(bank.path);
    for (const FileText& file : bank.files) {
      out_ += "file\n";
      lines(file.path);
      out_ += "holds\n";
      lines(file.bytes);
    }
    for (const JournalBank::Sound& sound : bank.sounds) {
      words({"sound", sound.sha256});
      lines(sound.path);
    }
  }

  void write_record(const JournalRecord& record) {
    put(record.time.sample);
    if (record.time.fraction != 0) {
      out_ += '+';
      put(record.time.fraction);
    }
    switch (record.kind) {
      case Event::Kind::midi:
        out_ += record.note < 0 ? " midi" : " numbered ";
        if (record.note >= 0) put(record.note);
        for (const std::uint8_t byte : record.bytes) (out_ += ' ', put_byte(byte));
        for (int i = 0; i < record.sysex_size; ++i) {
          out_ += ' ';
          put_byte(record.sysex[static_cast<std::size_t>(i)]);
        }
        break;
      case Event::Kind::tempo:
        out_ += " tempo ";
        put_double(record.number);
        break;
      case Event::Kind::position:
        out_ += " position ";
        put(static_cast<std::int64_t>(record.number));
        break;
      case Event::Kind::install_bank:
        out_ += " bank ";
        put(record.index);
        break;
      case Event::Kind::all_notes_off:
        out_ += " notes_off";
        break;
      case Event::Kind::set_target:
        out_ += " target ";
        write_channel(record);
        out_ += ' ';
        write_slot(record.index);
        out_ += ' ';
        put_double(record.number);
        break;
      case Event::Kind::set_note:
        out_ += record.is_expression ? " expression " : " modulation ";
        write_note(record);
        out_ += ' ';
        write_slot(record.index);
        out_ += ' ';
        put_double(record.number);
        break;
      case Event::Kind::choke:
        out_ += " choke ";
        write_note(record);
        break;
    }
    out_ += '\n';
  }

  void write_channel(const JournalRecord& record) {
    if (record.every_channel) {
      out_ += kEveryWord;
    } else {
      put((record.bytes[0] & 15) + 1);
    }
  }
  /// "note 17", or channel and key: "3 60", "every every".
  void write_note(const JournalRecord& record) {
    if (record.note >= 0) {
      (out_ += kNoteWord) += ' ';
      return put(record.note);
    }
    write_channel(record);
    out_ += ' ';
    if (record.bytes[1] == Event::kEveryKey) {
      out_ += kEveryWord;
    } else {
      put(static_cast<int>(record.bytes[1]));
    }
  }

  void write_slot(std::uint32_t slot) {
    switch (slot) {
      case Event::kEverySlot:
        out_ += kEverySlotWord;
        return;
      case Event::kNotePressure:
        out_ += kPressureWord;
        return;
      case Event::kNoteTimbre:
        out_ += kTimbreWord;
        return;
      default:
        break;
    }
    if (slot >= kSlotCount) return put(slot);
    out_ += slot_word(static_cast<int>(slot));
  }

  std::string out_;
};

}  // namespace

std::string write_journal(const Journal& journal) { return Writer().write(journal); }

}  // namespace knotwave::engine
