// SPDX-License-Identifier: MIT
#include "svg_file.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "knotwave/base/document.h"

namespace knotwave::curve_app {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

/// The character an entity such as "amp" or "#10" stands for.
std::optional<char> character_of(std::string_view entity) {
  constexpr std::pair<std::string_view, char> kNamed[] = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  for (const auto& [name, character] : kNamed) {
    if (entity == name) return character;
  }
  if (!entity.starts_with('#')) return std::nullopt;
  const bool is_hex = entity.substr(1).starts_with('x');
  const std::string_view digits = entity.substr(is_hex ? 2 : 1);
  int code = 0;
  const auto read =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, is_hex ? 16 : 10);
  if (digits.empty() || read.ptr != digits.data() + digits.size() || code < 1 || code > 127) {
    return std::nullopt;
  }
  return static_cast<char>(code);
}

constexpr std::size_t kLongestEntity = 12;

/// Entities that are not read are kept as they stand.
std::string decoded(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view word = text[at] == '&' ? text.substr(at + 1, kLongestEntity) : "";
    const std::size_t end = word.find(';');
    const auto character =
        end == std::string_view::npos ? std::nullopt : character_of(word.substr(0, end));
    plain += character.value_or(text[at]);
    at += character ? end + 2 : 1;
  }
  return plain;
}

/// Tags from left to right; text between them is nothing to us.
class Drawing {
 public:
  Drawing(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  Result<std::vector<SvgElement>> paths() {
    while ((at_ = text_.find('<', at_)) != std::string_view::npos && fault_.empty()) {
      start_ = at_;
      if (begins("<!--")) {
        skip_past("-->");
      } else if (begins("<![CDATA[")) {
        skip_past("]]>");
      } else if (begins("<?")) {
        skip_past("?>");
      } else if (begins("<!")) {
        skip_declaration();
      } else if (begins("</")) {
        skip_past(">");
        if (!transforms_.empty()) transforms_.pop_back();
      } else {
        read_tag();
      }
    }
    if (fault_.empty()) return std::move(found_);
    return Error{ErrorCode::malformed, fault_, source_, line(), 0, -1};
  }

 private:
  bool begins(std::string_view mark) const { return text_.substr(at_).starts_with(mark); }
  /// Of start_, which only grows.
  int line() {
    const auto from = text_.begin() + std::ptrdiff_t(std::exchange(counted_, start_));
    line_ += static_cast<int>(std::count(from, text_.begin() + std::ptrdiff_t(start_), '\n'));
    return line_;
  }
  void skip_past(std::string_view mark) {
    const std::size_t end = text_.find(mark, at_);
    if (end == std::string_view::npos)
      fault_ = "what begins here has no end: '" + std::string(mark) + "' is missing";
    at_ = end == std::string_view::npos ? text_.size() : end + mark.size();
  }
  /// <!DOCTYPE ...>, with a bracketed part or without.
  void skip_declaration() {
    const std::size_t bracket = text_.find('[', at_), end = text_.find('>', at_);
    if (bracket < end) skip_past("]");
    skip_past(">");
  }

  void read_tag() {
    ++at_;
    const std::string_view name = word();
    SvgElement element;
    bool has_d = false;
    element.is_transformed = !transforms_.empty() && transforms_.back();
    while (fault_.empty()) {
      at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
      if (begins("/>") || begins(">")) break;
      const std::string_view key = word();
      const std::string value = read_value(key);
      if (key == "id") element.id = value;
      if (key == "transform") element.is_transformed = true;
      if (key == "d") element.d = value, has_d = true;
    }
    if (begins(">")) transforms_.push_back(element.is_transformed);
    element.line = line();
    const std::string_view local = name.substr(name.rfind(':') + 1);
    if (local == "path" && has_d && fault_.empty()) found_.push_back(std::move(element));
  }

  std::string_view word() {
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/><\"'", at_), text_.size());
    return text_.substr(std::exchange(at_, end), end - at_);
  }

  std::string read_value(std::string_view key) {
    at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size());
    const bool has_value = !key.empty() && begins("=");
    if (has_value) at_ = std::min(text_.find_first_not_of(kSpace, at_ + 1), text_.size());
    const char quote = has_value && at_ < text_.size() ? text_[at_] : ' ';
    const std::size_t end =
        quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : std::string_view::npos;
    if (end == std::string_view::npos) {
      fault_ = "this tag is not well formed";
      return {};
    }
    return decoded(text_.substr(std::exchange(at_, end + 1) + 1, end - at_ - 1));
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0, start_ = 0, counted_ = 0;
  int line_ = 1;
  std::vector<bool> transforms_;  ///< of the open elements: is one of them or around them moved?
  std::vector<SvgElement> found_;
  std::string fault_;
};

}  // namespace

Result<std::vector<SvgElement>> svg_paths(std::string_view text, const std::string& source) {
  return Drawing(text, source).paths();
}

std::string svg_drawing(std::string_view id, std::string_view d, const SvgFrame& frame) {
  using base::number_text;
  const std::string width = number_text(frame.width), height = number_text(frame.height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" + number_text(frame.x) + " " +
         number_text(frame.y) + " " + width + " " + height +
         "\" preserveAspectRatio=\"none\" width=\"960\" height=\"540\">\n"
         "<path id=\"" +
         std::string(id) + "\" d=\"" + std::string(d) +
         "\"\n fill=\"none\" stroke=\"black\" stroke-width=\"2\" "
         "vector-effect=\"non-scaling-stroke\"/>\n</svg>\n";
}

}  // namespace knotwave::curve_app
