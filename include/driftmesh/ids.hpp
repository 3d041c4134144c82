#pragma once

#include <cstdint>
#include <string>

#include "driftmesh/id_vector.hpp"

// IDs used by more than one box, each with its own type.
namespace driftmesh {

/// A process of a parallel run: 0 .. ranks - 1.
///
/// \code
/// for (const driftmesh::Rank r : driftmesh::first_ids<driftmesh::Rank>(4))
///   std::cout << to_string(r) << " sends to " << to_string(driftmesh::next_in_ring(r, 4)) << '\n';
/// \endcode
enum class Rank : std::int32_t {};

/// A subdomain of a decomposition: 0 .. subdomains - 1, the same on every rank.
enum class SubdomainId : std::int32_t {};
inline constexpr SubdomainId kNoSubdomain{-1};

/// The next higher rank; it may not exist.
[[nodiscard]] constexpr Rank after(Rank rank) {
  return Rank{to_int(rank) + 1};
}
/// The next rank in the ring of all ranks.
[[nodiscard]] constexpr Rank next_in_ring(Rank rank, std::int32_t ranks) {
  return Rank{(to_int(rank) + 1) % ranks};
}

/// A root of a decomposition: a segment that refinement splits only at dyadic points, the same on every rank. (A RootId
/// is a root of one triangulation.)
enum class GlobalRootId : std::int32_t {};

[[nodiscard]] inline std::string to_string(Rank rank) {
  return std::to_string(to_int(rank));
}
[[nodiscard]] inline std::string to_string(SubdomainId subdomain) {
  return std::to_string(to_int(subdomain));
}
[[nodiscard]] inline std::string to_string(GlobalRootId root) {
  return std::to_string(to_int(root));
}

}  // namespace driftmesh
