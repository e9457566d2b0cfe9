// lib/simd for one instruction set: the build compiles this file once for each, with its own OGIVE_ISA_NAMESPACE.
#include "vector_math_kernels.hpp"

#include "simd/vector_math.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {
namespace {

template <int W, class Function>
void for_each(const double* x, double* out, long count, Function function) {
  for (long i = 0; i < count; i += W) store(out + i, function(load<Vec<W>>(x + i)));
}

template <int W>
void apply(VectorFunction which, const double* x, const double* y, double* out, long count) {
  using V = Vec<W>;
  switch (which) {
    case VectorFunction::Log:
      return for_each<W>(x, out, count, [](V v) { return log(v); });
    case VectorFunction::Exp:
      return for_each<W>(x, out, count, [](V v) { return exp(v); });
    case VectorFunction::Pow:
      for (long i = 0; i < count; i += W) store(out + i, pow(load<V>(x + i), load<V>(y + i)));
      return;
    case VectorFunction::Sqrt:
      return for_each<W>(x, out, count, [](V v) { return sqrt(v); });
    case VectorFunction::Abs:
      return for_each<W>(x, out, count, [](V v) { return abs(v); });
    case VectorFunction::Round:
      return for_each<W>(x, out, count, [](V v) { return round(v); });
    case VectorFunction::Min:
      for (long i = 0; i < count; i += W) store(out + i, min(load<V>(x + i), load<V>(y + i)));
      return;
    case VectorFunction::Max:
      for (long i = 0; i < count; i += W) store(out + i, max(load<V>(x + i), load<V>(y + i)));
      return;
    case VectorFunction::SelectLess:
      for (long i = 0; i < count; i += W) {
        const V a = load<V>(x + i), b = load<V>(y + i);
        store(out + i, select(a < b, broadcast<V>(1.0), broadcast<V>(-0.0)));
      }
      return;
    case VectorFunction::AnyAllLess:
      for (long i = 0; i < count; i += W) {
        const auto less = load<V>(x + i) < load<V>(y + i);
        store(out + i, broadcast<V>((any(less) ? 1.0 : 0.0) + (all(less) ? 2.0 : 0.0)));
      }
      return;
  }
}

template <int W>
void transpose_records(const double* records, double* components, double* back) {
  Vec<W> x, y, z, w;
  load_records(records, x, y, z, w);
  store(components, x);
  store(components + W, y);
  store(components + 2 * W, z);
  store(components + 3 * W, w);
  store_records(back, x, y, z, w);
}

}  // namespace

VectorKernels vector_kernels() {
  return {OGIVE_ISA_NAME,
          native_width,
          {apply<2>, apply<4>, apply<8>},
          {transpose_records<2>, transpose_records<4>, transpose_records<8>}};
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
