// log, exp and pow of vectors of doubles: branch-free, no tables, inlined into each instruction set's kernels.
//
//   log x = k log 2 + log m,  x = 2^k m,  m in [sqrt(1/2), sqrt 2)
//   log m = f - s (f - z P(z)),  f = m - 1,  s = f / (2 + f),  z = s s        (the series of 2 atanh s, P of degree 6)
//   exp x = 2^n (1 + r + r r Q(r)),  n = nearest integer to x / log 2,  r = x - n log 2        (Q of degree 9)
//   pow(x, y) = exp(y log x)
//
// The coefficients are minimax for the relative error (tools/vector_math_coefficients.py): 1.8e-18 for log, 1.1e-17 for
// exp, so that rounding is what remains: about 1 ulp (measured errors: tests/unit/vector_math_test.cpp).
// A lane's result depends on that lane alone. Results may differ in the last bit between instruction sets with and
// without fused multiply-add. (A sum of two products says which of them is fused, or the compiler might choose differently
// for one lane and another.) The polynomials are split into even and odd powers: half the latency of Horner's scheme
// for one more product. NaN gives NaN.
#pragma once

#include "simd/lanes.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// log 2 in two parts: the first ends in eleven zero bits, so that its product with an exponent is exact.
constexpr double log2_high = 0x1.62e42fefa3800p-1;
constexpr double log2_low = 0x1.ef35793c76730p-45;
constexpr double smallest_normal = 0x1p-1022;

// Natural logarithm of 0 < x < infinity. Zero, denormals and negative numbers count as the smallest normal number
// (-708.4); NaN and infinity give NaN, so that a run that has blown up cannot hide here.
template <class V>
OGIVE_INLINE V log(V x) {
  constexpr std::uint64_t bits_of_one = 0x3ff0000000000000;
  constexpr std::uint64_t bits_of_root_half = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t bits_of_2_to_52 = 0x4330000000000000;
  // With the significand's origin moved to sqrt(1/2), the exponent field counts k + 1023.
  const auto shifted = as_unsigned(max(broadcast<V>(smallest_normal), x)) + (bits_of_one - bits_of_root_half);
  const V k = as_double((shifted >> 52) | bits_of_2_to_52) - (0x1p52 + 1023.0);
  const V m = as_double((shifted & std::uint64_t{0x000fffffffffffff}) + bits_of_root_half);
  const V f = m - 1.0;
  const V s = f / (2.0 + f);
  const V z = s * s;
  const V zz = z * z;
  const V even = ((0x1.2f05657ace981p-3 * zz + 0x1.74663eea20874p-3) * zz + 0x1.24924941f12d7p-2) * zz;
  const V odd = (0x1.39a1ba886eaccp-3 * zz + 0x1.c71c520955757p-3) * zz + 0x1.999999997fdb7p-2;
  const V p = fused(z, odd, even) + 0x1.5555555555592p-1;
  const V correction = fused(k, broadcast<V>(log2_low), -s * (f - z * p));
  return fused(k, broadcast<V>(log2_high), 0.0 * x) + (f + correction);  // 0 x: NaN where x is not finite
}

// Exponential; arguments above 709.78 give the value there (1.79e308), arguments below -708.39 give 0.
template <class V>
OGIVE_INLINE V exp(V x) {
  constexpr double largest_argument = 709.78;
  constexpr double smallest_argument = -708.39;
  const V limited = max(broadcast<V>(smallest_argument), min(broadcast<V>(largest_argument), x));
  // The low bits of `counted` hold n in two's complement.
  const V counted = limited * 0x1.71547652b82fep+0 + round_magic;
  const V n = counted - round_magic;
  const V r = (limited - n * log2_high) - n * log2_low;
  const V rr = r * r;
  const V even = (((0x1.28ad68e9b8e1ep-22 * rr + 0x1.a0199a1699095p-16) * rr + 0x1.6c16c18426863p-10) * rr +
                  0x1.555555555088bp-5) *
                     rr +
                 0x1.000000000000ap-1;
  const V odd = (((0x1.ad7f7ab7b188ep-26 * rr + 0x1.71df253abab2ep-19) * rr + 0x1.a01a012a69499p-13) * rr +
                 0x1.1111111127b9dp-7) *
                    rr +
                0x1.55555555554fap-3;
  const V significand = 1.0 + (r + rr * (r * odd + even));
  // n = 1024 needs no care: the significand is then below 1.
  const V result = as_double(as_unsigned(significand) + (as_unsigned(counted) << 52));
  return select(x < smallest_argument, V{}, result);
}

// x to the power y for x >= 0; x below the smallest normal number counts as 0: pow(0, y) is 0 for y > 0, 1 for y = 0
// and the largest result for y < 0. The relative error is about that of y log x times its size: 2e-15 for results
// between 1e-3 and 1e3.
template <class V>
OGIVE_INLINE V pow(V x, V y) {
  constexpr double log_of_zero = -1e300;
  return exp(y * select(x < smallest_normal, broadcast<V>(log_of_zero), log(x)));
}
template <class V>
OGIVE_INLINE V pow(V x, double y) {
  return pow(x, broadcast<V>(y));
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
