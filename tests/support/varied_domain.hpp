#pragma once

#include "driftmesh/pslg.hpp"

namespace driftmesh::testing {

/// With a hole, a crack, an isolated point, regions, markers and an acute corner.
[[nodiscard]] inline Pslg varied_domain() {
  Pslg pslg;
  pslg.points = {{0, 0},     {4, 0},   {4, 1.5},   {0.2, 2},   {1, 0.5},    {1.5, 0.5},
                 {1.5, 1.0}, {1, 1.0}, {2.5, 0.4}, {2.9, 1.1}, {3.3, 0.31}, {3.5, 0}};
  pslg.segments = {{0, 11, 1}, {11, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}, {4, 5, 5},
                   {5, 6, 5},  {6, 7, 5},  {7, 4, 5}, {8, 9, 6}, {11, 9, 7}};
  pslg.holes = {{1.2, 0.7}};
  pslg.regions = {{{0.1, 0.1}, 1, 0}};
  return pslg;
}

}  // namespace driftmesh::testing
