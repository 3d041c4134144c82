#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "adapt/length_growth.hpp"
#include "adapt/linear_lengths.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/cdt.hpp"
#include "property/cases.hpp"

// Lengths at the vertices of triangulations, many of them with very obtuse triangles: points in bands, not refined.

using namespace driftmesh;
using namespace driftmesh::adapt;
using namespace driftmesh::testing;

namespace {

template <class Random>
double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A flat rectangle with points inside, so that most triangles are obtuse.
template <class Random>
Triangulation flat_domain(Random& random, int points) {
  Pslg pslg;
  pslg.points = {{0, 0}, {8, 0}, {8, 1}, {0, 1}};
  pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  for (int k = 0; k < points; ++k) pslg.points.push_back({uniform(random, 0.1, 7.9), uniform(random, 0.02, 0.98)});
  return triangulate(pslg);
}

template <class Random>
Lengths random_lengths(Random& random, const Triangulation& mesh, bool infinite) {
  Lengths lengths;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    lengths.push_back(infinite && random() % 5 == 0 ? std::numeric_limits<double>::infinity()
                                                    : std::exp(uniform(random, -4, 2)));
  return lengths;
}

/// The fixed point, by going over all edges until nothing changes.
void lower_again_and_again(const Triangulation& mesh, double gradation, Lengths& lengths) {
  for (bool any = true; any;) {
    any = false;
    for (const TriangleId t : ids_of(mesh.triangles))
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const VertexId v = mesh.triangles[t].vertex[i], w = mesh.triangles[t].vertex[j];
          const double most = lengths[v] + gradation * std::sqrt(squared_distance(mesh.points[v], mesh.points[w]));
          if (!(most < lengths[w])) continue;
          lengths[w] = most;
          any = true;
        }
  }
}

bool is_obtuse(const Triangulation& mesh, TriangleId t) {
  for (int i = 0; i < 3; ++i)
    if (angle_at(mesh.corner(t, next(i)), mesh.corner(t, i), mesh.corner(t, previous(i))) > 2) return true;
  return false;
}

}  // namespace

TEST_CASE("lengths are lowered to the same bits as by going over all edges, in obtuse triangles, too") {
  auto random = seeded_generator("growth of lengths");
  int lowered = 0, obtuse = 0, unchanged = 0;
  for (std::int64_t i = case_count(60); i > 0; --i) {
    const Triangulation mesh = flat_domain(random, static_cast<int>(random() % 40));
    const double gradation = uniform(random, 0.01, 1);
    Lengths lengths = random_lengths(random, mesh, i % 3 == 0), expected = lengths, before = lengths;
    lower_again_and_again(mesh, gradation, expected);
    const bool any = limit_growth(mesh, gradation, lengths);
    for (const VertexId v : ids_of(lengths)) {
      CHECK(lengths[v] == expected[v]);
      lowered += lengths[v] < before[v];
    }
    CHECK(any == !std::ranges::equal(lengths, before));
    for (const TriangleId t : ids_of(mesh.triangles)) obtuse += is_obtuse(mesh, t);
    unchanged += !limit_growth(mesh, gradation, lengths);
  }
  CHECK(lowered > 20);
  CHECK(obtuse > 20);
  CHECK(unchanged == case_count(60));
}

TEST_CASE("what is said of the lengths within a triangle holds at its points, also in obtuse ones") {
  auto random = seeded_generator("linear lengths");
  int below = 0, not_below = 0, bounded = 0;
  for (std::int64_t i = case_count(60); i > 0; --i) {
    const Triangulation mesh = flat_domain(random, static_cast<int>(5 + random() % 20));
    Lengths lengths = random_lengths(random, mesh, false);
    limit_growth(mesh, uniform(random, 0.05, 2), lengths);
    if (i % 2 == 0)
      for (double& length : lengths) length += 20;  // so that slopes are small beside lengths
    const LinearLengths field(mesh, lengths);
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : ids_of(lengths)) {
      least = std::min(least, lengths[v]);
      CHECK(field.edge_length(mesh.points[v]) == doctest::Approx(lengths[v]));
    }
    CHECK(field.least() == least);
    for (int k = 0; k < 20; ++k) {
      CornerPoints t;
      for (Point& p : t) p = {uniform(random, 0, 8), uniform(random, 0, 1)};
      if (signed_area(t[0], t[1], t[2]) < 0) std::swap(t[1], t[2]);
      double at_corners = std::numeric_limits<double>::infinity(), inside = at_corners;
      for (const Point& p : t) at_corners = std::min(at_corners, field.edge_length(p));
      for (int s = 0; s < 400; ++s) {
        double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        inside = std::min(inside, field.edge_length({t[0].x + u * (t[1].x - t[0].x) + v * (t[2].x - t[0].x),
                                                     t[0].y + u * (t[1].y - t[0].y) + v * (t[2].y - t[0].y)}));
      }
      const double bound = field.least_between(t, at_corners);
      CHECK(bound <= inside * (1 + 1e-9));
      bounded += bound > 0;
      // It falls below what is asked for if some point between has notably less.
      if (inside < 0.99 * at_corners) {
        const double asked = kBetween * (inside + at_corners) / 2;
        CHECK(field.falls_below(t, asked));
        ++below;
      }
      CHECK(!field.falls_below(t, kBetween * bound * 0.999));
      ++not_below;
    }
  }
  CHECK(below > 20);
  CHECK(not_below > 20);
  CHECK(bounded > 5);
}
