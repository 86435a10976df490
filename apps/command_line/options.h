// SPDX-License-Identifier: MIT
// Options whose wrong values are answered with what is allowed. Built on CLI11, which only the
// options.cpp of a program sees besides.
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace knotwave::command_line {

/// A number as from_chars reads it, the whole text, finite.
std::optional<double> number_in(std::string_view text);

/// What an option takes and what it says: `names` as CLI11 wants them ("-o,--output").
struct OptionText {
  std::string names;
  std::string about;
  std::string type;  ///< what stands behind the name in the help; for numbers the range by itself
};

/// `target` keeps its value, which the help names as the default, until the option is given.
void add_number(CLI::App& app, const OptionText& text, int& target, int least, int most);
void add_number(CLI::App& app, const OptionText& text, double& target, double least, double most);
/// 0 to 2^64 - 1.
void add_number(CLI::App& app, const OptionText& text, std::uint64_t& target);
/// One of `words`; `take` is given its index.
void add_choice(CLI::App& app, const OptionText& text, std::vector<std::string> words,
                std::function<void(std::size_t)> take);
/// Any text that is not empty.
void add_text(CLI::App& app, const OptionText& text, std::string& target);
/// The same, given any number of times.
void add_texts(CLI::App& app, const OptionText& text, std::vector<std::string>& target);
/// `take` returns what is wrong with the text, or nothing.
void add_checked(CLI::App& app, const OptionText& text,
                 std::function<std::string(const std::string&)> take);
void add_flag(CLI::App& app, const OptionText& text, bool& target);

/// Sets up help, version and the layout that all our programs share.
void prepare(CLI::App& app, const std::string& examples);

/// Reads the words into the targets. An exit code when there is nothing (more) to do: help, version
/// and usage errors are printed here. `conflict` is asked last for what is wrong with values that
/// are each good in themselves.
std::optional<int> read_words(CLI::App& app, int argc, char** argv,
                              const std::function<std::string()>& conflict);

}  // namespace knotwave::command_line
