// The functions of lib/simd behind plain pointers, so that a test can call the version of each instruction set.
#pragma once

namespace ogive {

enum class VectorFunction { Log, Exp, Pow, Sqrt, Abs, Round, Min, Max, SelectLess, AnyAllLess };

struct VectorKernels {
  const char* name;
  int native_width;
  // For 2, 4 and 8 lanes; count is a multiple of the number of lanes. y is read by functions of two arguments only.
  void (*apply[3])(VectorFunction which, const double* x, const double* y, double* out, long count);
  // As many records of four doubles as lanes -> components, and from these back.
  void (*transpose_records[3])(const double* records, double* components, double* back);
};

namespace x86_64 {
VectorKernels vector_kernels();
}
namespace x86_64_v3 {
VectorKernels vector_kernels();
}
namespace x86_64_v4 {
VectorKernels vector_kernels();
}

}  // namespace ogive
