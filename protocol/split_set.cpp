#include "protocol/split_set.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "base/mix.hpp"

namespace driftmesh::protocol {

std::vector<dyadic::Path> SplitSet::insert(dyadic::Path path) {
  DM_ASSERT(path >= 1 && dyadic::depth(path) <= dyadic::kMaxDepth);
  std::vector<dyadic::Path> fresh;
  for (; path != 0 && !contains(path); path = dyadic::parent(path)) {
    fresh.push_back(path);
    paths_.insert(std::lower_bound(paths_.begin(), paths_.end(), path), path);
  }
  std::reverse(fresh.begin(), fresh.end());
  return fresh;
}

bool SplitSet::contains(dyadic::Path path) const {
  return std::binary_search(paths_.begin(), paths_.end(), path);
}

void SplitDigest::add(dyadic::Path path) {
  const std::uint64_t hash = mix(path + kMixStep);
  ++count;
  sum += hash;
  toggle ^= hash;
}

SplitDigest digest(const SplitSet& set) {
  SplitDigest result;
  for (const dyadic::Path path : set.paths()) result.add(path);
  return result;
}

}  // namespace driftmesh::protocol
