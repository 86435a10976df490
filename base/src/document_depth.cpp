// SPDX-License-Identifier: MIT
// One pass over the characters of a TOML text.
#include "document_depth.h"

#include "knotwave/base/document.h"

namespace knotwave::base {
namespace {

class DepthScanner {
 public:
  explicit DepthScanner(std::string_view text) : text_(text) {}

  DeepPlace run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else {
        count(c);
        if (brackets_ > kMaxDocumentDepth || dots_ > kMaxDocumentDepth) return {line_, column_};
        step();
      }
    }
    return {};
  }

 private:
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
};

}  // namespace

DeepPlace find_too_deep(std::string_view text) { return DepthScanner(text).run(); }

std::string too_deep_message() {
  return "nested deeper than " + std::to_string(kMaxDocumentDepth) + " levels";
}

}  // namespace knotwave::base
