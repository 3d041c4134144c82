#pragma once

#include <cstdint>
#include <string>

#include "driftmesh/id_vector.hpp"

// Numbers that more than one box speaks of, each a type of its own.
namespace driftmesh {

/// A process of a parallel run: 0 .. ranks - 1.
enum class Rank : std::int32_t {};

/// A subdomain of a decomposition: 0 .. subdomains - 1, the same on every rank.
enum class SubdomainId : std::int32_t {};
inline constexpr SubdomainId kNoSubdomain{-1};

/// The next rank; there need not be one.
[[nodiscard]] constexpr Rank after(Rank rank) {
  return Rank{to_int(rank) + 1};
}
/// The rank after this one in the ring of all.
[[nodiscard]] constexpr Rank next_in_ring(Rank rank, std::int32_t ranks) {
  return Rank{(to_int(rank) + 1) % ranks};
}

/// A root of a decomposition: a segment that refinement cuts at dyadic points only, the same on every rank. (A RootId
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
