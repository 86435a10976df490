// SPDX-License-Identifier: MIT
// A slot goes free -> filling -> named; a handler reads named slots only.
#include "unfinished_files.h"

#include <array>
#include <atomic>
#include <cstring>

#include <unistd.h>

#include "knotwave/base/file.h"

namespace knotwave::base {
namespace {

constexpr std::size_t kMaxPath = 4096;
constexpr int kFree = 0;
constexpr int kFilling = 1;
constexpr int kNamed = 2;

struct Slot {
  std::atomic<int> state{kFree};
  std::array<char, kMaxPath> path{};
};
std::array<Slot, kMaxUnfinishedFiles> slots;
static_assert(std::atomic<int>::is_always_lock_free, "signal handlers read it");

}  // namespace

int note_unfinished_file(std::string_view part_path) noexcept {
  if (part_path.size() >= kMaxPath) return -1;
  for (int i = 0; i < kMaxUnfinishedFiles; ++i) {
    Slot& slot = slots[static_cast<std::size_t>(i)];
    int expected = kFree;
    if (!slot.state.compare_exchange_strong(expected, kFilling)) continue;
    std::memcpy(slot.path.data(), part_path.data(), part_path.size());
    slot.path[part_path.size()] = '\0';
    slot.state.store(kNamed);
    return i;
  }
  return -1;
}

void forget_unfinished_file(int slot) noexcept {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].state.store(kFree);
}

bool is_unfinished_here(std::string_view part_path) noexcept {
  for (const Slot& slot : slots) {
    if (slot.state.load() == kNamed && part_path == slot.path.data()) return true;
  }
  return false;
}

void remove_unfinished_files() noexcept {
  for (const Slot& slot : slots) {
    if (slot.state.load() == kNamed) ::unlink(slot.path.data());
  }
}

}  // namespace knotwave::base
