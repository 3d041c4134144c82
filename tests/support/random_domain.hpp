#pragma once

#include <cstddef>
#include <cstdint>

#include "oracles/random_pslg.hpp"

namespace driftmesh::testing {

/// A random domain of this size around the origin, with up to so many holes more than its seed says.
[[nodiscard]] inline Pslg random_domain(std::uint64_t seed, double scale = 1, int more_holes = 0) {
  oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
  shape.scale = scale;
  shape.offset = 0;
  shape.holes += more_holes;
  return oracles::make_random_pslg(seed, shape).input;
}

/// The same of size 1, whose regions ask for triangles of various small areas.
[[nodiscard]] inline Pslg random_domain_with_areas(std::uint64_t seed, int more_holes = 0) {
  Pslg domain = random_domain(seed, 1, more_holes);
  for (std::size_t k = 0; k < domain.regions.size(); ++k)
    domain.regions[k].max_area = 1e-3 / static_cast<double>(1 + (seed + k) % 5);
  return domain;
}

/// Adds a domain to another one, which it does not touch.
inline void append(Pslg& whole, const Pslg& part) {
  const auto first = static_cast<std::int32_t>(whole.points.size());
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  for (const Pslg::Segment& s : part.segments) whole.segments.push_back({s.a + first, s.b + first, s.marker});
  whole.holes.insert(whole.holes.end(), part.holes.begin(), part.holes.end());
  whole.regions.insert(whole.regions.end(), part.regions.begin(), part.regions.end());
}

}  // namespace driftmesh::testing
