// Storage of the hot arrays: std::vector on 64-byte boundaries, so that vector loads never straddle a cache line; long
// arrays in huge pages where the system gives them, because a step walks through a dozen of them at once.
//
// Long arrays do not begin at the same offset in their pages: a step reads the same particles of all arrays together,
// and a first-level cache holds only eight lines of equal offset.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace ogive {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::size_t line = 64, page = 4096, huge_page = std::size_t{2} << 20;

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = n * sizeof(T);
    if (bytes < staggered_from) return static_cast<T*>(::operator new (bytes, std::align_val_t{line}));
    static std::atomic<unsigned> count{0};
    const std::size_t offset = count.fetch_add(1, std::memory_order_relaxed) % 16 * (page / 16);
    const std::size_t boundary = boundary_of(bytes);
    void* const memory = ::operator new (bytes + page, std::align_val_t{boundary});
#if defined(__linux__)
    // Only advice: where it cannot be followed nothing is lost. Not for the end, which may be capacity that is never used.
    if (boundary == huge_page) (void)::madvise(memory, (bytes + page) / huge_page * huge_page, MADV_HUGEPAGE);
#endif
    return reinterpret_cast<T*>(static_cast<char*>(memory) + offset);
  }
  void deallocate(T* p, std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < staggered_from) return ::operator delete (p, std::align_val_t{line});
    const std::size_t boundary = boundary_of(bytes);
    const std::uintptr_t start = reinterpret_cast<std::uintptr_t>(p) / boundary * boundary;
    ::operator delete (reinterpret_cast<void*>(start), std::align_val_t{boundary});
  }
  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }

 private:
  static constexpr std::size_t staggered_from = 16 * page;
  static std::size_t boundary_of(std::size_t bytes) { return bytes >= huge_page / 2 ? huge_page : page; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace ogive
