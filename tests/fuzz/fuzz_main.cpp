// SPDX-License-Identifier: MIT
// Drives a fuzz target without libFuzzer, in its words: -runs=N -seed=S, and folders of seeds. Each
// input is a seed with a few random edits; the one that fails is kept as crash-RUN.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "knotwave/base/random.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kMaxInputBytes = 1 << 16;

Bytes current_input;
long current_run = 0;

extern "C" void keep_input(int signal) {
  const std::string name = "crash-" + std::to_string(current_run);
  if (std::FILE* file = std::fopen(name.c_str(), "wb")) {
    std::fwrite(current_input.data(), 1, current_input.size(), file);
    std::fclose(file);
  }
  std::fprintf(stderr, "run %ld fails; its input is in %s\n", current_run, name.c_str());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

Bytes bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  bytes.resize(std::min(bytes.size(), kMaxInputBytes));
  return bytes;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) { stream_.seed = seed; }
  std::size_t below(std::size_t n) { return n == 0 ? 0 : stream_.bits(next_++) % n; }

 private:
  knotwave::base::RandomStream stream_;
  std::uint64_t next_ = 0;
};

void edit(Bytes& bytes, const std::vector<Bytes>& seeds, Random& random) {
  constexpr std::uint8_t kEdges[] = {0x00, 0x01, 0x7F, 0x80, 0xF0, 0xF7, 0xFF, 0x2F, 0x51};
  const std::size_t at = random.below(bytes.size() + 1);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t count = std::min(random.below(16) + 1, bytes.size() - at);
  switch (random.below(6)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(random.below(256));
      break;
    case 1:
      if (at < bytes.size()) bytes[at] = kEdges[random.below(std::size(kEdges))];
      break;
    case 2:
      bytes.insert(place, static_cast<std::uint8_t>(random.below(256)));
      break;
    case 3:
      bytes.erase(place, place + static_cast<std::ptrdiff_t>(count));
      break;
    case 4: {
      const Bytes copy(place, place + static_cast<std::ptrdiff_t>(count));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random.below(bytes.size() + 1)),
                   copy.begin(), copy.end());
      break;
    }
    default: {
      const Bytes& other = seeds[random.below(seeds.size())];
      const std::size_t from = random.below(other.size() + 1);
      bytes.resize(at);
      bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  long runs = 1000;
  std::uint64_t seed = 1;
  std::vector<Bytes> seeds;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "-runs=", 6) == 0) {
      runs = std::atol(argv[i] + 6);
    } else if (std::strncmp(argv[i], "-seed=", 6) == 0) {
      seed = std::strtoull(argv[i] + 6, nullptr, 10);
    } else if (fs::is_directory(argv[i])) {
      for (const auto& entry : fs::recursive_directory_iterator(argv[i])) {
        if (entry.is_regular_file()) seeds.push_back(bytes_of(entry.path()));
      }
    }
  }
  std::sort(seeds.begin(), seeds.end());  // the order of a folder is not fixed
  if (seeds.empty()) {
    std::fprintf(stderr, "no seeds: name a folder that holds some\n");
    return 2;
  }
  std::signal(SIGABRT, keep_input);
  std::signal(SIGSEGV, keep_input);
  Random random(seed);
  for (; current_run < runs; ++current_run) {
    const auto number = static_cast<std::size_t>(current_run);
    current_input = seeds[number % seeds.size()];
    const std::size_t edits = number < seeds.size() ? 0 : random.below(8) + 1;
    for (std::size_t i = 0; i < edits; ++i) edit(current_input, seeds, random);
    LLVMFuzzerTestOneInput(current_input.data(), current_input.size());
  }
  std::printf("%ld runs from %zu seeds, -seed=%llu\n", runs, seeds.size(),
              static_cast<unsigned long long>(seed));
  return 0;
}
