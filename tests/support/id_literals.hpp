#pragma once

#include "driftmesh/ids.hpp"

/// Literals for IDs in tests.
namespace driftmesh {

[[nodiscard]] consteval Rank operator""_rank(unsigned long long number) {
  return static_cast<Rank>(number);
}
[[nodiscard]] consteval SubdomainId operator""_sub(unsigned long long number) {
  return static_cast<SubdomainId>(number);
}
[[nodiscard]] consteval GlobalRootId operator""_root(unsigned long long number) {
  return static_cast<GlobalRootId>(number);
}

}  // namespace driftmesh
