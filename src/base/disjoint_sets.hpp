#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

/// Union-find with path halving over the numbers 0 .. n - 1 of type Id.
template <IsId Id = std::int32_t>
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    for (const Id i : ids_of(parent_)) parent_[i] = i;
  }

  [[nodiscard]] Id find(Id i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The lower root becomes the root of both, which keeps trees flat enough when items are joined in index order. False
  /// if they were in the same set already.
  bool join(Id a, Id b) {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
    return a != b;
  }

 private:
  IdVector<Id, Id> parent_;
};

}  // namespace driftmesh
