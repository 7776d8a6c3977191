// run_corpus TARGET FOLDER: runs each file of the folder through the target, and also each file slightly
// shortened and with some bits flipped, always in the same way. Any failure ends the process (targets.h).
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/targets.h"

namespace {

constexpr int kVariants = 20;

using Bytes = std::vector<uint8_t>;

Bytes ReadBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Bytes Changed(Bytes bytes, std::mt19937_64& random) {
  if (bytes.empty()) return bytes;
  if (random() % 4 == 0) bytes.resize(random() % bytes.size());
  for (size_t flips = random() % 4; flips > 0 && !bytes.empty(); --flips) {
    bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1U << random() % 8);
  }
  return bytes;
}

void Run(const hydro::fuzz::Target& target, const Bytes& bytes) {
  const Bytes exact(bytes.begin(), bytes.end());  // no room at its end: the sanitizer sees a read beyond it
  target.run(exact.data(), exact.size());
}

}  // namespace

// No claim in a file may cause an allocation of this size: MiB that no input of the corpus needs.
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=64"; }

int main(int argc, char** argv) {
  const hydro::fuzz::Target* const target = argc == 3 ? hydro::fuzz::FindTarget(argv[1]) : nullptr;
  if (target == nullptr || !std::filesystem::is_directory(argv[2])) {
    std::fprintf(stderr, "usage: run_corpus TARGET FOLDER\n");
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    std::fprintf(stderr, "run_corpus: %s is empty\n", argv[2]);
    return 1;
  }
  Run(*target, {});
  std::mt19937_64 random(1);
  for (const std::filesystem::path& file : files) {
    std::fprintf(stderr, "%s\n", file.c_str());    // the last one is the culprit
    if (!std::filesystem::exists(file)) return 1;  // a link to a file of the project that has moved
    const Bytes bytes = ReadBytes(file);
    Run(*target, bytes);
    for (int i = 0; i < kVariants; ++i) Run(*target, Changed(bytes, random));
  }
  std::printf("%zu files, %d variants of each\n", files.size(), kVariants);
  return 0;
}
