#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "driftmesh/pslg.hpp"
#include "geometry/predicates.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh::testing {

inline Pslg rectangle(double width, double height) {
  Pslg pslg;
  pslg.points = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return pslg;
}

/// A square with `wedges` segments of random lengths and directions that meet at its center.
inline Pslg fan(unsigned seed, int wedges) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi), radius(0.1, 0.9);
  Pslg pslg;
  pslg.points = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, 0}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  for (int i = 0; i < wedges; ++i) {
    const double a = angle(random), r = radius(random);
    pslg.segments.push_back({4, static_cast<std::int32_t>(pslg.points.size()), 2});
    pslg.points.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return pslg;
}

/// Checks the invariants of a triangulation from its raw arrays: orientation, reciprocity, local Delaunay property.
inline void check_valid(const Triangulation& mesh) {
  std::size_t inverted = 0, unlinked = 0, not_delaunay = 0;
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    inverted += !(orient2d(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) > 0);
    for (int k = 0; k < 3; ++k) {
      const HalfEdge h = half_edge(t, k), g = mesh.twin(h);
      if (is_constrained(g)) {
        const Subsegment& s = mesh.subsegments[subsegment_of(g)];
        unlinked += !s.is_leaf() || (s.half[0] != h && s.half[1] != h);
      } else {
        unlinked +=
            mesh.twin(g) != h || mesh.edge_start(g) != mesh.edge_end(h) || mesh.edge_end(g) != mesh.edge_start(h);
        not_delaunay +=
            incircle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), mesh.points[mesh.apex(g)]) > 0;
      }
    }
  }
  CHECK(inverted == 0);
  CHECK(unlinked == 0);
  CHECK(not_delaunay == 0);
}

}  // namespace driftmesh::testing
