// SPDX-License-Identifier: MIT
#include "command_line/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>

#include "knotwave/base/suggest.h"

#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "command_line/words.h"

namespace knotwave::command_line {
namespace {

template <typename Number>
std::optional<Number> read_whole(std::string_view text) {
  Number value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string text_of(double value) {
  char text[400];  // the longest double in digits has 309 of them
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr};
}
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(std::uint64_t value) { return std::to_string(value); }

constexpr std::size_t kNameColumns = 26;  ///< of the help: names, and behind them what they mean
constexpr std::size_t kTextColumns = 54;

/// Breaks lines at blanks; the layout indents what follows a break.
std::string wrapped(const std::string& text) {
  std::string out;
  std::size_t column = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const bool is_over = column > 0 && column + 1 + end - at > kTextColumns;
    if (column > 0) out += is_over ? '\n' : ' ';
    column = is_over || column == 0 ? end - at : column + 1 + end - at;
    out += text.substr(at, end - at);
    at = end + 1;
  }
  return out;
}

/// Help that fits a terminal of 80 columns.
class HelpLayout : public CLI::Formatter {
 public:
  HelpLayout() { column_width(kNameColumns); }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(CLI::Formatter::make_option_desc(option));
  }
  /// Where two files are taken, both are needed.
  std::string make_option_usage(const CLI::Option* option) const override {
    if (option->get_expected_max() != 2) return CLI::Formatter::make_option_usage(option);
    const std::string name = make_option_name(option, true);
    return name + " " + name;
  }
};

template <typename Number>
void add_ranged(CLI::App& app, const OptionText& text, Number& target, Number least, Number most,
                std::optional<Number> (*read)(std::string_view), const char* kind) {
  const std::string range = text_of(least) + " to " + text_of(most);
  const auto take = [=, &target](const std::string& word) -> std::string {
    const auto value = read(word);
    if (!value || *value < least || *value > most) {
      return "'" + word + "' is not " + kind + " from " + range;
    }
    target = *value;
    return {};
  };
  const std::string type = text.type.empty() ? "NUMBER" : text.type;
  const bool has_default = least <= target && target <= most;
  const std::string about =
      text.about + " (" + range + (has_default ? "; " + text_of(target) + " if not given)" : ")");
  add_checked(app, {text.names, about, type}, take);
}

}  // namespace

std::optional<double> number_in(std::string_view text) {
  const auto value = read_whole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

void add_checked(CLI::App& app, const OptionText& text,
                 std::function<std::string(const std::string&)> take) {
  const std::string name = text.names.substr(text.names.rfind(',') + 1);
  app.add_option_function<std::string>(
         text.names,
         [name, take = std::move(take)](const std::string& word) {
           const std::string fault = take(word);
           if (!fault.empty()) throw CLI::ValidationError(name + ": " + fault);
         },
         text.about)
      ->type_name(text.type);
}

void add_number(CLI::App& app, const OptionText& text, int& target, int least, int most) {
  add_ranged(app, text, target, least, most, read_whole<int>, "a whole number");
}

void add_number(CLI::App& app, const OptionText& text, double& target, double least, double most) {
  add_ranged(app, text, target, least, most, number_in, "a number");
}

void add_number(CLI::App& app, const OptionText& text, std::uint64_t& target) {
  add_ranged(app, text, target, std::uint64_t{0}, ~std::uint64_t{0}, read_whole<std::uint64_t>,
             "a whole number");
}

void add_choice(CLI::App& app, const OptionText& text, std::vector<std::string> words,
                std::function<void(std::size_t)> take) {
  std::string type;
  for (const auto& word : words) type += (type.empty() ? "" : "|") + word;
  add_checked(app, {text.names, text.about, type},
              [words = std::move(words), take = std::move(take)](const std::string& given) {
                std::string list;
                for (std::size_t i = 0; i < words.size(); ++i) {
                  if (words[i] == given) return take(i), std::string();
                  list += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
                }
                const std::vector<std::string_view> known(words.begin(), words.end());
                return "'" + given + "' is not " + list + base::suggestion(given, known);
              });
}

void add_text(CLI::App& app, const OptionText& text, std::string& target) {
  app.add_option(text.names, target, text.about)->type_name(text.type);
}

void add_texts(CLI::App& app, const OptionText& text, std::vector<std::string>& target) {
  app.add_option(text.names, target, text.about)
      ->type_name(text.type)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_flag(CLI::App& app, const OptionText& text, bool& target) {
  app.add_flag(text.names, target, text.about)->disable_flag_override();
}

void prepare(CLI::App& app, const std::string& examples) {
  app.footer(examples);
  app.set_version_flag("--version", app.get_name() + " " + KNOTWAVE_VERSION,
                       "print the version and stop");
  app.formatter(std::make_shared<HelpLayout>());
  app.set_help_flag("-h,--help", "print this and stop");
}

std::optional<int> read_words(CLI::App& app, int argc, char** argv,
                              const std::function<std::string()>& conflict) {
  const std::span<const char* const> words(argv, static_cast<std::size_t>(argc));
  std::string fault = wrong_word(app, words.subspan(words.empty() ? 0 : 1));
  try {
    if (fault.empty()) app.parse(argc, argv);
  } catch (const CLI::Success& done) {
    std::ostringstream text;
    const int code = app.exit(done, text, text);
    const int printed = print(app.get_name(), text.str());
    return printed == kExitOk ? code : printed;
  } catch (const CLI::ParseError& error) {
    fault = error.what();
  }
  if (fault.empty()) fault = conflict();
  if (fault.empty()) return std::nullopt;
  return say_usage(app.get_name(), fault);
}

}  // namespace knotwave::command_line
