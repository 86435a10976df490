// SPDX-License-Identifier: MIT
// The synth as a program: player, patch, keys, page, network and takes, looked after by one thread.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "keyboard.h"
#include "options.h"
#include "osc_door.h"
#include "patch_watch.h"
#include "player.h"
#include "recorder.h"
#include "resume.h"
#include "song/song_file.h"
#include "status.h"
#include "terminal.h"

namespace knotwave::synth {

/// What is played, and what it is called to the user.
struct Performance {
  PlayableBank bank;
  std::string name;  ///< empty: as its file
  std::optional<song::SongFile> song;
  std::string song_name;
};

class Synth {
 public:
  /// Sounds when it returns. Errors: those of the devices, of OSC and of the file to record into.
  static Result<std::unique_ptr<Synth>> open(const SynthOptions& options, Performance performance,
                                             const Resume& resume);
  ~Synth();

  enum class End {
    asked,    ///< by a key, or the time is over
    signal,   ///< `signals` counts some
    restart,  ///< a device's library hangs: start the program anew, with resume()
  };
  /// Until something ends it; the sound is faded out then and the take complete.
  End run(const std::atomic<int>& signals);
  Resume resume() const;
  /// Something that was asked for is not there in the end: a take, whole.
  bool has_failed() const { return has_failed_; }

 private:
  explicit Synth(const SynthOptions& options);
  void tick(std::int64_t now_ns);
  void follow_patch();
  void follow_network();
  void follow_take();
  void follow_song();
  bool is_time_over(std::int64_t now_ns) const;
  Result<void> open_learn();
  void learn_next();
  void follow_learn();
  void follow_targets(std::size_t patch);
  void read_keys(std::int64_t now_ns);
  void act(const KeyAction& action, std::int64_t now_ns);
  void next_patch();
  bool next_program();
  void choose_entry(std::size_t entry);
  void wait(std::int64_t now_ns) const;

  Result<void> begin_take();
  void end_take();
  std::vector<std::string> write_beside(const Recorder::Take& take);

  void tell(const std::string& line);
  void tell_all(const std::vector<std::string>& lines);
  SynthStatus status(std::int64_t now_ns);
  void show(std::int64_t now_ns);
  void show_line(const SynthStatus& status);
  void write_line(const std::string& line);

  SynthOptions options_;
  std::string name_, first_path_, song_name_;
  std::unique_ptr<Player> player_;
  std::unique_ptr<PatchWatch> watch_;
  std::unique_ptr<OscDoor> osc_;
  std::unique_ptr<Recorder> recorder_;
  Keyboard keyboard_;
  KeyInput keys_;
  std::unique_ptr<Screen> screen_;
  std::vector<std::string> messages_;
  std::vector<std::string> told_later_;  ///< on standard error, once the page is gone
  std::int64_t start_ns_, next_tick_ns_ = 0, next_page_ns_ = 0, next_line_ns_ = 0;
  std::string last_line_;
  std::size_t program_entry_ = 0;
  std::size_t next_controller_ = 0;  ///< of the patch's, to be learnt
  int takes_ = 0;
  bool is_help_shown_ = false, is_quitting_ = false, has_failed_ = false, is_reader_gone_ = false;
  bool is_song_told_ = false;
};

}  // namespace knotwave::synth
