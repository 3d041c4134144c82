#pragma once

#include "dyadic/path.hpp"

namespace driftmesh {

/// A point on a root, without coordinates: what a SPLIT says. Among which roots the number counts is said by its type.
template <class Root>
struct SplitPoint {
  Root root{};
  dyadic::Path path = dyadic::kWhole;
  friend bool operator==(const SplitPoint&, const SplitPoint&) = default;
};

}  // namespace driftmesh
