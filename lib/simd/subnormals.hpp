// Numbers below 1e-308 count as zero while a FlushSubnormals lives on this thread.
//
// Ahead of every wave a step spreads ever smaller numbers into material at rest; within some hundred steps they are
// subnormal, which some processors handle in slow microcode (no gain was measured on AMD Zen 3: docs/decisions.md). The
// processor's mode is put back afterwards: a library is a guest in its host's threads.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace ogive {

class FlushSubnormals {
 public:
#if defined(__SSE2__)
  FlushSubnormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }  // flush to zero, subnormals are zeros
  ~FlushSubnormals() { _mm_setcsr(saved_); }
#else
  FlushSubnormals() {}
  ~FlushSubnormals() {}
#endif
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

#if defined(__SSE2__)
 private:
  unsigned saved_;
#endif
};

}  // namespace ogive
