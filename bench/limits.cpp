// What one core of this machine, and all of them, can do: clock, fused multiply-adds, memory. Prints one JSON object.
//
//   ogive_limits [THREADS]
//
// Memory: 256 MB copied by each thread, bytes read and written both counted (the write's own read of the line is not), best
// of five. FMA: independent chains in registers. Clock: a chain of dependent additions, one a cycle.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double clock_hz() {
  constexpr long rounds = 50'000'000;
  std::uint64_t x = 1;
  const double start = now();
  for (long i = 0; i < rounds; ++i) asm volatile("add $1, %0\n\tadd $1, %0\n\tadd $1, %0\n\tadd $1, %0" : "+r"(x));
  return 4.0 * rounds / (now() - start);
}

#if defined(__AVX512F__)
constexpr int width = 8;
#elif defined(__AVX__)
constexpr int width = 4;
#else
constexpr int width = 2;
#endif
typedef double Vector __attribute__((vector_size(8 * width)));

// Chains one by one: an array of them would be kept in memory.
double flops() {
  constexpr long rounds = 20'000'000;
  constexpr int chains = 12;
  Vector a{}, b{}, c{}, d{}, e{}, f{}, g{}, h{}, k{}, l{}, m{}, n{};
  const Vector factor = Vector{} + 0.999, term = Vector{} + 1e-3;
  const auto next = [&](Vector& chain) __attribute__((always_inline)) {
    chain = chain * factor + term;
    asm volatile("" : "+v"(chain));
  };
  const double start = now();
  for (long i = 0; i < rounds; ++i) {
    next(a), next(b), next(c), next(d), next(e), next(f);
    next(g), next(h), next(k), next(l), next(m), next(n);
  }
  return 2.0 * width * chains * rounds / (now() - start);
}

double copy_bytes(int threads) {
  constexpr std::size_t bytes = std::size_t{256} << 20;
  std::vector<char*> from(threads), to(threads);
  for (int t = 0; t < threads; ++t) {
    from[t] = static_cast<char*>(std::aligned_alloc(4096, bytes));
    to[t] = static_cast<char*>(std::aligned_alloc(4096, bytes));
    if (!from[t] || !to[t]) std::exit(1);
  }
  double best = 0;
  for (int round = 0; round < 6; ++round) {
    const double start = now();
#pragma omp parallel num_threads(threads)
    {
      const int t = omp_get_thread_num();
      if (round == 0) std::memset(from[t], 1, bytes);
      std::memcpy(to[t], from[t], bytes);
    }
    if (round > 0) best = std::max(best, 2.0 * static_cast<double>(bytes) * threads / (now() - start));
  }
  for (int t = 0; t < threads; ++t) std::free(from[t]), std::free(to[t]);
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const int threads = argc > 1 ? std::atoi(argv[1]) : 1;
  if (threads < 1) return 2;
  double hz = 0, fma = 0;
  for (int round = 0; round < 3; ++round) hz = std::max(hz, clock_hz()), fma = std::max(fma, flops());
  std::printf("{\"clock_hz\": %.4g, \"flops\": %.4g, \"copy_bytes_per_second\": %.4g, \"threads\": %d, "
              "\"copy_bytes_per_second_all\": %.4g}\n",
              hz, fma, copy_bytes(1), threads, copy_bytes(threads));
}
