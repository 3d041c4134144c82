#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/generation.hpp"
#include "adapt/transfer.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// What a rank has of the present generation, apart from its parts' meshes; to look at.
struct Held {
  const Generation& generation;
  const Fields& fields;
  const Stayed& stayed;
};
/// The same, to keep.
struct Holding {
  Generation generation;
  Fields fields;
  Stayed stayed;
  operator Held() const {  // NOLINT(google-explicit-constructor): it is the same
    return {generation, fields, stayed};
  }
};

/// The same with other holders of subdomains, which are given on all ranks: what moves takes its fields along, and
/// nothing of what arrives counts as having stayed. `assemble`: as adapt::assemble, with what the caller knows.
/// Collective.
[[nodiscard]] Holding moved(const Held& present, const IdVector<SubdomainId, Rank>& holders,
                            const std::function<Generation(Parts)>& assemble, Ranks& ranks);

}  // namespace driftmesh::adapt
