#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/generation.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh::adapt {

/// Seconds that a caller has worked on the present mesh, as far as it has told; at most one of the two.
struct Spent {
  std::optional<double> on_rank{};
  std::optional<std::vector<double>> on_parts{};  ///< those on this rank, in the order of their numbers
};

/// The load by which parts are placed on ranks; the same on all of them.
struct Loads {
  IdVector<SubdomainId, double> work;  ///< in triangles of mean cost
  IdVector<SubdomainId, double> bytes;
  IdVector<Rank, double> speeds;  ///< in triangles a second; 0: unknown
};

/// Which part is where in a mesh that comes after another: some are joined first, and some are divided then.
struct Descendants {
  IdVector<SubdomainId, SubdomainId> whole;     ///< what each part of the mesh before has become, or is a part of
  IdVector<SubdomainId, SubdomainId> whole_of;  ///< which of these each part after is, or is a part of
};

/// Loads of the parts of `after`. The time was spent on `before`. If ranks have told of each part, its triangles cost
/// what they did; else all cost the same, and ranks are as fast as they were. Throws Error, on all ranks, for numbers
/// of seconds that do not suit. Collective.
[[nodiscard]] Loads loads_of(const Generation& before, const Generation& after, const Descendants& descendants,
                             const Fields& fields, const Spent& spent, Ranks& ranks);

/// The speeds of ranks, where those that are not known are the mean of the others.
[[nodiscard]] IdVector<Rank, double> speeds_of(const Loads& loads);

/// The time of the slowest rank over what it would be if all took the same; at least 1.
[[nodiscard]] double imbalance(const Loads& loads, const IdVector<SubdomainId, Rank>& holders);

/// Chooses ranks for the parts of this one, in the order of their numbers; empty: nothing moves. Collective.
using Placing = std::function<std::vector<Rank>(const Loads& loads, const Generation& generation,
                                                const Decomposition& decomposition)>;

}  // namespace driftmesh::adapt
