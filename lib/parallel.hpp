// Loops over the threads of a world. One thread runs them by itself: a team of one costs system calls at each barrier,
// which would be a tenth of the time of a small model.
#pragma once

#include <cstdint>

#include "simd/subnormals.hpp"

namespace ogive {

// work(i) for begin <= i < end, shared out in equal parts. Subnormal results are taken as zero.
template <class Work>
void for_each_in_parts(int threads, std::int64_t begin, std::int64_t end, Work&& work) {
  if (threads == 1 || end - begin < 2) {
    const FlushSubnormals flush;
    for (std::int64_t i = begin; i < end; ++i) work(i);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    const FlushSubnormals flush;
#pragma omp for schedule(static)
    for (std::int64_t i = begin; i < end; ++i) work(i);
  }
}

// The same, one at a time to whoever is free: for work of different sizes.
template <class Work>
void for_each_in_turn(int threads, std::int64_t begin, std::int64_t end, Work&& work) {
  if (threads == 1 || end - begin < 2) {
    const FlushSubnormals flush;
    for (std::int64_t i = begin; i < end; ++i) work(i);
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    const FlushSubnormals flush;
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t i = begin; i < end; ++i) work(i);
  }
}

}  // namespace ogive
