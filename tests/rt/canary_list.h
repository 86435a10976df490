// SPDX-License-Identifier: MIT
// Deliberately bad callbacks, one per class of fault. Each must be caught by the layer named.
#pragma once
#include <array>

namespace knotwave::rt {

enum class Layer { sanitizer, filter, rusage };

struct Canary {
  const char* name;
  Layer layer;
};

inline constexpr std::array kCanaries = {
    Canary{"malloc", Layer::sanitizer},
    Canary{"calloc", Layer::sanitizer},
    Canary{"realloc", Layer::sanitizer},
    Canary{"aligned_alloc", Layer::sanitizer},
    Canary{"free", Layer::sanitizer},
    Canary{"new", Layer::sanitizer},
    Canary{"delete", Layer::sanitizer},
    Canary{"vector_grows", Layer::sanitizer},
    Canary{"string_built", Layer::sanitizer},
    Canary{"map_insert", Layer::sanitizer},
    Canary{"function_with_large_capture", Layer::sanitizer},
    Canary{"shared_pointer_made", Layer::sanitizer},
    Canary{"last_shared_pointer_dropped", Layer::sanitizer},
    Canary{"stable_sort", Layer::sanitizer},
    Canary{"number_to_stream", Layer::sanitizer},
    Canary{"throw", Layer::sanitizer},
    Canary{"mutex_lock", Layer::sanitizer},
    Canary{"shared_mutex_lock", Layer::sanitizer},
    Canary{"condition_wait", Layer::sanitizer},
    Canary{"thread_start", Layer::sanitizer},
    Canary{"sleep", Layer::sanitizer},
    Canary{"puts", Layer::sanitizer},
    Canary{"fopen", Layer::sanitizer},
    Canary{"open", Layer::sanitizer},
    Canary{"socket", Layer::sanitizer},
    Canary{"write", Layer::filter},
    Canary{"yield", Layer::filter},
    Canary{"mmap", Layer::filter},
    Canary{"contended_atomic_wait", Layer::filter},
    Canary{"process_id", Layer::filter},
    Canary{"fresh_pages", Layer::rusage},
};

}  // namespace knotwave::rt
