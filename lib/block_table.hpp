// Blocks of cells by their coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ogive {

// Block coordinates and field (or nothing) in one key; Model::validate_grid keeps blocks within +-32000, so that those a few
// blocks beyond fit too.
inline std::uint64_t block_key(const std::array<std::int32_t, 3>& block, std::int32_t field) {
  const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(i + 32768) & 0xffff; };
  return part(block[2]) << 48 | part(block[1]) << 32 | part(block[0]) << 16 | static_cast<std::uint64_t>(field);
}

// Open-addressing table from block keys to indices; much faster than std::unordered_map here and freed in one go.
class BlockTable {
 public:
  explicit BlockTable(std::size_t expected) {
    std::size_t size = 64;
    while (size < 2 * expected) size *= 2;
    entries_.assign(size, {empty, -1});
  }
  // Index of the key, `next` if it is new.
  std::int32_t insert(std::uint64_t key, std::int32_t next) {
    if (2 * (used_ + 1) > entries_.size()) grow();
    Entry& entry = entries_[place(key)];
    if (entry.key == empty) {
      entry = {key, next};
      ++used_;
    }
    return entry.index;
  }
  std::int32_t find(std::uint64_t key) const { return entries_[place(key)].index; }

 private:
  struct Entry {
    std::uint64_t key;
    std::int32_t index;
  };
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  std::size_t place(std::uint64_t key) const {
    std::uint64_t hash = key * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 32;
    std::size_t i = hash & (entries_.size() - 1);
    while (entries_[i].key != empty && entries_[i].key != key) i = (i + 1) & (entries_.size() - 1);
    return i;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size(), {empty, -1});
    old.swap(entries_);
    for (const Entry& entry : old)
      if (entry.key != empty) entries_[place(entry.key)] = entry;
  }
  std::vector<Entry> entries_;
  std::size_t used_ = 0;
};

}  // namespace ogive
