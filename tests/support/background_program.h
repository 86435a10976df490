// SPDX-License-Identifier: MIT
// A program that runs beside a test: a server. It ends with the test, however that ends.
#pragma once
#include <string>
#include <vector>

#include <sys/types.h>

namespace knotwave::support {

class BackgroundProgram {
 public:
  /// Looked for in PATH. Standard input is /dev/null, both outputs are added to the file `log`.
  BackgroundProgram(std::vector<std::string> argv, const std::string& log);
  ~BackgroundProgram();  ///< SIGTERM, and waits
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  bool runs();
  void signal(int number) const;
  void end(int number);  ///< sends the signal and waits; nothing where it has ended

 private:
  pid_t process_ = -1;
};

/// A variable of the environment, as it was again when the object goes.
class SetVariable {
 public:
  SetVariable(std::string name, const std::string& value);
  ~SetVariable();
  SetVariable(const SetVariable&) = delete;
  SetVariable& operator=(const SetVariable&) = delete;

 private:
  std::string name_, before_;
  bool was_set_;
};

}  // namespace knotwave::support
