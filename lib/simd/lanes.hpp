// Vectors of doubles for kernels that are compiled once per instruction set.
//
// Vec<W> holds W doubles (W = 2, 4, 8, 16), IntVec<W> W 64-bit integers: the compiler's own vector where a register holds
// it, a Pair of halves otherwise. + - * / and comparisons act lane by lane, so a lane's result never depends on its place
// in the vector. A comparison gives an IntVec of 0
// and -1. Scalars mix freely with vectors: 2.0 * v.
//
// Everything lives in ogive::OGIVE_ISA_NAMESPACE, which the build sets to another name for each instruction set, and is
// static and always inlined: no function compiled for one instruction set can be linked into the code of another. For
// the same reason nothing from the standard library is used here but constants and intrinsics. Kernels are compiled
// with -Wno-psabi: vectors wider than a register are passed to inlined functions only, so their calling convention is
// moot.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef OGIVE_ISA_NAMESPACE
#define OGIVE_ISA_NAMESPACE generic
#endif

#define OGIVE_INLINE static inline __attribute__((always_inline))

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// The widest vector that one register of this instruction set holds.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr int native_width = 8;
#elif defined(__AVX__)
constexpr int native_width = 4;
#else
constexpr int native_width = 2;
#endif

// One specialisation per width: g++ 12 drops a vector_size that depends on a template parameter.
template <int W>
struct RegisterTypes;
template <>
struct RegisterTypes<2> {
  typedef double Double __attribute__((vector_size(16)));
  typedef std::int64_t Int __attribute__((vector_size(16)));
  typedef std::uint64_t Unsigned __attribute__((vector_size(16)));
};
template <>
struct RegisterTypes<4> {
  typedef double Double __attribute__((vector_size(32)));
  typedef std::int64_t Int __attribute__((vector_size(32)));
  typedef std::uint64_t Unsigned __attribute__((vector_size(32)));
};
template <>
struct RegisterTypes<8> {
  typedef double Double __attribute__((vector_size(64)));
  typedef std::int64_t Int __attribute__((vector_size(64)));
  typedef std::uint64_t Unsigned __attribute__((vector_size(64)));
};

// A vector of two registers or more. The compiler would take a vector that is wider than a register apart through memory;
// and two chains of operations side by side keep a processor busy where one waits for its own results.
template <class T>
struct Pair {
  T a, b;
  inline __attribute__((always_inline)) auto operator[](int lane) const {
    constexpr int width = static_cast<int>(sizeof(T) / 8);
    return lane < width ? a[lane] : b[lane - width];
  }
};

template <int W, bool one_register = (W <= native_width)>
struct LaneTypes : RegisterTypes<W> {};
template <int W>
struct LaneTypes<W, false> {
  using Double = Pair<typename LaneTypes<W / 2>::Double>;
  using Int = Pair<typename LaneTypes<W / 2>::Int>;
  using Unsigned = Pair<typename LaneTypes<W / 2>::Unsigned>;
};

template <int W>
using Vec = typename LaneTypes<W>::Double;
template <int W>
using IntVec = typename LaneTypes<W>::Int;
template <int W>
using UnsignedVec = typename LaneTypes<W>::Unsigned;

// Number of lanes of the vector type V, and the integer vectors as wide as it.
template <class V>
constexpr int width_of = static_cast<int>(sizeof(V) / 8);
template <class V>
using IntVecOf = IntVec<width_of<V>>;
template <class V>
using UnsignedVecOf = UnsignedVec<width_of<V>>;

// ------------------------------------------------------------------------------------------------ operators of pairs

template <class T>
constexpr bool is_pair = false;
template <class T>
constexpr bool is_pair<Pair<T>> = true;

#define OGIVE_PAIR_OPERATOR(op)                                                                    \
  template <class T, class U>                                                                      \
  OGIVE_INLINE auto operator op(const Pair<T>& x, const Pair<U>& y)->Pair<decltype(x.a op y.a)> {  \
    return {x.a op y.a, x.b op y.b};                                                               \
  }                                                                                                \
  template <class T, class S>                                                                      \
    requires(!is_pair<S>)                                                                          \
  OGIVE_INLINE auto operator op(const Pair<T>& x, S y)->Pair<decltype(x.a op y)> {                 \
    return {x.a op y, x.b op y};                                                                   \
  }                                                                                                \
  template <class T, class S>                                                                      \
    requires(!is_pair<S>)                                                                          \
  OGIVE_INLINE auto operator op(S x, const Pair<T>& y)->Pair<decltype(x op y.a)> {                 \
    return {x op y.a, x op y.b};                                                                   \
  }
OGIVE_PAIR_OPERATOR(+)
OGIVE_PAIR_OPERATOR(-)
OGIVE_PAIR_OPERATOR(*)
OGIVE_PAIR_OPERATOR(/)
OGIVE_PAIR_OPERATOR(&)
OGIVE_PAIR_OPERATOR(|)
OGIVE_PAIR_OPERATOR(<<)
OGIVE_PAIR_OPERATOR(>>)
#undef OGIVE_PAIR_OPERATOR

// Compilers differ in the type of a comparison's integers: the cast makes it ours.
#define OGIVE_PAIR_COMPARISON(op)                                                                          \
  template <class T>                                                                                       \
  OGIVE_INLINE IntVecOf<Pair<T>> operator op(const Pair<T>& x, const Pair<T>& y) {                         \
    return {(IntVecOf<T>)(x.a op y.a), (IntVecOf<T>)(x.b op y.b)};                                         \
  }                                                                                                        \
  template <class T, class S>                                                                              \
    requires(!is_pair<S>)                                                                                  \
  OGIVE_INLINE IntVecOf<Pair<T>> operator op(const Pair<T>& x, S y) {                                      \
    return {(IntVecOf<T>)(x.a op y), (IntVecOf<T>)(x.b op y)};                                             \
  }
OGIVE_PAIR_COMPARISON(<)
OGIVE_PAIR_COMPARISON(>)
OGIVE_PAIR_COMPARISON(<=)
OGIVE_PAIR_COMPARISON(>=)
OGIVE_PAIR_COMPARISON(==)
OGIVE_PAIR_COMPARISON(!=)
#undef OGIVE_PAIR_COMPARISON

template <class T>
OGIVE_INLINE Pair<T> operator-(const Pair<T>& x) {
  return {-x.a, -x.b};
}
template <class T>
OGIVE_INLINE Pair<T> operator~(const Pair<T>& x) {
  return {~x.a, ~x.b};
}
template <class T, class U>
OGIVE_INLINE Pair<T>& operator+=(Pair<T>& x, const U& y) {
  return x = x + y;
}
template <class T, class U>
OGIVE_INLINE Pair<T>& operator-=(Pair<T>& x, const U& y) {
  return x = x - y;
}
template <class T, class U>
OGIVE_INLINE Pair<T>& operator*=(Pair<T>& x, const U& y) {
  return x = x * y;
}
template <class T, class U>
OGIVE_INLINE Pair<T>& operator&=(Pair<T>& x, const U& y) {
  return x = x & y;
}

// ---------------------------------------------------------------------------------------------- making and storing

template <class V>
OGIVE_INLINE V broadcast(double value) {
  return value - V{};  // subtracting +0 keeps the sign of -0
}

template <class V>
OGIVE_INLINE V load(const double* from) {
  V result;
  __builtin_memcpy(&result, from, sizeof(V));
  return result;
}

// `from` is a multiple of sizeof(V) bytes.
template <class V>
OGIVE_INLINE V load_aligned(const double* from) {
  return load<V>(static_cast<const double*>(__builtin_assume_aligned(from, sizeof(V))));
}

template <class V>
OGIVE_INLINE void store(double* to, V value) {
  __builtin_memcpy(to, &value, sizeof(V));
}

// `to` is a multiple of sizeof(V) bytes.
template <class V>
OGIVE_INLINE void store_aligned(double* to, V value) {
  store(static_cast<double*>(__builtin_assume_aligned(to, sizeof(V))), value);
}

template <class V>
OGIVE_INLINE void set_lane(V& v, int lane, double value) {
  if constexpr (is_pair<V>)
    set_lane(lane < width_of<V> / 2 ? v.a : v.b, lane % (width_of<V> / 2), value);
  else
    v[lane] = value;
}

// ------------------------------------------------------------------------------------------------------- halves

template <class T>
OGIVE_INLINE T lower_half(const Pair<T>& v) {
  return v.a;
}
template <class T>
OGIVE_INLINE T upper_half(const Pair<T>& v) {
  return v.b;
}
#if defined(__AVX__)
OGIVE_INLINE Vec<2> lower_half(Vec<4> v) { return __builtin_shufflevector(v, v, 0, 1); }
OGIVE_INLINE Vec<2> upper_half(Vec<4> v) { return __builtin_shufflevector(v, v, 2, 3); }
OGIVE_INLINE Vec<4> join(Vec<2> lower, Vec<2> upper) { return __builtin_shufflevector(lower, upper, 0, 1, 2, 3); }
#else
OGIVE_INLINE Vec<4> join(Vec<2> lower, Vec<2> upper) { return {lower, upper}; }
#endif
#if defined(__AVX512F__) && defined(__AVX512DQ__)
OGIVE_INLINE Vec<4> lower_half(Vec<8> v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
OGIVE_INLINE Vec<4> upper_half(Vec<8> v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
OGIVE_INLINE Vec<8> join(Vec<4> lower, Vec<4> upper) {
  return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7);
}
#else
OGIVE_INLINE Vec<8> join(Vec<4> lower, Vec<4> upper) { return {lower, upper}; }
#endif

// -------------------------------------------------------------------------------------------- three doubles, prefetch

// Three doubles and a zero; no more is read, and none but the three is written.
OGIVE_INLINE Vec<4> load_three(const double* from) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  return _mm256_maskz_loadu_pd(7, from);
#elif defined(__AVX__)
  return _mm256_maskload_pd(from, _mm256_set_epi64x(0, -1, -1, -1));
#else
  const double four[4] = {from[0], from[1], from[2], 0.0};
  return load<Vec<4>>(four);
#endif
}
OGIVE_INLINE void store_three(double* to, Vec<4> v) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  _mm256_mask_storeu_pd(to, 7, v);
#else
  store(to, lower_half(v));
  to[2] = v[2];
#endif
}

// Asks for the cache line at `at`, which need not exist.
// By number: the place may be beyond the array's end, or of no array, to which a pointer must not lead.
OGIVE_INLINE void prefetch(const double* array, std::int64_t offset) {
  __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(array) +
                                                   static_cast<std::uintptr_t>(offset) * sizeof(double)));
}

// ------------------------------------------------------------------------------------------------- bits and choices

template <class V>
OGIVE_INLINE IntVecOf<V> as_int(V v) {
  if constexpr (is_pair<V>)
    return {as_int(v.a), as_int(v.b)};
  else
    return reinterpret_cast<IntVecOf<V>>(v);
}
template <class V>
OGIVE_INLINE UnsignedVecOf<V> as_unsigned(V v) {
  if constexpr (is_pair<V>)
    return {as_unsigned(v.a), as_unsigned(v.b)};
  else
    return reinterpret_cast<UnsignedVecOf<V>>(v);
}
template <class I>
OGIVE_INLINE Vec<width_of<I>> as_double(I bits) {
  if constexpr (is_pair<I>)
    return {as_double(bits.a), as_double(bits.b)};
  else
    return reinterpret_cast<Vec<width_of<I>>>(bits);
}

// Lane by lane: mask ? if_true : if_false. The mask is a comparison's result.
template <class M, class V>
OGIVE_INLINE V select(M mask, V if_true, V if_false) {
  if constexpr (is_pair<V>)
    return {select(mask.a, if_true.a, if_false.a), select(mask.b, if_true.b, if_false.b)};
  else
    return mask ? if_true : if_false;
}

// a < b ? a : b and a > b ? a : b as one instruction each. The second argument where either is not a number:
// min(limit, x) lets a NaN of x through. (512 bits: in the zero-masked form, because g++ 12 warns of an uninitialised
// variable in its own header's plain form.)
template <class V>
OGIVE_INLINE V min(V a, V b) {
  constexpr int width = width_of<V>;
#if defined(__AVX512F__)
  if constexpr (width == 8) return _mm512_maskz_min_pd(0xff, a, b);
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return _mm256_min_pd(a, b);
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return _mm_min_pd(a, b);
#endif
  if constexpr (is_pair<V>)
    return {min(a.a, b.a), min(a.b, b.b)};
  else
    return a < b ? a : b;
}
template <class V>
OGIVE_INLINE V max(V a, V b) {
  constexpr int width = width_of<V>;
#if defined(__AVX512F__)
  if constexpr (width == 8) return _mm512_maskz_max_pd(0xff, a, b);
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return _mm256_max_pd(a, b);
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return _mm_max_pd(a, b);
#endif
  if constexpr (is_pair<V>)
    return {max(a.a, b.a), max(a.b, b.b)};
  else
    return a > b ? a : b;
}

template <class V>
OGIVE_INLINE V abs(V v) {
  return as_double(as_unsigned(v) & std::uint64_t{0x7fffffffffffffff});
}

// Bit i is set where lane i of the mask is.
template <class M>
OGIVE_INLINE unsigned mask_bits(M mask) {
  constexpr int width = width_of<M>;
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  if constexpr (width == 8) return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(mask)));
#endif
  if constexpr (is_pair<M>) {
    return mask_bits(mask.a) | mask_bits(mask.b) << (width / 2);
  } else {
    unsigned bits = 0;
    for (int lane = 0; lane < width; ++lane) bits |= (mask[lane] != 0 ? 1u : 0u) << lane;
    return bits;
  }
}

template <class M>
OGIVE_INLINE bool any(M mask) {
  if constexpr (is_pair<M>)
    return any(mask.a | mask.b);
  else
    return mask_bits(mask) != 0;
}
template <class M>
OGIVE_INLINE bool all(M mask) {
  if constexpr (is_pair<M>)
    return all(mask.a & mask.b);
  else
    return mask_bits(mask) == (1u << width_of<M>)-1u;
}

// ------------------------------------------------------------------------------------------------------ arithmetic

// Correctly rounded square root (vsqrtpd).
template <class V>
OGIVE_INLINE V sqrt(V v) {
  constexpr int width = width_of<V>;
#if defined(__AVX512F__)
  if constexpr (width == 8) return _mm512_maskz_sqrt_pd(0xff, v);
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return _mm256_sqrt_pd(v);
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return _mm_sqrt_pd(v);
#endif
  if constexpr (is_pair<V>) {
    return {sqrt(v.a), sqrt(v.b)};
  } else {
    V result = v;
    for (int lane = 0; lane < width; ++lane) result[lane] = __builtin_sqrt(v[lane]);
    return result;
  }
}

// a b + c, rounded once where the instruction set has it.
template <class V>
OGIVE_INLINE V fused(V a, V b, V c) {
#if defined(__FMA__)
  constexpr int width = width_of<V>;
#if defined(__AVX512F__)
  if constexpr (width == 8) return _mm512_fmadd_pd(a, b, c);
#endif
  if constexpr (width == 4) return _mm256_fmadd_pd(a, b, c);
  if constexpr (width == 2) return _mm_fmadd_pd(a, b, c);
#endif
  if constexpr (is_pair<V>)
    return {fused(a.a, b.a, c.a), fused(a.b, b.b, c.b)};
  else
    return a * b + c;
}

// Nearest integer, halves to even, for |v| <= 2^51: adding 1.5 * 2^52 leaves no bits for the fraction.
constexpr double round_magic = 6755399441055744.0;
template <class V>
OGIVE_INLINE V round(V v) {
  return (v + round_magic) - round_magic;
}

// ------------------------------------------------------------------------------------------------------ transposes

// Four records {x,y,z,w} <-> the vectors of the four x, y, z and w: its own inverse, 8 shuffles.
OGIVE_INLINE void transpose(Vec<4>& a, Vec<4>& b, Vec<4>& c, Vec<4>& d) {
#if defined(__AVX__)
  const Vec<4> even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Vec<4> odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Vec<4> even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Vec<4> odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
  c = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
  d = __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
#else
  const Vec<2> a0 = lower_half(a), a1 = upper_half(a), b0 = lower_half(b), b1 = upper_half(b);
  const Vec<2> c0 = lower_half(c), c1 = upper_half(c), d0 = lower_half(d), d1 = upper_half(d);
  a = join(__builtin_shufflevector(a0, b0, 0, 2), __builtin_shufflevector(c0, d0, 0, 2));
  b = join(__builtin_shufflevector(a0, b0, 1, 3), __builtin_shufflevector(c0, d0, 1, 3));
  c = join(__builtin_shufflevector(a1, b1, 0, 2), __builtin_shufflevector(c1, d1, 0, 2));
  d = join(__builtin_shufflevector(a1, b1, 1, 3), __builtin_shufflevector(c1, d1, 1, 3));
#endif
}

// W records of four doubles, one after another, to four vectors of W components.
OGIVE_INLINE void load_records(const double* from, Vec<2>& x, Vec<2>& y, Vec<2>& z, Vec<2>& w) {
  const Vec<2> a0 = load<Vec<2>>(from), a1 = load<Vec<2>>(from + 2);
  const Vec<2> b0 = load<Vec<2>>(from + 4), b1 = load<Vec<2>>(from + 6);
  x = __builtin_shufflevector(a0, b0, 0, 2);
  y = __builtin_shufflevector(a0, b0, 1, 3);
  z = __builtin_shufflevector(a1, b1, 0, 2);
  w = __builtin_shufflevector(a1, b1, 1, 3);
}
OGIVE_INLINE void load_records(const double* from, Vec<4>& x, Vec<4>& y, Vec<4>& z, Vec<4>& w) {
  x = load<Vec<4>>(from);
  y = load<Vec<4>>(from + 4);
  z = load<Vec<4>>(from + 8);
  w = load<Vec<4>>(from + 12);
  transpose(x, y, z, w);
}
OGIVE_INLINE void load_records(const double* from, Vec<8>& x, Vec<8>& y, Vec<8>& z, Vec<8>& w) {
  Vec<4> low[4], high[4];
  load_records(from, low[0], low[1], low[2], low[3]);
  load_records(from + 16, high[0], high[1], high[2], high[3]);
  x = join(low[0], high[0]);
  y = join(low[1], high[1]);
  z = join(low[2], high[2]);
  w = join(low[3], high[3]);
}

// The way back: four vectors of W components to W records of four doubles, one after another.
OGIVE_INLINE void store_records(double* to, Vec<2> x, Vec<2> y, Vec<2> z, Vec<2> w) {
  store<Vec<2>>(to, __builtin_shufflevector(x, y, 0, 2));
  store<Vec<2>>(to + 2, __builtin_shufflevector(z, w, 0, 2));
  store<Vec<2>>(to + 4, __builtin_shufflevector(x, y, 1, 3));
  store<Vec<2>>(to + 6, __builtin_shufflevector(z, w, 1, 3));
}
OGIVE_INLINE void store_records(double* to, Vec<4> x, Vec<4> y, Vec<4> z, Vec<4> w) {
  transpose(x, y, z, w);
  store(to, x);
  store(to + 4, y);
  store(to + 8, z);
  store(to + 12, w);
}
OGIVE_INLINE void store_records(double* to, Vec<8> x, Vec<8> y, Vec<8> z, Vec<8> w) {
  store_records(to, lower_half(x), lower_half(y), lower_half(z), lower_half(w));
  store_records(to + 16, upper_half(x), upper_half(y), upper_half(z), upper_half(w));
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
