// SPDX-License-Identifier: MIT
#include "keyboard.h"

namespace knotwave::synth {
namespace {

/// Semitones above the row's first C; black keys lie above the gaps they fill.
constexpr std::string_view kPiano = "awsedftgyhujkolp;'";
constexpr int kLowestOctave = -1, kHighestOctave = 9;

/// -1: no key of the piano.
int note_of(char key, int octave) {
  const std::size_t at = kPiano.find(key);
  if (at == std::string_view::npos) return -1;
  const int note = 12 * (octave + 1) + static_cast<int>(at);
  return note <= 127 ? note : -1;
}

}  // namespace

std::vector<KeyAction> Keyboard::type(std::string_view bytes, std::int64_t now_ns) {
  std::vector<KeyAction> actions;
  for (const char byte : bytes) {
    if (!skip_sequence(byte)) type_key(byte, now_ns, actions);
  }
  // Escape by itself: nothing of its sequence came with it.
  if (sequence_ == Sequence::escape) sequence_ = Sequence::none;
  return actions;
}

/// ECMA-48: ESC [ and ESC O begin sequences that end with a letter or ~; of ESC O it is the next.
bool Keyboard::skip_sequence(char byte) {
  switch (sequence_) {
    case Sequence::none:
      if (byte == '\x1b') sequence_ = Sequence::escape;
      return byte == '\x1b';
    case Sequence::escape:
      sequence_ =
          byte == '[' ? Sequence::parameters : (byte == 'O' ? Sequence::one_more : Sequence::none);
      return true;
    case Sequence::parameters:
      if (byte >= '@' && byte <= '~') sequence_ = Sequence::none;
      return true;
    case Sequence::one_more:
      sequence_ = Sequence::none;
      return true;
  }
  return false;
}

void Keyboard::type_key(char key, std::int64_t now_ns, std::vector<KeyAction>& actions) {
  using Kind = KeyAction::Kind;
  if (const int note = note_of(key, octave_); note >= 0) {
    std::int64_t& end = ends_[static_cast<std::size_t>(note)];
    if (end == 0) actions.push_back({Kind::note_on, note});
    end = now_ns + kHoldNs;
    return;
  }
  const int step = key == '+' || key == '=' ? 1 : (key == '-' || key == '_' ? -1 : 0);
  if (step != 0) {
    const int octave = octave_ + step;
    if (octave >= kLowestOctave && octave <= kHighestOctave) octave_ = octave;
    actions.push_back({Kind::octave, octave_});
    return;
  }
  switch (key) {
    case ' ':
      ends_.fill(0);
      actions.push_back({Kind::panic, 0});
      break;
    case 'r':
      actions.push_back({Kind::record, 0});
      break;
    case '\t':
      actions.push_back({Kind::next_patch, 0});
      break;
    case 'm':
      actions.push_back({Kind::learn, 0});
      break;
    case '?':
      actions.push_back({Kind::help, 0});
      break;
    case 'q':
      actions.push_back({Kind::quit, 0});
      break;
    default:
      break;
  }
}

std::vector<KeyAction> Keyboard::expire(std::int64_t now_ns) {
  std::vector<KeyAction> actions;
  for (std::size_t note = 0; note < ends_.size(); ++note) {
    if (ends_[note] == 0 || ends_[note] > now_ns) continue;
    ends_[note] = 0;
    actions.push_back({KeyAction::Kind::note_off, static_cast<int>(note)});
  }
  return actions;
}

std::int64_t Keyboard::next_end_ns() const {
  std::int64_t next = -1;
  for (const std::int64_t end : ends_) {
    if (end != 0 && (next < 0 || end < next)) next = end;
  }
  return next;
}

std::vector<std::string> keyboard_help() {
  return {"  w e   t y u   o p     notes: letters are white keys, those above them black;",
          " a s d f g h j k l ; '  held as long as the key repeats, else 0.3 s",
          "",
          " + -    octave up, down         tab    next patch",
          " space  notes and song off      r      record, stop recording",
          " m      learn a MIDI controller ?      this help",
          " q      quit (Ctrl-C as well)"};
}

}  // namespace knotwave::synth
