// SPDX-License-Identifier: MIT
// Runs a fuzz target without libFuzzer: every file of the folders given, then --runs N seeded
// mutations of them. KNOTWAVE_SEED chooses the seed; the input that fails is left in
// mutate_failed.bin.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

namespace fs = std::filesystem;

std::string current;  // what is being tried, kept for the report of a crash

extern "C" void keep_input(int signal) {
  if (FILE* file = std::fopen("mutate_failed.bin", "wb")) {
    std::fwrite(current.data(), 1, current.size(), file);
    std::fclose(file);
  }
  std::fputs("failed; the input is in mutate_failed.bin\n", stderr);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void try_input(std::string input) {
  current = std::move(input);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(current.data()), current.size());
}

std::vector<std::string> read_corpus(const std::vector<std::string>& folders) {
  std::vector<fs::path> paths;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

class Mutator {
 public:
  Mutator(const std::vector<std::string>& corpus, std::uint64_t seed)
      : corpus_(corpus), random_(seed) {}

  std::string next() {
    std::string text = corpus_[below(corpus_.size())];
    for (std::size_t i = 1 + below(6); i > 0; --i) mutate(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void mutate(std::string& text) {
    constexpr const char* kTokens[] = {"[",  "]",    "\n",           "nan",   "-1",   "1e308",
                                       "0",  "\"",   "true",         "= [",   "{",    "}",
                                       ".",  "x",    "1e-9",         "99999", "-0.0", "\xff",
                                       "\0", "#",    "\n[[maps]]\n", "0.5",   "1/0",  "16",
                                       "a",  "\r\n", "2147483648"};
    const std::size_t at = below(text.size() + 1);
    switch (below(6)) {
      case 0:  // a token
        text.insert(at, kTokens[below(std::size(kTokens))]);
        break;
      case 1:  // fewer
        text.erase(at, 1 + below(20));
        break;
      case 2:  // a bit
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 3: {  // a piece of another file
        const std::string& other = corpus_[below(corpus_.size())];
        text.insert(at, other.substr(below(other.size() + 1), 1 + below(80)));
        break;
      }
      case 4:  // a piece twice
        text.insert(at, text.substr(below(text.size() + 1), 1 + below(40)));
        break;
      default:  // the rest away
        text.resize(at);
    }
  }

  const std::vector<std::string>& corpus_;
  std::mt19937_64 random_;
};

}  // namespace

int main(int argc, char** argv) {
  long runs = 1000;
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--runs" && i + 1 < argc) {
      runs = std::strtol(argv[++i], nullptr, 10);
    } else {
      folders.emplace_back(argv[i]);
    }
  }
  const char* seed_text = std::getenv("KNOTWAVE_SEED");
  const std::uint64_t seed = seed_text != nullptr ? std::strtoull(seed_text, nullptr, 10) : 1;
  const auto corpus = read_corpus(folders);
  if (corpus.empty()) {
    std::fprintf(stderr, "usage: %s [--runs N] FOLDER...; no file found\n", argv[0]);
    return 2;
  }
  std::signal(SIGABRT, keep_input);
  std::signal(SIGSEGV, keep_input);
  for (const std::string& text : corpus) try_input(text);
  Mutator mutator(corpus, seed);
  for (long i = 0; i < runs; ++i) try_input(mutator.next());
  std::printf("%zu files and %ld mutations, KNOTWAVE_SEED=%llu\n", corpus.size(), runs,
              static_cast<unsigned long long>(seed));
  return 0;
}
