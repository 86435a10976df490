// SPDX-License-Identifier: MIT
#include "command_line/words.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "knotwave/base/suggest.h"

namespace knotwave::command_line {
namespace {

using Options = std::vector<const CLI::Option*>;

std::string in_quotes(std::string_view word) { return "'" + std::string(word) + "'"; }

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  }
  return text;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string suggested(std::string_view word, const std::vector<std::string>& known) {
  return base::suggestion(word, std::vector<std::string_view>(known.begin(), known.end()));
}

std::vector<std::string> long_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Reads words from left to right and keeps the first fault.
class WordReader {
 public:
  WordReader(const CLI::App& app, std::span<const char* const> words)
      : top_(app), command_(&app), words_(words.begin(), words.end()) {}

  std::string first_fault() {
    for (; at_ < words_.size() && fault_.empty(); ++at_) {
      const std::string_view word = words_[at_];
      if (word == "--")
        is_options_over_ = true;
      else if (is_options_over_ || word.size() < 2 || word[0] != '-')
        read_plain(word);
      else if (word[1] == '-')
        read_long(word);
      else
        read_short(word);
      if (asks_only_) return {};
    }
    return fault_;
  }

 private:
  const CLI::Option* find(const CLI::App& app, std::string_view name) const {
    return app.get_option_no_throw(std::string(name));
  }

  void read_long(std::string_view word) {
    const std::string_view name = word.substr(0, word.find('='));
    const CLI::Option* option = find(*command_, name);
    if (option == nullptr) {
      fault_ = unknown(name);
      return;
    }
    if (name.size() == word.size()) {
      read_option(*option, name, {}, false);
    } else {
      read_option(*option, name, word.substr(name.size() + 1), true);
    }
  }

  /// -x, -xVALUE, -x VALUE, -xyz; -long with one dash too few is told.
  void read_short(std::string_view word) {
    const std::string two_dashes = "-" + std::string(word.substr(0, word.find('=')));
    const CLI::Option* option = find(*command_, word.substr(0, 2));
    if (two_dashes.size() > 4 && find(*command_, two_dashes) != nullptr) {
      fault_ = "unknown option " + in_quotes(word) + "; did you mean '" + two_dashes + "'?";
    } else if (option == nullptr) {
      fault_ = "unknown option " + in_quotes(word);
    } else if (takes_value(*option) && word.size() > 2 && word[2] == '=') {
      const std::string value(word.substr(3));
      fault_ = in_quotes(word) + " has a '=' behind a short name; did you mean '" +
               std::string(word.substr(0, 2)) + " " + value + "' or '--" +
               option->get_lnames().front() + "=" + value + "'?";
    } else if (takes_value(*option)) {
      read_option(*option, word.substr(0, 2), word.substr(2), word.size() > 2);
    } else {
      read_option(*option, word.substr(0, 2), {}, false);
      if (word.size() > 2) read_short("-" + std::string(word.substr(2)));
    }
  }

  /// `value` is what is joined to the name, if anything is.
  void read_option(const CLI::Option& option, std::string_view name, std::string_view value,
                   bool is_joined) {
    if (!takes_value(option)) {
      if (is_joined) fault_ = std::string(name) + " takes no value, but got " + in_quotes(value);
      asks_only_ = name == "--help" || name == "-h" || name == "--version";
      return;
    }
    const bool has_next = at_ + 1 < words_.size() && !is_option(words_[at_ + 1]);
    if (!is_joined && has_next) value = words_[++at_];
    if (value.empty()) {
      fault_ = std::string(name) + " needs a value: " + option.get_type_name();
    } else if (!given_.insert(&option).second &&
               option.get_multi_option_policy() != CLI::MultiOptionPolicy::TakeAll) {
      fault_ = std::string(name) + " is given twice";
    }
  }

  bool is_option(std::string_view word) const {
    if (word.size() < 2 || word[0] != '-') return false;
    return find(*command_, word.substr(0, word[1] == '-' ? word.find('=') : 2)) != nullptr;
  }

  std::string unknown(std::string_view name) const {
    std::vector<std::string> owners;
    for (const CLI::App* command : commands_of(top_)) {
      if (find(*command, name) != nullptr) owners.push_back(in_quotes(command->get_name()));
    }
    const std::string place = command_ == &top_ ? "; give it after the command"
                                                : ", not of '" + command_->get_name() + "'";
    if (!owners.empty()) return std::string(name) + " is an option of " + listed(owners) + place;
    std::vector<std::string> known = long_names(*command_);
    if (command_ == &top_) {
      for (const CLI::App* command : commands_of(top_)) {
        for (auto& other : long_names(*command)) known.push_back(std::move(other));
      }
    }
    return "unknown option " + in_quotes(name) + suggested(name, known);
  }

  void read_plain(std::string_view word) {
    if (command_ == &top_ && !commands_of(top_).empty()) {
      read_command(word);
      return;
    }
    if (const std::string option = "--" + std::string(word); find(*command_, option) != nullptr) {
      fault_ = in_quotes(word) + " is no command; did you mean '" + option + "'?";
      return;
    }
    std::vector<std::string> places;
    std::size_t most = 0;
    for (const CLI::Option* option : command_->get_options()) {
      if (!option->get_positional()) continue;
      places.push_back(option->get_name(true));
      most += std::size_t(std::max(option->get_items_expected_max(), 0));
    }
    if (word.empty()) {
      fault_ = "an empty word stands where " + listed(places) + " should";
    } else if (++plain_ > most) {
      fault_ = in_quotes(word) + " is one word too many: " + listed(places) +
               (places.size() == 1 ? " is" : " are") + " given already";
    }
  }

  void read_command(std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(top_)) {
      if (command->get_name() == word) command_ = command;
      names.push_back(command->get_name());
    }
    if (command_ != &top_) return;
    const bool is_option_name = find(top_, "--" + std::string(word)) != nullptr;
    const std::string near =
        is_option_name ? "; did you mean '--" + std::string(word) + "'?" : suggested(word, names);
    fault_ = "unknown command " + in_quotes(word) +
             (near.empty() ? "; the commands are " + listed(names) : near);
  }

  const CLI::App& top_;
  const CLI::App* command_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0, plain_ = 0;
  bool is_options_over_ = false;
  bool asks_only_ = false;  ///< help or version: what follows is not looked at
  std::set<const CLI::Option*> given_;
  std::string fault_;
};

}  // namespace

std::string wrong_word(const CLI::App& app, std::span<const char* const> words) {
  return WordReader(app, words).first_fault();
}

}  // namespace knotwave::command_line
