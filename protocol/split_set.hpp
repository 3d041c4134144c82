#pragma once

#include <cstdint>
#include <vector>

#include "dyadic/path.hpp"

namespace driftmesh::protocol {

/// The points on one shared edge, as known to one side: a growing set of paths that contains all ancestors of its
/// elements.
///
/// Such sets form a join-semilattice under union: union is commutative, associative and idempotent, and the union of
/// two sets closed under parent is closed under parent. insert(k) joins with the smallest closed set that contains k,
/// {k and its ancestors}. So two sides that have seen the same SPLITs hold the same set, whatever the order, the
/// repetitions, and whoever split first.
class SplitSet {
 public:
  /// Adds `path` and its missing ancestors; returns the new paths, ancestors first, in the order in which a mesh can
  /// insert them. Empty for a known path. Requires a valid path (1 or above, depth at most dyadic::kMaxDepth).
  std::vector<dyadic::Path> insert(dyadic::Path path);
  [[nodiscard]] bool contains(dyadic::Path path) const;

  [[nodiscard]] std::size_t size() const { return paths_.size(); }
  [[nodiscard]] const std::vector<dyadic::Path>& paths() const { return paths_; }  ///< ascending: parents first
  friend bool operator==(const SplitSet&, const SplitSet&) = default;

 private:
  std::vector<dyadic::Path> paths_;
};

/// Lets two sides check that they hold the same points: 24 bytes for any number of points. Different sets have equal
/// digests with a probability of about 2^-64.
struct SplitDigest {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;     ///< hashes of the paths, added up
  std::uint64_t toggle = 0;  ///< their exclusive or
  void add(dyadic::Path path);
  friend bool operator==(const SplitDigest&, const SplitDigest&) = default;
};
[[nodiscard]] SplitDigest digest(const SplitSet& set);

}  // namespace driftmesh::protocol
