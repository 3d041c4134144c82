#pragma once

#include <cstddef>
#include <vector>

#include "adapt/generation.hpp"
#include "base/bytes.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// `of_one(s)`, a flat value, for each subdomain, from the rank that has it, on all ranks. Collective. Sums that are
/// formed in the order of the result have the same bits on all ranks.
template <class OfOne>
[[nodiscard]] auto of_all_parts(Ranks& ranks, const Generation& generation, const OfOne& of_one) {
  using Value = decltype(of_one(SubdomainId{}));
  IdVector<SubdomainId, Value> all(generation.parts.size());
  ByteWriter own;
  for (const SubdomainId s : generation.here) {
    all[s] = of_one(s);
    own.value(s);
    own.value(all[s]);
  }
  if (ranks.alone()) return all;
  for (const Bytes& bytes : ranks.bytes_of_all(own.take()))
    for (ByteReader reader(bytes); !reader.at_end();) {
      const auto s = reader.value<SubdomainId>();
      reader.value(all.at(s));
    }
  return all;
}

}  // namespace driftmesh::adapt
