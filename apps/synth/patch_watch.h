// SPDX-License-Identifier: MIT
// Which patch plays, and what happens to it on the disk: a saved change is compiled beside the
// sound; what is broken or gone is told and the old one plays on.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bank_input/bank_input.h"
#include "bank_loader.h"
#include "file_watch.h"

namespace knotwave::synth {

class PatchWatch {
 public:
  /// `bank` plays.
  explicit PatchWatch(const PlayableBank& bank);

  struct News {
    std::optional<PlayableBank> bank;  ///< to be installed
    std::vector<std::string> lines;    ///< to be told
  };
  /// Looks at the files and at what was compiled. Call it some ten times a second, and when
  /// descriptor() is ready.
  News poll(std::int64_t now_ns);
  int descriptor() const { return files_.descriptor(); }

  /// Another patch, once it is compiled; a broken one is told.
  void load(const std::string& path);
  /// The next patch file in the folder, behind the one tried last, in the order of names and round
  /// again. Banks and files of curves are passed over. None: there is no other.
  std::optional<std::string> next_in_folder() const;

  const std::string& path() const { return path_; }

 private:
  void installed(PlayableBank bank, News& news);

  std::string path_;   ///< of what plays
  std::string tried_;  ///< what load() was given last, good or broken
  bool is_trying_ = false;
  bool is_broken_ = false;  ///< what is on the disk under path_
  FileWatch files_;
  BankLoader loader_;
};

}  // namespace knotwave::synth
