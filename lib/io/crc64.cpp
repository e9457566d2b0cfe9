// On x86-64 processors that multiply without carries (pclmulqdq), by folding: a message is a polynomial over GF(2), and
//   A x^512 + B = A_low (x^576 mod P) + A_high (x^512 mod P) + B   (mod P)
// brings 128 bits A forward by 512; four sums of 128 bits run side by side and end in one, whose checksum is that of the
// message. Elsewhere, and for what is left, slicing by 16: sixteen tables take sixteen bytes per round. Bits are reflected.
#include "crc64.hpp"

#include <array>
#include <bit>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

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

std::uint64_t by_tables(const unsigned char* bytes, std::size_t size, std::uint64_t crc) {
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
  return crc;
}

#if defined(__x86_64__) && defined(__GNUC__)

// x^power mod P, reflected: the highest bit is x^0.
constexpr std::uint64_t power_of_x(int power) {
  std::uint64_t value = std::uint64_t{1} << 63;
  for (int i = 0; i < power; ++i) value = (value >> 1) ^ ((value & 1) ? kPolynomial : 0);
  return value;
}

// `sum` brought forward and added to `next`. The product of reflected numbers is one power of x too high: hence the powers
// one lower than above.
template <int bits>
__attribute__((target("pclmul,sse2"))) inline __m128i fold(__m128i sum, __m128i next) {
  const __m128i powers = _mm_set_epi64x(static_cast<long long>(power_of_x(bits - 1)),
                                        static_cast<long long>(power_of_x(bits + 64 - 1)));
  return _mm_xor_si128(next, _mm_xor_si128(_mm_clmulepi64_si128(sum, powers, 0x00),
                                           _mm_clmulepi64_si128(sum, powers, 0x11)));
}

// Takes 64 bytes and more; changes `bytes` and `size` to what is left.
__attribute__((target("pclmul,sse2"))) std::uint64_t by_folding(const unsigned char*& bytes, std::size_t& size,
                                                                std::uint64_t crc) {
  const auto load = [](const unsigned char* at) __attribute__((target("pclmul,sse2"))) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
  };
  __m128i sum[4];
  for (int i = 0; i < 4; ++i) sum[i] = load(bytes + 16 * i);
  sum[0] = _mm_xor_si128(sum[0], _mm_set_epi64x(0, static_cast<long long>(crc)));
  bytes += 64;
  size -= 64;
  for (; size >= 64; size -= 64, bytes += 64)
    for (int i = 0; i < 4; ++i) sum[i] = fold<512>(sum[i], load(bytes + 16 * i));
  for (int i = 1; i < 4; ++i) sum[0] = fold<128>(sum[0], sum[i]);
  unsigned char last[16];
  _mm_storeu_si128(reinterpret_cast<__m128i*>(last), sum[0]);
  return by_tables(last, sizeof last, 0);
}

bool can_fold() {
  static const bool can = __builtin_cpu_supports("pclmul") != 0;
  return can;
}

#endif

}  // namespace

std::uint64_t crc64(const void* data, std::size_t size, std::uint64_t before) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t crc = ~before;
#if defined(__x86_64__) && defined(__GNUC__)
  if (size >= 64 && can_fold()) crc = by_folding(bytes, size, crc);
#endif
  return ~by_tables(bytes, size, crc);
}

}  // namespace ogive::io
