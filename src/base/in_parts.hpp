#pragma once

#include <algorithm>
#include <cstddef>
#include <future>
#include <vector>

namespace driftmesh {

/// Calls work(part, begin, end) for `parts` parts of [0, count) of about equal size, in ascending order without gaps:
/// each on a thread of its own as far as the system has any to give, the first on this one. Returns when all are done;
/// throws what the first of those that fail throws.
template <class Work>
void in_parts(std::size_t count, std::size_t parts, const Work& work) {
  const auto begin_of = [=](std::size_t part) { return count / parts * part + std::min(part, count % parts); };
  const auto work_on = [&](std::size_t part) { work(part, begin_of(part), begin_of(part + 1)); };
  std::vector<std::future<void>> others;
  for (std::size_t part = 1; part < parts; ++part)
    others.push_back(std::async(std::launch::async | std::launch::deferred, work_on, part));
  work_on(0);
  for (std::future<void>& other : others) other.get();
}

}  // namespace driftmesh
