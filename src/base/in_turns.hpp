#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

#include "base/thread_place.hpp"

namespace driftmesh {

/// Calls work(i) for all i below `count` on up to `threads` threads, this one among them, each of which takes the next
/// when it is done with one and has a thread_place() of its own. Returns when all are done; throws what one of those
/// that fail throws.
template <class Work>
void in_turns(std::size_t count, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const std::size_t own_place = thread_place();
  const auto take_turns = [&](std::size_t place) {
    if (place > 0) thread_place() = place;
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      throw;
    }
  };
  std::vector<std::future<void>> others;
  for (std::size_t other = 1; other < std::min(count, threads); ++other)
    others.push_back(std::async(std::launch::async | std::launch::deferred, take_turns, other));
  take_turns(0);
  for (std::future<void>& other : others) other.get();
  thread_place() = own_place;  // in case that it had to do the work of others
}

}  // namespace driftmesh
