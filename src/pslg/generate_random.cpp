#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

#include "driftmesh/generate.hpp"
#include "geometry/midpoint.hpp"
#include "pslg/generators.hpp"
#include "pslg/seeded_random.hpp"
#include "pslg/shape_builder.hpp"

namespace driftmesh {
namespace {

// Directions in counterclockwise order: east, north, west, south.
constexpr std::array<std::int32_t, 4> kStepX{1, 0, -1, 0};
constexpr std::array<std::int32_t, 4> kStepY{0, 1, 0, -1};

struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

std::uint64_t key(const Cell& c) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.x)) << 32 | static_cast<std::uint32_t>(c.y);
}

/// A random tree of cells of the square grid, grown from one cell (Eden growth, edges kept).
class CellTree {
 public:
  CellTree(std::int32_t cells, SeededRandom& random) {
    std::unordered_set<std::uint64_t> taken{key({})};
    std::vector<Cell> growing{{}};  // cells that may have a free neighbor
    while (static_cast<std::int32_t>(taken.size()) < cells) {
      const std::size_t pick = random.below(growing.size());
      const Cell from = growing[pick];
      const std::size_t direction = random.below(4);
      const Cell to = step(from, direction);
      if (taken.insert(key(to)).second) {
        links_.insert(link(from, direction));
        growing.push_back(to);
      } else if (enclosed(from, taken)) {
        growing[pick] = growing.back();
        growing.pop_back();
      }
    }
  }

  /// Whether the tree joins the cell to its neighbor in that direction.
  [[nodiscard]] bool joined(const Cell& cell, std::size_t direction) const {
    return links_.count(link(cell, direction)) > 0;
  }
  static Cell step(const Cell& c, std::size_t direction) { return {c.x + kStepX[direction], c.y + kStepY[direction]}; }

 private:
  static bool enclosed(const Cell& c, const std::unordered_set<std::uint64_t>& taken) {
    for (std::size_t d = 0; d < 4; ++d)
      if (taken.count(key(step(c, d))) == 0) return false;
    return true;
  }
  // The same name for both directions: the lower cell, and whether the link goes east or north.
  static std::uint64_t link(const Cell& c, std::size_t direction) {
    const Cell low = direction < 2 ? c : step(c, direction);
    return key(low) ^ (direction % 2 == 0 ? 0 : std::uint64_t{1} << 63);
  }

  std::unordered_set<std::uint64_t> links_;
};

// Walks around the tree, counterclockwise, on a grid twice as fine: every quarter of every cell is visited once.
// Quarters are numbered south-west, south-east, north-east, north-west; the walk from one to the next follows a side
// of the cell, or crosses it where the tree continues.
Chain outline(const CellTree& tree, std::int32_t cells) {
  Chain loop;
  Cell cell;
  std::size_t quarter = 0;
  for (std::int32_t i = 0; i < 4 * cells; ++i) {
    const bool east = quarter == 1 || quarter == 2, north = quarter >= 2;
    loop.push_back({2.0 * cell.x + (east ? 1 : 0), 2.0 * cell.y + (north ? 1 : 0)});
    const std::size_t side = (quarter + 3) % 4;
    if (tree.joined(cell, side)) {
      cell = CellTree::step(cell, side);
      quarter = (quarter + 3) % 4;
    } else {
      quarter = (quarter + 1) % 4;
    }
  }
  return loop;
}

// Corners, and therefore edges, stay within `jitter` of their original place in each axis: edges without a common
// corner were at least 1 apart and cannot meet.
void displace(Chain& loop, double jitter, SeededRandom& random) {
  for (Point& p : loop) {
    p.x += random.uniform(-jitter, jitter);
    p.y += random.uniform(-jitter, jitter);
  }
}

// Adds up to three vertices, at the midpoints of the first edges.
Chain with_extra(const Chain& loop, std::size_t extra) {
  Chain result;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    result.push_back(loop[i]);
    if (i < extra) result.push_back(midpoint(loop[i], loop[(i + 1) % loop.size()]));
  }
  return result;
}

using Index = std::int32_t;

/// Points of the unit square grouped by the cells of a grid, those of a cell in the order of x.
std::vector<std::vector<Index>> cells_of(const std::vector<Point>& points, std::size_t side) {
  std::vector<std::vector<Index>> cells(side * side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto column = static_cast<std::size_t>(points[i].x * static_cast<double>(side));
    const auto row = static_cast<std::size_t>(points[i].y * static_cast<double>(side));
    cells[row * side + column].push_back(static_cast<Index>(i));
  }
  for (auto& cell : cells)
    std::sort(cell.begin(), cell.end(), [&](Index a, Index b) { return points[a].x < points[b].x; });
  return cells;
}

}  // namespace

void require_valid(const RandomPolygonOptions& o) {
  require_option(o.vertices >= 4 && o.vertices <= 100'000'000, "random-polygon",
                 "the number of vertices must be 4 to 100000000");
  require_option(o.jitter >= 0 && o.jitter < 0.5, "random-polygon", "the jitter must be 0 to less than 0.5");
}

Pslg generate_random_polygon(const RandomPolygonOptions& o) {
  require_valid(o);
  SeededRandom random(o.seed);
  const std::int32_t cells = o.vertices / 4;
  const CellTree tree(cells, random);
  Chain loop = outline(tree, cells);
  displace(loop, o.jitter, random);
  Pslg pslg;
  add_loop(pslg, with_extra(loop, o.vertices % 4), 1);
  return checked(std::move(pslg), "random-polygon");
}

void require_valid(const RandomPointsOptions& o) {
  require_option(o.points >= 3 && o.points <= 500'000'000, "random-points",
                 "the number of points must be 3 to 500000000");
  require_option(o.segments >= 0 && o.segments <= o.points / 4, "random-points",
                 "the number of segments must be 0 to a quarter of the points");
}

Pslg generate_random_points(const RandomPointsOptions& o) {
  require_valid(o);
  SeededRandom random(o.seed);
  Pslg pslg;
  pslg.points.reserve(o.points + 4);
  for (std::int32_t i = 0; i < o.points; ++i) {
    const double x = random.uniform();
    pslg.points.push_back({x, random.uniform()});
  }
  // Pairs of neighbors in the order of x, inside one cell: neither two of one cell nor of two cells meet. Of c cells
  // with n points in all, there are at least (n - c) / 2 pairs: enough with c <= 1.25 m and 4 m <= n.
  const auto side = std::max(1, static_cast<std::int32_t>(std::sqrt(1.25 * o.segments)));
  const auto cells = cells_of(pslg.points, side);
  for (std::size_t k = 0; static_cast<std::int32_t>(pslg.segments.size()) < o.segments; k += 2)
    for (const auto& cell : cells)
      if (k + 1 < cell.size() && static_cast<std::int32_t>(pslg.segments.size()) < o.segments)
        pslg.segments.push_back({cell[k], cell[k + 1], 2});
  add_loop(pslg, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1);
  return checked(std::move(pslg), "random-points");
}

}  // namespace driftmesh
