// SPDX-License-Identifier: MIT
// Looks at the words of a command line one by one, before their values are read, so that a wrong
// one is named, with the nearest right one.
#pragma once
#include <span>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace knotwave::command_line {

/// What is wrong with the first wrong word; empty when none is: unknown options and commands,
/// options of another command, values that are missing or empty, options given twice, words too
/// many. `words` are without the program's name.
std::string wrong_word(const CLI::App& app, std::span<const char* const> words);

}  // namespace knotwave::command_line
