#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/driftmesh.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"
#include "support/waves.hpp"

// Random meshes, as other programs have them, too, that get random new domains, to the last bit: names, markers of
// points and lines, regions, points on no line, weirs, lines that nobody lists, lengths, and errors. What is right for
// them is for tests/cli/adapt_test.py.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

class OutlineCase {
 public:
  explicit OutlineCase(std::uint64_t seed) : seed_(seed), random_(seed) {}

  [[nodiscard]] std::string result() {
    const Pslg first = domain();
    Mesh before = changed(mesh(first, {.min_angle = 20, .max_area = 0.05}));
    const Pslg next = changed(first);
    const PartOptions options = options_for(before);
    ValueDigest digest;
    try {
      if (chance(3)) {
        add(digest, adapt_part(before, part_of(before), options));
      } else {
        const AdaptedMesh made = adapt_outline(before, next, options);
        if (options.tolerance == 0) check_domain(made.mesh, next);
        add(digest, made);
      }
    } catch (const Error& error) {
      return error.what();
    }
    return std::to_string(digest.value());
  }

 private:
  /// Whether something happens that does once in so many times.
  bool chance(std::uint64_t times) { return random_() % times == 0; }
  std::int32_t up_to(std::uint64_t most) { return static_cast<std::int32_t>(random_() % (most + 1)); }
  /// On a grid, so that lines and points meet.
  double step() { return 0.0625 * (up_to(8) - 4); }

  Pslg domain() {
    Pslg pslg = random_domain(seed_, 2);
    if (chance(2)) pslg.holes.clear();
    for (std::size_t k = 0; k < pslg.regions.size(); ++k) pslg.regions[k].attribute = static_cast<double>(k % 3 + 1);
    for (Pslg::Segment& segment : pslg.segments) segment.marker = up_to(4);
    if (chance(2))
      for (std::size_t v = 0; v < pslg.points.size(); ++v) pslg.point_markers.push_back(chance(3) ? 7 + up_to(2) : 0);
    if (chance(2)) pslg.names.markers = {{1, "sea"}, {2, "quay"}, {3, "river"}};
    if (chance(2)) pslg.names.regions = {{1, "sand"}, {2, "mud"}};
    return pslg;
  }

  /// As it comes from a program that keeps less, or more.
  Mesh changed(Mesh mesh) {
    const int how = up_to(5);
    if (how == 0) mesh.edges.clear();
    if (how == 1) std::erase_if(mesh.edges, [](const Mesh::Edge& edge) { return edge.marker == 0; });
    if (chance(24)) std::swap(mesh.triangles.front()[0], mesh.triangles.front()[1]);
    if (!chance(3)) {
      mesh.attributes_per_point = 1 + up_to(1);
      mesh.attributes = waves(mesh.points.size() * static_cast<std::size_t>(mesh.attributes_per_point), 0.4);
      if (chance(2)) mesh.attribute_names = {"depth", "heat"};
      mesh.attribute_names.resize(mesh.attribute_names.empty() ? 0
                                                               : static_cast<std::size_t>(mesh.attributes_per_point));
    }
    if (chance(3)) mesh.subdomains.assign(mesh.triangles.size(), up_to(2));
    if (chance(4)) add_weir(mesh);
    for (Point& p : mesh.points)
      if (p.x == 0 && chance(2)) p.x = -0.0;
    return mesh;
  }

  /// From a line to the next one: only that its points are on lines matters.
  void add_weir(Mesh& mesh) {
    if (mesh.edges.size() < 2) return;
    const Mesh::Edge &one = mesh.edges.front(), &other = mesh.edges.back();
    mesh.weirs.push_back(
        {.type = 24, .points = {one.a, one.b}, .across = {other.a, other.b}, .values = {1, 1, 1, 1, 1, 1}});
  }

  /// The domain that it is to have.
  Pslg changed(Pslg pslg) {
    const int how = up_to(9);
    if (how == 0)
      for (Point& p : pslg.points) p.x += 5;  // beside the mesh
    if (how == 1) pslg.holes.clear();
    if (how == 2 && !pslg.regions.empty()) pslg.regions.pop_back();
    if (how == 3)
      for (Pslg::Region& region : pslg.regions) region.attribute += 1;
    for (Point& p : pslg.points)
      if (how >= 5 && chance(4)) p = {p.x + step(), p.y + step()};
    for (Pslg::Segment& segment : pslg.segments)
      if (chance(5)) segment.marker = up_to(6);
    if (how == 8) pslg.points.push_back({step(), step()});  // on no line
    if (how == 9) pslg.segments.pop_back();
    pslg.point_markers.resize(pslg.point_markers.empty() ? 0 : pslg.points.size(), 9);
    if (chance(2)) pslg.names.markers = {{1, "quay"}, {2, "sea"}, {5, "wall"}, {6, "weir"}};
    if (chance(2)) pslg.names.regions = {{1, "mud"}, {3, "rock"}};
    return pslg;
  }

  PartOptions options_for(const Mesh& mesh) {
    PartOptions options{.min_angle = chance(2) ? 20.0 : 0.0};
    if (chance(3)) options.sizes.longest = 0.2;
    if (chance(4)) options.sizes.gradation = 0;
    if (chance(2))
      for (const Point& p : mesh.points) options.lengths.push_back(0.05 + 0.4 * std::abs(p.x) * (chance(9) ? 3 : 1));
    if (chance(10) && !options.lengths.empty()) options.lengths.back() = 0;
    if (chance(6) && !mesh.attribute_names.empty()) options.conserve = {"depth"};
    if (chance(6)) options.tolerance = 0.04;
    return options;
  }

  std::vector<std::int32_t> part_of(const Mesh& mesh) {
    std::vector<std::int32_t> part;
    const double x = step(), y = step();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Point& p = mesh.points[static_cast<std::size_t>(mesh.triangles[t][0])];
      if (std::hypot(p.x - x, p.y - y) < 0.8) part.push_back(static_cast<std::int32_t>(t));
    }
    return part;
  }

  /// Edges that stay keep their markers, names count more than numbers, and a mesh that stays lists what it did.
  static void check_domain(const Mesh& mesh, const Pslg& domain) {
    constexpr std::array<std::string_view, 5> kAllowed{"wrong marker", "wrong point marker", "wrong region",
                                                       "open edge", "input segment missing"};
    const CheckReport report = check(mesh, domain, {.min_angle = 0});
    for (const CheckReport::Finding& finding : report.findings)
      CHECK_MESSAGE(std::ranges::count(kAllowed, finding.kind) == 1, finding.kind);
  }

  static void add(ValueDigest& digest, const AdaptedMesh& made) {
    const Mesh& mesh = made.mesh;
    for (const Point& p : mesh.points) digest.add(p.x), digest.add(p.y);
    for (const auto& corners : mesh.triangles) digest.add(corners);
    for (const Mesh::Edge& edge : mesh.edges) digest.add(std::array{edge.a, edge.b, edge.marker});
    digest.add(mesh.point_markers);
    digest.add(mesh.subdomains);
    for (const double value : mesh.attributes) digest.add(value);
    for (const double region : mesh.regions) digest.add(region);
    for (const Mesh::Weir& weir : mesh.weirs) digest.add(weir.points), digest.add(weir.across);
    for (const auto& [marker, name] : mesh.names.markers) digest.add(std::int64_t{marker}), digest.add(name);
    for (const auto& [region, name] : mesh.names.regions) digest.add(region), digest.add(name);
    digest.add(made.old_points);
    digest.add(made.old_triangles);
    for (const std::int64_t count : {made.margin, made.beyond}) digest.add(count);
    digest.add(made.margin_width);
  }

  std::uint64_t seed_;
  std::mt19937_64 random_;
};

constexpr std::array<std::uint64_t, 30> kRecordedOutlines{
    0x638955e57cfd128e, 0xde49aee74464ec51, 0x8f075aff1fdd9b0c, 0x3f28af1d9981f7ad, 0x149c9b322afe78b3,
    0x551b6b386241502c, 0x360c0c227a10ff15, 0x82a568d3c48b9745, 0xa47fc3ad3131f125, 0x53975eddcbbfb60d,
    0x48a1914f23a852fc, 0xdb1ffa3bacbf87dd, 0x8ba1d6ceeaee4221, 0xefdcfe79a8ed0734, 0xebfbce9914082901,
    0xc3834f1997a5601a, 0x1231ea8fcc8daa4f, 0x46e8923e95c8878c, 0xa3d34e1d30521e6f, 0x6435d70955805868,
    0x6ca11cbbcb40143c, 0x8019d609b8dbcbb7, 0xd1946f0435f2d0fb, 0xff444e57b253d5ff, 0xa94245ad638a48d3,
    0x5bb3c0bad16cf8fe, 0x9911c42464bccc23, 0x87b0bf9139aac7f1, 0x447d932a95299d51, 0x41ee2fa8611202e4};

}  // namespace

TEST_CASE("new domains make of meshes what was recorded") {
  constexpr std::uint64_t kEach = 10;  // cases of one number
  std::size_t errors = 0;
  check_recorded(kRecordedOutlines, [&](std::uint64_t seed) {
    ValueDigest digest;
    for (std::uint64_t i = 0; i < kEach; ++i) {
      const std::string result = OutlineCase(kEach * seed + i).result();
      errors += result.find(' ') == std::string::npos ? 0 : 1;
      digest.add(result);
    }
    return digest.value();
  });
  CHECK(errors > 10);
  CHECK(errors < 150);
}
