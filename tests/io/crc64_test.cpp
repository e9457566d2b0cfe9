// The checksum against its published check value and against a bit-by-bit computation.
#include "crc64.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace {

using ogive::io::crc64;

std::uint64_t bit_by_bit(const std::vector<unsigned char>& bytes) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const auto byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0xC96C5795D7870F42u : 0u);
  }
  return ~crc;
}

std::vector<unsigned char> random_bytes(std::size_t size) {
  std::mt19937_64 random(size + 1);
  std::vector<unsigned char> bytes(size);
  for (auto& byte : bytes) byte = static_cast<unsigned char>(random());
  return bytes;
}

TEST(Crc64, GivesThePublishedCheckValue) {
  EXPECT_EQ(crc64("123456789", 9), 0x995DC9BBDF1939FAu);
  EXPECT_EQ(crc64("", 0), 0u);
}

TEST(Crc64, AgreesWithTheBitByBitComputationAtEveryLength) {
  for (std::size_t size = 0; size < 200; ++size) {
    const auto bytes = random_bytes(size);
    EXPECT_EQ(crc64(bytes.data(), size), bit_by_bit(bytes)) << size;
  }
}

TEST(Crc64, OfPiecesEqualsThatOfTheWhole) {
  const auto bytes = random_bytes(1000);
  const auto whole = crc64(bytes.data(), bytes.size());
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut)
    EXPECT_EQ(crc64(bytes.data() + cut, bytes.size() - cut, crc64(bytes.data(), cut)), whole) << cut;
}

}  // namespace
