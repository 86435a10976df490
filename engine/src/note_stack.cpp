// SPDX-License-Identifier: MIT
#include "knotwave/engine/note_stack.h"

#include <algorithm>

namespace knotwave::engine {

void NoteStack::erase(int index) KNOTWAVE_RT {
  const Entry& entry = entries_[static_cast<std::size_t>(index)];
  if (entry.serial != 0 && gone_count_ < gone_.size()) gone_[gone_count_++] = entry;
  std::copy(entries_.begin() + index + 1, entries_.begin() + size_, entries_.begin() + index);
  --size_;
}

void NoteStack::clear() KNOTWAVE_RT {
  while (size_ > 0) erase(size_ - 1);
}

void NoteStack::press(int key, int velocity, std::int32_t number,
                      std::uint64_t serial) KNOTWAVE_RT {
  bool sostenuto = false;
  for (int i = 0; i < size_; ++i) {
    if (entries_[static_cast<std::size_t>(i)].key != key) continue;
    sostenuto = entries_[static_cast<std::size_t>(i)].sostenuto;
    erase(i);
    break;
  }
  entries_[static_cast<std::size_t>(size_++)] = {static_cast<std::uint8_t>(key & 127),
                                                 static_cast<std::uint8_t>(velocity & 127),
                                                 true,
                                                 sostenuto,
                                                 number,
                                                 serial};
}

bool NoteStack::lift(int key, bool sustain, std::int32_t number) KNOTWAVE_RT {
  const bool is_there = number >= 0 && holds(number);
  for (int i = 0; i < size_; ++i) {
    Entry& entry = entries_[static_cast<std::size_t>(i)];
    const bool is_meant = is_there
                              ? entry.number == number
                              : entry.key == key && (number < 0 || entry.number == Event::kNoNote);
    if (!is_meant || !entry.key_down) continue;
    entry.key_down = false;
    if (!sustain && !entry.sostenuto) erase(i);
    return true;
  }
  return false;
}

bool NoteStack::holds(std::int32_t number) const KNOTWAVE_RT {
  return std::any_of(entries_.begin(), entries_.begin() + size_,
                     [number](const Entry& entry) { return entry.number == number; });
}

bool NoteStack::is_down(std::int32_t number) const KNOTWAVE_RT {
  return std::any_of(entries_.begin(), entries_.begin() + size_, [number](const Entry& entry) {
    return entry.key_down && entry.number == number;
  });
}

bool NoteStack::knows(std::uint64_t serial) const KNOTWAVE_RT {
  const auto is_it = [serial](const Entry& entry) { return entry.serial == serial; };
  return std::any_of(entries_.begin(), entries_.begin() + size_, is_it) ||
         std::any_of(gone().begin(), gone().end(), is_it);
}

void NoteStack::remove(int key, std::int32_t number) KNOTWAVE_RT {
  for (int i = size_ - 1; i >= 0; --i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    const bool is_key = key == Event::kEveryKey || entry.key == key;
    if (number >= 0 ? entry.number == number : is_key) erase(i);
  }
}

void NoteStack::drop_if(bool sustain) KNOTWAVE_RT {
  if (sustain) return;
  for (int i = size_ - 1; i >= 0; --i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    if (!entry.key_down && !entry.sostenuto) erase(i);
  }
}

void NoteStack::catch_sostenuto() KNOTWAVE_RT {
  for (int i = 0; i < size_; ++i) {
    Entry& entry = entries_[static_cast<std::size_t>(i)];
    if (entry.key_down) entry.sostenuto = true;
  }
}

void NoteStack::drop_sostenuto(bool sustain) KNOTWAVE_RT {
  for (int i = 0; i < size_; ++i) entries_[static_cast<std::size_t>(i)].sostenuto = false;
  drop_if(sustain);
}

void NoteStack::drop_sustain() KNOTWAVE_RT { drop_if(false); }

void NoteStack::lift_all(bool sustain) KNOTWAVE_RT {
  for (int i = 0; i < size_; ++i) entries_[static_cast<std::size_t>(i)].key_down = false;
  drop_if(sustain);
}

const NoteStack::Entry* NoteStack::choose(NotePriority priority) const KNOTWAVE_RT {
  const Entry* best = nullptr;
  for (int i = 0; i < size_; ++i) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    if (best == nullptr || (entry.key_down && !best->key_down)) {
      best = &entry;
      continue;
    }
    if (entry.key_down != best->key_down) continue;
    const bool better = priority == NotePriority::last ||
                        (priority == NotePriority::low && entry.key < best->key) ||
                        (priority == NotePriority::high && entry.key > best->key);
    if (better) best = &entry;
  }
  return best;
}

}  // namespace knotwave::engine
