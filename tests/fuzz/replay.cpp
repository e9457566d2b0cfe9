// Where there is no libFuzzer: runs every file of the given folders, then random changes of them, from a seed that is printed.
//
//   PROGRAM FOLDER... [--changes N] [--seed S]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

// Bits turned, bytes replaced, a stretch removed, repeated or taken from another input.
Bytes changed(const Bytes& from, const Bytes& other, std::mt19937_64& random) {
  Bytes bytes = from;
  const auto below = [&](std::size_t n) { return n == 0 ? std::size_t{0} : static_cast<std::size_t>(random() % n); };
  for (std::size_t i = 0, n = 1 + below(4); i < n; ++i) {
    const std::size_t at = below(bytes.size()), length = std::min<std::size_t>(below(16) + 1, bytes.size() - at);
    switch (below(6)) {
      case 0:
        if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 1:
        if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
        break;
      case 2:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
        break;
      case 3: {
        const Bytes part(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                         bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), part.begin(), part.end());
        break;
      }
      case 4: {
        const std::size_t start = below(other.size()), more = std::min<std::size_t>(below(64) + 1, other.size() - start);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), other.begin() + static_cast<std::ptrdiff_t>(start),
                     other.begin() + static_cast<std::ptrdiff_t>(start + more));
        break;
      }
      default:
        bytes.resize(below(bytes.size() + 1));
    }
  }
  return bytes;
}

}  // namespace

int main(int count, char** arguments) {
  std::uint64_t changes = 0, seed = 1;
  std::vector<Bytes> inputs;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--changes") == 0 && i + 1 < count) {
      changes = std::strtoull(arguments[++i], nullptr, 10);
    } else if (std::strcmp(arguments[i], "--seed") == 0 && i + 1 < count) {
      seed = std::strtoull(arguments[++i], nullptr, 10);
    } else {
      std::vector<std::filesystem::path> files;
      for (const auto& entry : std::filesystem::directory_iterator(arguments[i])) files.push_back(entry.path());
      std::sort(files.begin(), files.end());
      for (const auto& file : files) inputs.push_back(bytes_of(file));
    }
  }
  if (inputs.empty()) {
    std::fprintf(stderr, "usage: %s FOLDER... [--changes N] [--seed S]\n", arguments[0]);
    return 2;
  }
  std::printf("%zu inputs, %llu changes of them from seed %llu\n", inputs.size(), static_cast<unsigned long long>(changes),
              static_cast<unsigned long long>(seed));
  std::fflush(stdout);
  for (const Bytes& input : inputs) LLVMFuzzerTestOneInput(input.data(), input.size());
  std::printf("%llu of the corpus taken to the end\n", static_cast<unsigned long long>(fuzz::accepted));
  if (fuzz::accepted == 0) {
    std::fprintf(stderr, "fuzz: every input of the corpus was refused: nothing is tried\n");
    return 1;
  }
  std::mt19937_64 random(seed);
  for (std::uint64_t i = 0; i < changes; ++i) {
    const Bytes input = changed(inputs[random() % inputs.size()], inputs[random() % inputs.size()], random);
    LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  return 0;
}
