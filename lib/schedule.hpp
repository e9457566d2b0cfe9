// Which thread works on what, and in which order.
//
// Each thread has a part of the pencils (rows of blocks along x) and of the slots, compact and the same in every phase, so that it
// finds them in its own cache: lines of memory that go from one thread to another in every phase cost more than work that is not
// quite even. So a thread that has done its part helps another one only where much is left.
//
// Pencils whose groups add to common nodes must add in an order that does not depend on the threads. It is given by colours: the
// place of a pencil along z and y, each even or odd. Neighbours differ in colour, and the one of the lower colour comes first; all
// others run at once. Colour after colour with all threads waiting for each other in between would be correct but slow: the nodes
// would pass through the caches once a colour, and threads would wait at each end. Instead a thread goes through its pencils row by
// row, 0 2 1 4 3 6 5 ..., which keeps to the colours and returns to nodes while they are near, and a pencil waits for its
// neighbours of lower colours alone. Measured with two threads: docs/decisions.md.
#pragma once

#include <omp.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "simd/subnormals.hpp"

namespace ogive {

// Numbers from 0 on, in parts of one a thread.
class Parts {
 public:
  // The part of each number; within a part they come by rank. Threads take `run` numbers at a time.
  void assign(int threads, const std::vector<std::int32_t>& part_of, const std::vector<std::int32_t>& rank, std::int32_t run);

  // work(i) for all of them.
  template <class Work>
  void for_each(Work&& work) {
    if (threads() == 1) {
      const FlushSubnormals flush;
      for (const std::int32_t i : order_) work(i);
      return;
    }
    restart();
#pragma omp parallel num_threads(threads())
    {
      const FlushSubnormals flush;
      const int own = omp_get_thread_num();
      if (omp_get_num_threads() == threads()) {
        take(own, work);
      } else if (own == 0) {  // the host gives no team of this size, as inside a parallel region of its own
        for (const std::int32_t i : order_) work(i);
      }
    }
  }

  // What a thread of a full team does, between restart() and the end of its parallel region.
  void restart() {
    for (int part = 0; part < threads(); ++part) cursors_[part].next = first_[part];
  }
  template <class Work>
  void take(int own, Work&& work) {
    for (int k = 0; k < threads(); ++k) {
      const int part = (own + k) % threads();
      const std::int32_t end = first_[part + 1], enough = k == 0 ? 0 : (end - first_[part]) / 4;
      std::atomic<std::int32_t>& next = cursors_[part].next;
      while (end - next.load(std::memory_order_relaxed) > enough) {
        std::int32_t i = next.fetch_add(run_, std::memory_order_relaxed);
        for (const std::int32_t last = i + run_ < end ? i + run_ : end; i < last; ++i) work(order_[i]);
      }
    }
  }

  int threads() const { return threads_; }
  std::int64_t memory_bytes() const;

 private:
  struct alignas(64) Cursor {
    std::atomic<std::int32_t> next{0};
  };
  int threads_ = 1;
  std::int32_t run_ = 1;
  std::vector<std::int32_t> order_;                // part by part
  std::vector<std::int32_t> first_;                // of each part in order_, and the end
  std::vector<Cursor> cursors_;                    // by part
};

class Schedule {
 public:
  using Place = std::array<std::int32_t, 2>;

  // Pencils by their places along z and y, in this order.
  void set_pencils(const std::vector<Place>& places);

  // Parts of about equal weight, one a thread. Weights are those of the pencils, >= 0.
  void divide(int threads, const std::vector<std::int64_t>& weights);

  // The part that a place belongs to, whether there is a pencil or not.
  std::int32_t part_of(const Place& place) const;

  // work(pencil) for all of them, in any order.
  template <class Work>
  void for_each(Work&& work) {
    parts_.for_each(work);
  }

  // The same, neighbours one after the other.
  template <class Work>
  void for_each_in_order(Work&& work) {
    if (threads() == 1) {
      parts_.for_each(work);
      return;
    }
    const std::uint32_t round = ++round_;
    parts_.restart();
#pragma omp parallel num_threads(threads())
    {
      const FlushSubnormals flush;
      const int own = omp_get_thread_num();
      if (omp_get_num_threads() == threads()) {
        parts_.take(own, [&](std::int32_t pencil) {
          wait_for_neighbours(pencil, round);
          work(pencil);
          done_[pencil].store(round, std::memory_order_release);
        });
      } else if (own == 0) {  // see Parts
        for (const std::int32_t pencil : sequence_) work(pencil);
      }
    }
  }

  int threads() const { return parts_.threads(); }
  std::int64_t memory_bytes() const;
  // The neighbours that a pencil waits for.
  std::vector<std::int32_t> awaited_by(std::int32_t pencil) const {
    return {awaited_.begin() + awaited_begin_[pencil], awaited_.begin() + awaited_begin_[pencil + 1]};
  }

 private:
  void wait_for_neighbours(std::int32_t pencil, std::uint32_t round) const {
    for (std::int32_t i = awaited_begin_[pencil]; i < awaited_begin_[pencil + 1]; ++i)
      for (int spins = 0; done_[awaited_[i]].load(std::memory_order_acquire) != round; ++spins)
        if (spins > 10000) std::this_thread::yield();
  }
  // The place as parts are cut: across the longer side.
  Place across(const Place& place) const { return along_y_ ? Place{place[1], place[0]} : place; }

  Parts parts_;
  bool along_y_ = false;                                   // there is more of it than along z
  std::vector<Place> places_;                              // of the pencils
  std::vector<Place> cuts_;                                // where the parts after the first begin, as across() gives it
  std::vector<std::int32_t> sequence_;                     // all pencils as one thread works on them
  std::vector<std::int32_t> rank_;                         // of each pencil in the sequence
  std::vector<std::int32_t> awaited_, awaited_begin_;      // by pencil
  std::uint32_t round_ = 0;
  std::vector<std::atomic<std::uint32_t>> done_;           // by pencil: the round in which it was done last
};

}  // namespace ogive
