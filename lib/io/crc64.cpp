// Slicing by 16: sixteen tables take sixteen bytes per round, so that a checksum costs little beside the disk.
#include "crc64.hpp"

#include <array>
#include <bit>
#include <cstring>

namespace ogive::io {
namespace {

constexpr std::uint64_t kPolynomial = 0xC96C5795D7870F42u;  // ECMA-182, bits reflected
constexpr int kSlices = 16;
using Tables = std::array<std::array<std::uint64_t, 256>, kSlices>;

constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) ? kPolynomial : 0);
    tables[0][byte] = value;
  }
  for (int slice = 1; slice < kSlices; ++slice)
    for (int byte = 0; byte < 256; ++byte) {
      const std::uint64_t previous = tables[slice - 1][byte];
      tables[slice][byte] = (previous >> 8) ^ tables[0][previous & 0xFF];
    }
  return tables;
}

constexpr Tables kTables = make_tables();

// Checksums are of the bytes in the file, which are little-endian; the words below are read in the machine's order.
static_assert(std::endian::native == std::endian::little, "checksums and files assume a little-endian machine");

}  // namespace

std::uint64_t crc64(const void* data, std::size_t size, std::uint64_t before) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t crc = ~before;
  for (; size >= kSlices; size -= kSlices, bytes += kSlices) {
    std::uint64_t low, high;
    std::memcpy(&low, bytes, 8);
    std::memcpy(&high, bytes + 8, 8);
    low ^= crc;
    crc = 0;
    for (int i = 0; i < 8; ++i) {
      crc ^= kTables[15 - i][(low >> (8 * i)) & 0xFF];
      crc ^= kTables[7 - i][(high >> (8 * i)) & 0xFF];
    }
  }
  for (; size > 0; --size, ++bytes) crc = (crc >> 8) ^ kTables[0][(crc ^ *bytes) & 0xFF];
  return ~crc;
}

}  // namespace ogive::io
