#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"

namespace driftmesh::oracles {

/// An input and a mesh of it that is known to be correct: a 12 x 12 square of unit cells, each cut into two triangles,
/// with a 4 x 4 hole and a segment from side to side that separates two regions. Every quality mesh check has something
/// to look at; the 45-degree angles are the smallest.
///
///     (0,12)---3---(12,12)     markers: 1 bottom, 2 right, 3 top, 4 left, 5 hole, 6 the segment y = 9
///        4   region 20  2      regions: attribute 10 below y = 9 (area bound 0.6), 20 above (no bound)
///     (0,9)----6---(12,9)      the hole is [4, 8] x [3, 7]
///        4   region 10  2      (2, 1) is an input point without a segment
///     (0,0)----1---(12,0)
struct GridCase {
  static constexpr int kSize = 12;
  Pslg input;
  Mesh mesh;

  GridCase() {
    fill_input();
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        if (!in_hole(x, y)) add_cell(x, y);
    for (const auto& s : input.segments) add_chain(s);
    mesh.point_markers.assign(mesh.points.size(), 0);
  }

  [[nodiscard]] static bool in_hole(int x, int y) { return x >= 4 && x < 8 && y >= 3 && y < 7; }
  /// The mesh's number of the point at (x, y).
  [[nodiscard]] std::int32_t at(int x, int y) const { return number_.at({x, y}); }

 private:
  void fill_input() {
    input.points = {{0, 0}, {12, 0}, {12, 9}, {12, 12}, {0, 12}, {0, 9}, {4, 3}, {8, 3}, {8, 7}, {4, 7}, {2, 1}};
    input.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 2}, {3, 4, 3}, {4, 5, 4}, {5, 0, 4},
                      {6, 7, 5}, {7, 8, 5}, {8, 9, 5}, {9, 6, 5}, {5, 2, 6}};
    input.holes = {{5.5, 4.5}};
    input.regions = {{{1, 1.5}, 10, 0.6}, {{1, 10.5}, 20, 0}};
  }

  std::int32_t point(int x, int y) {
    const auto [entry, added] = number_.try_emplace({x, y}, static_cast<std::int32_t>(mesh.points.size()));
    if (added) mesh.points.push_back({static_cast<double>(x), static_cast<double>(y)});
    return entry->second;
  }

  void add_cell(int x, int y) {
    const std::int32_t a = point(x, y), b = point(x + 1, y), c = point(x + 1, y + 1), d = point(x, y + 1);
    if ((x + y) % 2 == 0)
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {c, d, a}});
    else
      mesh.triangles.insert(mesh.triangles.end(), {{d, a, b}, {b, c, d}});
    mesh.regions.insert(mesh.regions.end(), 2, y < 9 ? 10.0 : 20.0);
  }

  void add_chain(const Pslg::Segment& s) {
    const auto whole = [](double v) { return static_cast<int>(v); };
    const Point &a = input.points[s.a], &b = input.points[s.b];
    const auto sign = [](double d) { return d > 0 ? 1 : d < 0 ? -1 : 0; };
    const int dx = sign(b.x - a.x), dy = sign(b.y - a.y);
    for (int x = whole(a.x), y = whole(a.y); x != whole(b.x) || y != whole(b.y); x += dx, y += dy)
      mesh.edges.push_back({at(x, y), at(x + dx, y + dy), s.marker});
  }

  std::map<std::pair<int, int>, std::int32_t> number_;
};

}  // namespace driftmesh::oracles
