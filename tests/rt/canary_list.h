// SPDX-License-Identifier: MIT
// Deliberately bad callbacks, one per class of fault. Each must be caught by the gate named.
#pragma once
#include <array>
#include <ostream>

#include "rt_gate.h"

namespace knotwave::rt {

struct Canary {
  const char* name;
  Gate gate;
  const char* words;  ///< in what is printed when it is caught

  friend void PrintTo(const Canary& canary, std::ostream* out) { *out << canary.name; }
};

inline constexpr const char* kSanitizer = "in real-time context";
inline constexpr const char* kCalls = "system calls";
inline constexpr const char* kFaults = "page faults";

inline constexpr std::array kCanaries = {
    Canary{"malloc", Gate::sanitizer, kSanitizer},
    Canary{"calloc", Gate::sanitizer, kSanitizer},
    Canary{"realloc", Gate::sanitizer, kSanitizer},
    Canary{"aligned_alloc", Gate::sanitizer, kSanitizer},
    Canary{"free", Gate::sanitizer, kSanitizer},
    Canary{"new", Gate::sanitizer, kSanitizer},
    Canary{"delete", Gate::sanitizer, kSanitizer},
    Canary{"vector_grows", Gate::sanitizer, kSanitizer},
    Canary{"string_built", Gate::sanitizer, kSanitizer},
    Canary{"map_insert", Gate::sanitizer, kSanitizer},
    Canary{"function_with_large_capture", Gate::sanitizer, kSanitizer},
    Canary{"shared_pointer_made", Gate::sanitizer, kSanitizer},
    Canary{"last_shared_pointer_dropped", Gate::sanitizer, kSanitizer},
    Canary{"stable_sort", Gate::sanitizer, kSanitizer},
    Canary{"number_to_stream", Gate::sanitizer, kSanitizer},
    Canary{"throw", Gate::sanitizer, kSanitizer},
    Canary{"mutex_lock", Gate::sanitizer, kSanitizer},
    Canary{"shared_mutex_lock", Gate::sanitizer, kSanitizer},
    Canary{"condition_wait", Gate::sanitizer, kSanitizer},
    Canary{"thread_start", Gate::sanitizer, kSanitizer},
    Canary{"sleep", Gate::sanitizer, kSanitizer},
    Canary{"puts", Gate::sanitizer, kSanitizer},
    Canary{"fopen", Gate::sanitizer, kSanitizer},
    Canary{"open", Gate::sanitizer, kSanitizer},
    Canary{"socket", Gate::sanitizer, kSanitizer},
    Canary{"write", Gate::system, kCalls},
    Canary{"yield", Gate::system, kCalls},
    Canary{"mmap", Gate::system, kCalls},
    Canary{"contended_atomic_wait", Gate::system, kCalls},
    Canary{"process_id", Gate::system, kCalls},
    Canary{"fresh_pages", Gate::system, kFaults},
};

}  // namespace knotwave::rt
