// SPDX-License-Identifier: MIT
// rt_canary NAME: does one bad thing inside the gate that should catch it. Ends with 3 and what was
// found, or with 0 and "not caught"; a hit of the sanitizer ends it before.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <shared_mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "canary_list.h"
#include "rt_gate.h"

namespace {

/// What escapes through here cannot be optimised away.
void* volatile escaped;
volatile int length = 100;

// Made before the gate, misused inside.
void* block = nullptr;
int* object = nullptr;
std::vector<int> numbers(100);
std::map<int, int> dictionary;
std::shared_ptr<int> shared;
std::function<int()> callable;
std::mutex mutex;
std::shared_mutex shared_mutex;
std::condition_variable condition;
std::thread started;
std::atomic<int> word{1};
volatile char* pages = nullptr;
constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kPages = 64;

void prepare() {
  block = std::malloc(64);
  object = new int(1);
  shared = std::make_shared<int>(1);
  pages = static_cast<volatile char*>(::mmap(nullptr, kPages * kPageBytes, PROT_READ | PROT_WRITE,
                                             MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
}

void build_string() {
  const std::string text(static_cast<std::size_t>(length), 'x');
  escaped = const_cast<char*>(text.data());
}
void make_function() {
  struct {
    long long data[16];
  } large{};
  large.data[0] = length;
  callable = [large] { return static_cast<int>(large.data[0]); };
}
void to_stream() {
  std::ostringstream stream;
  stream << "a text longer than what a string holds in itself" << 1.5;
  escaped = &stream;
}
void throw_and_catch() {
  try {
    if (length > 0) throw 1;
  } catch (int) {
    length = 99;
  }
}
void wait_on_condition() {
  std::unique_lock<std::mutex> lock(mutex);
  condition.wait_for(lock, std::chrono::microseconds(1));
}
void touch_pages() {
  for (std::size_t i = 0; i < kPages; ++i) pages[i * kPageBytes] = 1;
}

struct Deed {
  const char* name;
  void (*function)();
};
const Deed kDeeds[] = {
    {"malloc", [] { escaped = std::malloc(32); }},
    {"calloc", [] { escaped = std::calloc(4, 8); }},
    {"realloc", [] { escaped = std::realloc(block, 4096); }},
    {"aligned_alloc", [] { escaped = std::aligned_alloc(64, 64); }},
    {"free", [] { std::free(block); }},
    {"new", [] { escaped = new int(2); }},
    {"delete", [] { delete object; }},
    {"vector_grows", [] { numbers.push_back(1); }},
    {"string_built", build_string},
    {"map_insert", [] { dictionary.emplace(int{length}, 1); }},
    {"function_with_large_capture", make_function},
    {"shared_pointer_made", [] { shared = std::make_shared<int>(2); }},
    {"last_shared_pointer_dropped", [] { shared.reset(); }},
    {"stable_sort", [] { std::stable_sort(numbers.begin(), numbers.end()); }},
    {"number_to_stream", to_stream},
    {"throw", throw_and_catch},
    {"mutex_lock", [] { const std::lock_guard<std::mutex> lock(mutex); }},
    {"shared_mutex_lock", [] { const std::shared_lock<std::shared_mutex> lock(shared_mutex); }},
    {"condition_wait", wait_on_condition},
    {"thread_start", [] { started = std::thread([] {}); }},
    {"sleep", [] { std::this_thread::sleep_for(std::chrono::microseconds(1)); }},
    {"puts", [] { std::puts("x"); }},
    {"fopen", [] { escaped = std::fopen("/dev/null", "r"); }},
    {"open", [] { length = ::open("/dev/null", O_RDONLY); }},
    {"socket", [] { length = ::socket(AF_UNIX, SOCK_STREAM, 0); }},
    {"write", [] { length = static_cast<int>(::write(2, "x", 1)); }},
    {"yield", [] { std::this_thread::yield(); }},
    {"mmap",
     [] { escaped = ::mmap(nullptr, kPageBytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); }},
    {"contended_atomic_wait",
     [] { length = static_cast<int>(::syscall(SYS_futex, &word, 0, 1, nullptr, nullptr, 0)); }},
    {"process_id", [] { length = static_cast<int>(::getppid()); }},
    {"fresh_pages", touch_pages},
};

void (*find_deed(const std::string& name))() {
  for (const Deed& deed : kDeeds) {
    if (deed.name == name) return deed.function;
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  for (const knotwave::rt::Canary& canary : knotwave::rt::kCanaries) {
    if (canary.name != name) continue;
    const auto report = knotwave::rt::run_in_gate(canary.gate, find_deed(name), prepare);
    const std::string findings = report.findings();
    std::fprintf(stderr, "%s\n", findings.empty() ? "not caught" : findings.c_str());
    std::_Exit(findings.empty() ? 0 : 3);
  }
  std::fprintf(stderr, "no canary '%s'\n", name.c_str());
  return 2;
}
