#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "support/error_text.hpp"
#include "support/random_mesh.hpp"

using namespace driftmesh;
using namespace driftmesh::test;

namespace {

using Spot = std::array<double, 2>;

/// All that belongs to a point, a triangle and an edge, by places in the plane instead of numbers.
struct Content {
  std::multimap<Spot, std::tuple<std::int32_t, std::vector<double>>> points;
  std::multimap<std::array<Spot, 3>, std::tuple<double, std::int32_t>> triangles;
  std::vector<std::tuple<Spot, Spot, std::int32_t>> edges;
  friend bool operator==(const Content&, const Content&) = default;
};

Content content_of(const Mesh& mesh) {
  const auto at = [&](std::int32_t v) {
    const Point& p = mesh.points.at(static_cast<std::size_t>(v));
    return Spot{p.x, p.y};
  };
  Content content;
  const auto each = static_cast<std::size_t>(mesh.attributes_per_point);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    std::vector<double> attributes;
    for (std::size_t i = 0; i < each; ++i) attributes.push_back(mesh.attributes.at(v * each + i));
    content.points.insert(
        {at(static_cast<std::int32_t>(v)), {mesh.point_markers.empty() ? 0 : mesh.point_markers.at(v), attributes}});
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    content.triangles.insert(
        {{at(a), at(b), at(c)},
         {mesh.regions.empty() ? 0 : mesh.regions.at(t), mesh.subdomains.empty() ? 0 : mesh.subdomains.at(t)}});
  }
  for (const Mesh::Edge& edge : mesh.edges) content.edges.emplace_back(at(edge.a), at(edge.b), edge.marker);
  return content;
}

/// The mesh with its points and triangles in any order.
Mesh shuffled(Mesh mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::int32_t> number(mesh.points.size());
  std::iota(number.begin(), number.end(), 0);
  std::ranges::shuffle(number, random);
  Mesh result = mesh;
  for (std::size_t v = 0; v < number.size(); ++v) {
    const auto to = static_cast<std::size_t>(number[v]);
    result.points[to] = mesh.points[v];
    if (!mesh.point_markers.empty()) result.point_markers[to] = mesh.point_markers[v];
  }
  result.attributes.clear();
  result.attributes_per_point = 0;
  for (auto& triangle : result.triangles)
    for (std::int32_t& v : triangle) v = number[static_cast<std::size_t>(v)];
  for (Mesh::Edge& edge : result.edges)
    for (std::int32_t* v : {&edge.a, &edge.b}) *v = number[static_cast<std::size_t>(*v)];
  return result;
}

}  // namespace

TEST_CASE("an order changes numbers and nothing else") {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Mesh mesh = RandomMesh(seed, 5, 4).mesh();
    mesh.subdomains.resize(mesh.triangles.size());
    std::iota(mesh.subdomains.begin(), mesh.subdomains.end(), 0);
    for (const MeshOrder order : {MeshOrder::kHilbert, MeshOrder::kRcm}) {
      const Mesh changed = ordered(mesh, order);
      CHECK(content_of(changed) == content_of(mesh));
      CHECK(std::ranges::is_sorted(changed.triangles, {}, [](const auto& t) { return std::ranges::min(t); }));
    }
    CHECK(ordered(mesh, MeshOrder::kGiven).points == mesh.points);
  }
}

TEST_CASE("reverse Cuthill-McKee makes the bandwidth of a shuffled strip that of its columns") {
  constexpr std::int32_t kLong = 200, kWide = 4;  // points
  Mesh strip;
  for (std::int32_t x = 0; x < kLong; ++x)
    for (std::int32_t y = 0; y < kWide; ++y) strip.points.push_back({double(x), double(y)});
  for (std::int32_t x = 0; x + 1 < kLong; ++x)
    for (std::int32_t y = 0; y + 1 < kWide; ++y) {
      const std::int32_t a = x * kWide + y, b = a + kWide;
      strip.triangles.push_back({a, b, b + 1});
      strip.triangles.push_back({a, b + 1, a + 1});
    }
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const Mesh mesh = shuffled(strip, seed);
    CHECK(bandwidth(mesh) > 500);
    CHECK(bandwidth(ordered(mesh, MeshOrder::kRcm)) <= 2 * kWide);
    CHECK(bandwidth(ordered(mesh, MeshOrder::kHilbert)) < bandwidth(mesh));
  }
}

TEST_CASE("parts without a connection, lonely points and empty meshes have an order") {
  Mesh mesh;
  mesh.points = {{9, 9}, {0, 0}, {1, 0}, {0, 1}, {5, 5}, {6, 5}, {5, 6}};
  mesh.triangles = {{4, 5, 6}, {1, 2, 3}};
  for (const MeshOrder order : {MeshOrder::kHilbert, MeshOrder::kRcm}) {
    CHECK(content_of(ordered(mesh, order)) == content_of(mesh));
    CHECK(bandwidth(ordered(mesh, order)) == 2);
    CHECK(ordered(Mesh{}, order).points.empty());
  }
  CHECK(bandwidth(Mesh{}) == 0);
  CHECK(driftmesh::testing::error_text([] { (void)mesh_order_from("RCM"); }) ==
        "order: is 'RCM'; it must be given, hilbert or rcm");
}

TEST_CASE("orders reduce the bandwidth of a mesh as it is made") {
  const Mesh made = mesh(generate("pipe"), {.max_area = 20});
  CHECK(bandwidth(ordered(made, MeshOrder::kRcm)) * 5 < bandwidth(made));
}
