#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <vector>

#include "base/thread_place.hpp"

namespace driftmesh {

/// Calls work(part, begin, end) for `parts` parts of [0, count) of about equal size, in ascending order without gaps:
/// each on a thread of its own as far as the system has any to give, the first on this one; the others have the number
/// of their part as thread_place(). Returns when all are done; throws what the first of those that fail throws.
template <class Work>
void in_parts(std::size_t count, std::size_t parts, const Work& work) {
  const auto begin_of = [=](std::size_t part) { return count / parts * part + std::min(part, count % parts); };
  const std::size_t own_place = thread_place();
  const auto work_on = [&](std::size_t part) {
    if (part > 0) thread_place() = part;
    work(part, begin_of(part), begin_of(part + 1));
  };
  std::vector<std::future<void>> others;
  for (std::size_t part = 1; part < parts; ++part)
    others.push_back(std::async(std::launch::async | std::launch::deferred, work_on, part));
  work_on(0);
  for (std::future<void>& other : others) other.get();
  thread_place() = own_place;  // in case that it had to do the work of others
}

}  // namespace driftmesh
