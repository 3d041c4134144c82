#include "migration/triangle_code.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "mesh/refiner.hpp"
#include "support/prepared_mesh.hpp"
#include "support/random_domain.hpp"

// Triangles in a byte each: back as they were, small, and refused where they cannot be.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// A mesh with the vertices on its borders as fixed ones, and all border half-edges as entrances.
struct Coded {
  explicit Coded(const Triangulation& from) : mesh(from), number(from.points.size(), kNone) {
    for (const TriangleId t : ids_of(mesh.triangles))
      for (int i = 0; i < 3 && mesh.triangles[t].alive(); ++i) {
        const HalfEdge h = half_edge(t, i);
        if (mesh.across(h) != kNone) continue;
        for (const VertexId v : {mesh.edge_start(h), mesh.edge_end(h)})
          if (number[v] == kNone) number[v] = VertexId{fixed++};
        border.push_back({number[mesh.edge_start(h)], number[mesh.edge_end(h)]});
        entrances.push_back(h);
      }
  }
  [[nodiscard]] CodedTriangles encode() { return encode_triangles(mesh, number, fixed, border, entrances); }

  const Triangulation& mesh;
  IdVector<VertexId, VertexId> number;
  std::int32_t fixed = 0;
  std::vector<BorderEdge> border;
  std::vector<HalfEdge> entrances;
};

/// Corners from the least one on, with the label.
using Item = std::pair<std::array<std::int32_t, 3>, std::uint16_t>;

Item item(const std::array<VertexId, 3>& corners, std::uint16_t region) {
  std::array<std::int32_t, 3> c{to_int(corners[0]), to_int(corners[1]), to_int(corners[2])};
  std::rotate(c.begin(), std::ranges::min_element(c), c.end());
  return {c, region};
}

std::vector<Item> decoded(const CodedTriangles& coded, std::span<const BorderEdge> border) {
  std::vector<Item> all;
  decode_triangles(coded, border,
                   [&](const auto& corners, std::uint16_t region) { all.push_back(item(corners, region)); });
  return all;
}

constexpr std::array<BorderEdge, 3> kBorder{
    {{VertexId{0}, VertexId{1}}, {VertexId{1}, VertexId{2}}, {VertexId{2}, VertexId{0}}}};

/// A single triangle whose third corner has this number, coded in these bytes behind the edge from 0 to 1.
CodedTriangles one(std::initializer_list<unsigned> bytes, std::int32_t vertices = 3) {
  CodedTriangles coded{.code = {}, .triangles = 1, .fixed = 3, .vertices = vertices};
  for (const unsigned byte : {0U, 1U}) coded.code.push_back(static_cast<std::byte>(byte));
  for (const unsigned byte : bytes) coded.code.push_back(static_cast<std::byte>(byte));
  return coded;
}

}  // namespace

TEST_CASE("coded triangles come back, and take no more bytes than they did") {
  std::size_t bytes = 0, triangles = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Triangulation mesh = prepared(random_domain(seed));
    QualityBounds bounds;
    bounds.plain.area = 0.004;
    CHECK(Refiner(mesh, bounds).refine() == Refiner::Status::kDone);
    Coded coded(mesh);
    const CodedTriangles code = coded.encode();
    CHECK(code.triangles == static_cast<std::int32_t>(mesh.live_triangles()));
    CHECK(code.vertices == static_cast<std::int32_t>(mesh.live_vertices()));
    std::vector<Item> all = decoded(code, coded.border), expected;
    for (const TriangleId t : ids_of(mesh.triangles)) {
      if (!mesh.triangles[t].alive()) continue;
      const auto& v = mesh.triangles[t].vertex;
      expected.push_back(item({coded.number[v[0]], coded.number[v[1]], coded.number[v[2]]},
                              mesh.region.empty() ? std::uint16_t{0} : mesh.region[t]));
    }
    std::ranges::sort(all);
    std::ranges::sort(expected);
    CHECK(all == expected);
    bytes += code.code.size();
    triangles += mesh.live_triangles();
  }
  CHECK(triangles > 20'000);
  CHECK(bytes <= 42'131);  // small meshes with many corners; it was as many when this was written
}

TEST_CASE("the border of what is not covered is known from both ends of each edge") {
  const VertexId a{0}, b{1}, c{2}, top{3};
  BorderGuess guess(4, kBorder);
  const auto is_border = [&](const std::vector<VertexId>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const VertexId v = ring[i], next = ring[(i + 1) % ring.size()];
      CHECK(guess.after(v) == next);
      CHECK(guess.before(next) == v);
    }
  };
  is_border({a, b, c});
  guess.cover(a, b, top);  // on no border yet
  is_border({a, top, b, c});
  guess.cover(top, b, c);  // which follows b
  is_border({a, top, c});
}

TEST_CASE("triangles that no entrance leads to are an error") {
  Pslg two;
  two.points = {{0, 0}, {1, 0}, {0, 1}, {5, 0}, {6, 0}, {5, 1}};
  two.segments = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}, {3, 4, 1}, {4, 5, 1}, {5, 3, 1}};
  const Triangulation mesh = prepared(two);
  Coded coded(mesh);
  CHECK(coded.encode().triangles == 2);
  Coded half(mesh);
  half.entrances.resize(1);
  CHECK_THROWS_AS((void)half.encode(), Error);
}

TEST_CASE("code that cannot be is refused") {
  using namespace triangle_code;
  const auto refused = [](const CodedTriangles& coded) {
    try {
      (void)decoded(coded, kBorder);
      return false;
    } catch (const Error&) {
      return true;
    }
  };
  CHECK(decoded(one({kNamed, 2}), kBorder) == std::vector<Item>{{{0, 1, 2}, 0}});
  CHECK(decoded(one({kNamed | kNewRegion, 2, 9}), kBorder) == std::vector<Item>{{{0, 1, 2}, 9}});
  CHECK(decoded(one({kAfter}), kBorder) == std::vector<Item>{{{0, 1, 2}, 0}});
  CHECK(decoded(one({kNew}, 4), kBorder) == std::vector<Item>{{{0, 1, 3}, 0}});
  CHECK(refused(one({kNamed, 3})));  // not known yet
  CHECK(refused(one({kNamed, 3}, 4)));
  CHECK(refused(one({kNamed | kNewRegion, 2, 0x80, 0x80, 0x04})));  // label 65,536
  CHECK(refused(one({kNew})));                                      // more vertices than there are
  CHECK(refused(one({kNamed, 2}, 4)));                              // fewer
  CHECK(refused(one({kNamed, 2, 0})));                              // bytes are left
  CHECK(refused(one({kNamed | kGoesRight, 2})));                    // a way is left
  CHECK(refused(one({0x20, 2})));
  CHECK(refused(one({})));
}
