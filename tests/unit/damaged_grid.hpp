#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <utility>

#include "oracles/grid_mesh.hpp"
#include "verify/verify.hpp"

// Shared by tests of the verifier: ways to damage a correct mesh, and checks of the report.

namespace driftmesh::testing {

inline VerifyReport check(const oracles::GridCase& grid, double min_angle = 44.9, double max_area = 0.51) {
  VerifyOptions options;
  options.min_angle = min_angle;
  options.plain.area = max_area;
  return verify(grid.mesh, grid.input, options);
}

inline std::string all_messages(const VerifyReport& report) {
  std::string text;
  for (std::size_t f = 0; f < kFlawCount; ++f)
    for (const auto& message : report.findings.messages(static_cast<Flaw>(f)))
      text += std::string(flaw_name(static_cast<Flaw>(f))) + ": " + message + "\n";
  return text;
}

inline std::size_t find_triangle(const Mesh& mesh, std::array<std::int32_t, 3> corners) {
  std::sort(corners.begin(), corners.end());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto sorted = mesh.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    if (sorted == corners) return t;
  }
  FAIL("the mesh has no such triangle");
  return 0;
}

inline void drop_triangle(Mesh& mesh, std::size_t t) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.regions.erase(mesh.regions.begin() + static_cast<std::ptrdiff_t>(t));
}

inline void add_triangle(Mesh& mesh, std::array<std::int32_t, 3> corners, double region) {
  mesh.triangles.push_back(corners);
  mesh.regions.push_back(region);
}

inline std::int32_t add_point(Mesh& mesh, Point p) {
  mesh.points.push_back(p);
  mesh.point_markers.push_back(0);
  return static_cast<std::int32_t>(mesh.points.size()) - 1;
}

inline Mesh::Edge& subsegment(Mesh& mesh, std::int32_t a, std::int32_t b) {
  for (auto& edge : mesh.edges)
    if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a)) return edge;
  FAIL("the mesh has no such subsegment");
  return mesh.edges.front();
}

inline void drop_subsegment(Mesh& mesh, std::int32_t a, std::int32_t b) {
  mesh.edges.erase(mesh.edges.begin() + (&subsegment(mesh, a, b) - mesh.edges.data()));
}

/// A grid with some random damage of every kind that keeps its indices valid.
inline Mesh randomly_damaged(std::mt19937& random) {
  Mesh mesh = oracles::GridCase().mesh;
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t left = below(12); left > 0; --left) {
    auto& triangle = mesh.triangles[below(mesh.triangles.size())];
    switch (below(5)) {
      case 0:
        std::swap(triangle[0], triangle[1]);
        break;
      case 1:
        mesh.points[below(mesh.points.size())].x += 0.6;
        break;
      case 2:
        drop_triangle(mesh, below(mesh.triangles.size()));
        break;
      case 3:
        mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(below(mesh.edges.size())));
        break;
      default:
        mesh.edges.push_back({triangle[0], triangle[1], 3});
    }
  }
  return mesh;
}

}  // namespace driftmesh::testing

/// There are flaws of that kind, and no others.
#define CHECK_ONLY(report, flaw)                                   \
  do {                                                             \
    INFO(all_messages(report));                                    \
    CHECK(report.findings.count(flaw) > 0);                        \
    CHECK(report.findings.total() == report.findings.count(flaw)); \
    CHECK(!report.findings.messages(flaw).empty());                \
  } while (false)

/// There are flaws of that kind, and perhaps others.
#define CHECK_HAS(report, flaw)             \
  do {                                      \
    INFO(all_messages(report));             \
    CHECK(report.findings.count(flaw) > 0); \
  } while (false)
