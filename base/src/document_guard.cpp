// SPDX-License-Identifier: MIT
// One pass over the characters of a TOML text.
#include "document_guard.h"

#include "knotwave/base/document.h"

namespace knotwave::base {
namespace {

class GuardScanner {
 public:
  explicit GuardScanner(std::string_view text) : text_(text) {}

  GuardFault run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (at_ < text_.size() && fault_.line == 0) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        // To toml++ a quote within a word is part of the word, and so is what follows.
        if (!may_begin_string()) keep("a quote may not stand within a word");
        skip_string(c);
      } else if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else {
        count(c);
        if (brackets_ > kMaxDocumentDepth || dots_ > kMaxDocumentDepth) keep(too_deep_message());
        if (c == '\0') keep("a zero byte: this is not a text file");
        if (!is_ascii(c)) keep("only ASCII letters may stand outside of quotes and comments");
        step();
      }
    }
    return fault_;
  }

 private:
  static bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

  bool may_begin_string() const {
    return at_ == 0 ||
           std::string_view(" \t\r\n=[,{.\xBF").find(text_[at_ - 1]) != std::string_view::npos;
  }

  void keep(std::string message) {
    if (fault_.line == 0) fault_ = {line_, column_, std::move(message)};
  }

  void count(char c) {
    if (c == '[' || c == '{') ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    if (c == '.') ++dots_;
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots_ = 0;
  }

  void skip_string(char quote) {
    const std::string_view rest = text_.substr(at_);
    const bool is_long = rest.size() >= 3 && rest[1] == quote && rest[2] == quote;
    step(is_long ? 3 : 1);
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        step(2);
        if (is_long) check_after_backslash();
      } else if (!is_long && (c == quote || c == '\n')) {
        step();
        return;
      } else if (is_long && c == quote && text_.substr(at_, 3) == rest.substr(0, 3)) {
        step(3);
        while (at_ < text_.size() && text_[at_] == quote) step();  // up to two belong to the text
        return;
      } else {
        step();
      }
    }
  }

  /// toml++ looks for white space after a backslash, and after the line breaks that one swallows.
  void check_after_backslash() {
    if (!is_ascii(text_[at_ - 1])) keep("a backslash may not stand before this letter");
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    if (!is_blank(text_[at_ - 1])) return;
    while (at_ < text_.size() && is_blank(text_[at_])) step();
    if (at_ < text_.size() && !is_ascii(text_[at_])) {
      keep("after a backslash at a line's end the text must go on with an ASCII letter");
    }
  }

  /// Columns count code points: continuation bytes of UTF-8 do not move them.
  void step(std::size_t count = 1) {
    for (; count > 0 && at_ < text_.size(); --count, ++at_) {
      const auto byte = static_cast<unsigned char>(text_[at_]);
      if (byte == '\n') {
        ++line_;
        column_ = 1;
      } else if ((byte & 0xC0) != 0x80) {
        ++column_;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  int column_ = 1;
  int brackets_ = 0;
  int dots_ = 0;
  GuardFault fault_;
};

}  // namespace

GuardFault find_guard_fault(std::string_view text) { return GuardScanner(text).run(); }

std::string too_deep_message() {
  return "nested deeper than " + std::to_string(kMaxDocumentDepth) + " levels";
}

}  // namespace knotwave::base
