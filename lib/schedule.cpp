// Which thread works on what, and in which order: see the header.
#include "schedule.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ogive {
namespace {

using Place = Schedule::Place;

// 0 2 1 4 3 6 5 ...: an odd row as soon as both its neighbours are done.
std::int64_t turn(std::int32_t row) { return row % 2 == 0 ? 2 * std::int64_t{row} : 2 * std::int64_t{row} + 3; }

int colour(const Place& place) { return (place[0] & 1) * 2 + (place[1] & 1); }

}  // namespace

void Parts::assign(int threads, const std::vector<std::int32_t>& part_of, const std::vector<std::int32_t>& rank,
                   std::int32_t run) {
  std::vector<std::int32_t> order(part_of.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(part_of[a], rank[a]) < std::pair(part_of[b], rank[b]);
  });
  std::vector<std::int32_t> first(static_cast<std::size_t>(threads) + 1, 0);
  for (const std::int32_t part : part_of) ++first[part + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Cursor> cursors(static_cast<std::size_t>(threads));
  // From here on nothing fails: parts that do not fit together would make threads wait without end.
  order_.swap(order);
  first_.swap(first);
  cursors_.swap(cursors);
  threads_ = threads;
  run_ = run;
}

std::int64_t Parts::memory_bytes() const {
  return static_cast<std::int64_t>((order_.capacity() + first_.capacity()) * sizeof(std::int32_t) +
                                   cursors_.capacity() * sizeof(Cursor));
}

void Schedule::set_pencils(const std::vector<Place>& places) {
  places_ = places;
  Place low, high;
  low.fill(std::numeric_limits<std::int32_t>::max());
  high.fill(std::numeric_limits<std::int32_t>::min());
  for (const Place& place : places)
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  along_y_ = !places.empty() && high[1] - std::int64_t{low[1]} > high[0] - std::int64_t{low[0]};

  const std::int32_t n = static_cast<std::int32_t>(places.size());
  sequence_.resize(places.size());
  std::iota(sequence_.begin(), sequence_.end(), 0);
  std::sort(sequence_.begin(), sequence_.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(turn(places[a][0]), turn(places[a][1])) < std::pair(turn(places[b][0]), turn(places[b][1]));
  });
  rank_.resize(places.size());
  for (std::int32_t i = 0; i < n; ++i) rank_[sequence_[i]] = i;

  awaited_.clear();
  awaited_begin_.assign(1, 0);
  for (const Place& place : places) {
    for (std::int32_t z = place[0] - 1; z <= place[0] + 1; ++z)
      for (auto at = std::lower_bound(places.begin(), places.end(), Place{z, place[1] - 1});
           at != places.end() && *at <= Place{z, place[1] + 1}; ++at)
        if (colour(*at) < colour(place)) awaited_.push_back(static_cast<std::int32_t>(at - places.begin()));
    awaited_begin_.push_back(static_cast<std::int32_t>(awaited_.size()));
  }
  done_ = std::vector<std::atomic<std::uint32_t>>(places.size());
  round_ = 0;
}

void Schedule::divide(int threads, const std::vector<std::int64_t>& weights) {
  const std::int64_t total = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  std::vector<std::int32_t> along(places_.size());
  std::iota(along.begin(), along.end(), 0);
  std::sort(along.begin(), along.end(),
            [&](std::int32_t a, std::int32_t b) { return across(places_[a]) < across(places_[b]); });
  std::vector<std::int32_t> part_of(places_.size());
  cuts_.clear();
  std::int64_t passed = 0;
  for (const std::int32_t pencil : along) {
    // A part ends where it is nearest to its share of the weight.
    while (static_cast<int>(cuts_.size()) + 1 < threads &&
           threads * (2 * passed + weights[pencil]) >= 2 * (static_cast<std::int64_t>(cuts_.size()) + 1) * total)
      cuts_.push_back(across(places_[pencil]));
    part_of[pencil] = static_cast<std::int32_t>(cuts_.size());
    passed += weights[pencil];
  }
  parts_.assign(threads, part_of, rank_, 1);
}

std::int32_t Schedule::part_of(const Place& place) const {
  return static_cast<std::int32_t>(std::upper_bound(cuts_.begin(), cuts_.end(), across(place)) - cuts_.begin());
}

std::int64_t Schedule::memory_bytes() const {
  return parts_.memory_bytes() +
         static_cast<std::int64_t>((sequence_.capacity() + rank_.capacity() + awaited_.capacity() + awaited_begin_.capacity()) *
                                       sizeof(std::int32_t) +
                                   (places_.capacity() + cuts_.capacity()) * sizeof(Place) + done_.capacity() * sizeof(done_[0]));
}

}  // namespace ogive
