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
  std::vector<std::future<void>> others;
  for (std::size_t part = 1; part < parts; ++part)
    others.push_back(std::async(std::launch::async | std::launch::deferred, [&work, part, parts, count] {
      work(part, count / parts * part + std::min(part, count % parts),
           count / parts * (part + 1) + std::min(part + 1, count % parts));
    }));
  work(std::size_t{0}, std::size_t{0}, count / parts + std::min<std::size_t>(1, count % parts));
  for (std::future<void>& other : others) other.get();
}

}  // namespace driftmesh
