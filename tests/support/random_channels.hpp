#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "support/random.hpp"
#include "support/rings.hpp"

// Domains with channels.
namespace driftmesh::testing {

/// A channel about 1 wide, with bends, steps or rough banks, or straight along the x axis; every second one opens into
/// a basin at its end, with an island. Banks have marker 1, the basin 2, the island 3. Banks may cross in sharp bends.
[[nodiscard]] inline Pslg random_channel(Random& random) {
  const int count = std::vector<int>{6, 20, 60}[random() % 3];
  const std::uint64_t kind = random() % 4;  // 0: straight, 1: smooth, 2: rough, 3: in steps
  const double step = uniform(random, 0.3, 3);
  std::vector<Point> left, right;
  Point at{0, 0};
  double angle = 0, turn = 0, log_width = 0;
  for (int i = 0; i < count; ++i) {
    turn = 0.7 * turn + uniform(random, -0.2, 0.2) * std::min(1.0, step);
    if (kind != 0) angle = std::clamp(0.95 * angle + turn, -1.2, 1.2);
    at = {at.x + step * std::cos(angle), at.y + step * std::sin(angle)};
    if (kind == 1) log_width = 0.9 * log_width + uniform(random, -0.25, 0.25);
    if (kind == 2) log_width = 0.5 * log_width + uniform(random, -0.5, 0.5);
    if (kind == 3 && random() % 10 == 0) log_width = uniform(random, -1.5, 0.7);
    const double half = std::exp(std::clamp(log_width, -2.0, 0.7)) / 2;
    left.push_back({at.x - half * std::sin(angle), at.y + half * std::cos(angle)});
    right.push_back({at.x + half * std::sin(angle), at.y - half * std::cos(angle)});
  }
  std::vector<Point> ring(left);
  const bool opens = random() % 2 == 0;
  if (opens)
    for (const Point& corner : {Point{0.01, 8}, Point{12, 8}, Point{12, -8}, Point{0.01, -8}})
      ring.push_back({at.x + corner.x, at.y + corner.y});
  ring.insert(ring.end(), right.rbegin(), right.rend());
  Pslg pslg;
  add_ring(pslg, ring, 1);
  if (!opens) return pslg;
  for (std::size_t i = left.size() - 1; i < left.size() + 4; ++i) pslg.segments[i].marker = 2;
  std::vector<Point> island;
  const Point center{at.x + uniform(random, 5, 8), at.y + uniform(random, -5, 5)};
  for (int i = 0; i < 8; ++i) {
    const double radius = uniform(random, 1, 2.9);
    island.push_back({center.x + radius * std::cos(i * 0.785), center.y + radius * std::sin(i * 0.785)});
  }
  add_ring(pslg, island, 3);
  pslg.holes.push_back(center);
  return pslg;
}

}  // namespace driftmesh::testing
