#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "adapt/agree.hpp"
#include "adapt/demand.hpp"
#include "adapt/fit_lengths.hpp"
#include "adapt/granularity.hpp"
#include "adapt/linear_lengths.hpp"
#include "adapt/regenerate.hpp"
#include "decompose/presplit.hpp"
#include "mesh/cdt.hpp"

// What adaptive meshes decide from numbers alone: points on interfaces, what lengths ask for, which subdomains are
// divided and joined.

using namespace driftmesh;
using namespace driftmesh::adapt;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A segment of length 1 that is cut into eight pieces, and the lengths asked for at its points, from end to end.
struct Cut8 {
  Triangulation mesh;
  Lengths lengths;

  explicit Cut8(const std::array<double, 9>& asked) {
    for (int i = 0; i < 9; ++i) {
      mesh.points.push_back({i / 8.0, 0});
      lengths.push_back(asked[static_cast<std::size_t>(i)]);
    }
    mesh.roots.push_back({.vertex = {VertexId{0}, VertexId{8}}, .tree = SubsegmentId{0}});
    mesh.subsegments.push_back({{VertexId{0}, VertexId{8}}, {kNone, kNone}, dyadic::kWhole, RootId{0}, kNone});
    for (std::size_t i = 0; i < 7; ++i) {  // breadth first
      const auto s = static_cast<SubsegmentId>(i);
      const Subsegment whole = mesh.subsegments[s];
      const auto middle = static_cast<VertexId>((to_int(whole.vertex[0]) + to_int(whole.vertex[1])) / 2);
      mesh.subsegments[s].child = mesh.subsegments.next_id();
      mesh.subsegments.push_back(
          {{whole.vertex[0], middle}, {kNone, kNone}, dyadic::first_half(whole.path), RootId{0}, kNone});
      mesh.subsegments.push_back(
          {{middle, whole.vertex[1]}, {kNone, kNone}, dyadic::second_half(whole.path), RootId{0}, kNone});
    }
  }

  [[nodiscard]] std::vector<dyadic::Path> wanted(double twice_area = kInfinity) const {
    return points_wanted(mesh, RootId{0}, lengths, twice_area);
  }
};

/// The length for which pieces of this length suffice, up to rounding.
double length_for(double piece) {
  const double unit = kPresplitSpacing * std::sqrt(twice_area_of_edge(1) / 2);
  return 1.0001 * piece / unit;
}

using Paths = std::vector<dyadic::Path>;

/// Half of a square of side 1, with lengths at its corners.
struct HalfSquare {
  HalfSquare(double at_origin, double at_right, double at_top) {
    Pslg pslg;
    pslg.points = {{0, 0}, {1, 0}, {0, 1}};
    pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
    mesh = triangulate(pslg);
    for (const Point& p : mesh.points)
      lengths.push_back(p == Point{1, 0} ? at_right : p == Point{0, 1} ? at_top : at_origin);
  }

  Triangulation mesh;
  Lengths lengths;
};

/// Asks for a length everywhere, and for as much less between corners of a triangle.
class Dented final : public SizeField {
 public:
  Dented(double length, double dent) : length_(length), dent_(dent) {}
  [[nodiscard]] double edge_length(const Point&) const override { return length_; }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>&, double length) const override {
    return length_ - dent_ < length;
  }
  [[nodiscard]] double least_between(const std::array<Point, 3>&, double at_corners) const override {
    return at_corners - dent_;
  }

 private:
  double length_, dent_;
};

/// Subdomains side by side, each with a border of length 1 to the next.
Decomposition row_of(std::size_t count) {
  Decomposition d;
  d.subdomains.resize(count);
  for (std::size_t i = 0; i <= count; ++i) {
    d.points.push_back({static_cast<double>(i), 0});
    d.points.push_back({static_cast<double>(i), 1});
    if (i == 0 || i == count) continue;
    Decomposition::Root root;
    root.a = static_cast<GlobalPointId>(2 * i);
    root.b = static_cast<GlobalPointId>(2 * i + 1);
    root.left = static_cast<SubdomainId>(i - 1);
    root.right = static_cast<SubdomainId>(i);
    root.separator = true;
    d.roots.push_back(root);
  }
  return d;
}

constexpr std::array<Point, 3> kSmallTriangle{{{0.2, 0.2}, {0.3, 0.2}, {0.2, 0.3}}};

}  // namespace

TEST_CASE("an interface is cut until its pieces suit the lengths along it") {
  const double whole = length_for(1), half = length_for(0.5), eighth = length_for(0.125);
  CHECK(points_on(Cut8({}).mesh, RootId{0}) == Paths{1, 2, 3, 4, 5, 6, 7});
  CHECK(Cut8({whole, whole, whole, whole, whole, whole, whole, whole, whole}).wanted().empty());
  CHECK(Cut8({half, whole, whole, whole, whole, whole, whole, whole, whole}).wanted() == Paths{1});
  CHECK(Cut8({whole, whole, whole, whole, half, whole, whole, whole, whole}).wanted() == Paths{1});
  CHECK(Cut8({whole, whole, whole, whole, whole, whole, whole, whole, eighth}).wanted() == Paths{1, 3, 7});
  CHECK(Cut8({eighth, whole, whole, whole, whole, whole, whole, whole, whole}).wanted() == Paths{1, 2, 4});
  // none at the ends and the middle: 1.11 times the length counts between
  CHECK(Cut8({whole, whole, half, whole, whole, whole, whole, whole, whole}).wanted() == Paths{1});
  const double more = whole / kBetween;
  CHECK(Cut8({whole, whole, 1.01 * more, whole, whole, whole, whole, whole, whole}).wanted().empty());
  CHECK(Cut8({whole, whole, 0.99 * more, whole, whole, whole, whole, whole, whole}).wanted() == Paths{1});
  CHECK(Cut8({whole, whole, whole, whole, whole, whole, whole, 0.99 * more, whole}).wanted() == Paths{1});
}

TEST_CASE("lengths along an interface are linear between its points") {
  const double unit = length_for(1.0 / 32), least = unit / 1.7, large = length_for(1);
  const Cut8 cut({least, 3 * least, large, large, large, large, large, large, large});
  // at 1/32 it is 1.5 times the least, so that the piece from there to 1/16 is cut; at 1/16 twice, which suffices on
  CHECK(cut.wanted() == Paths{1, 2, 4, 8, 9, 16, 17, 18, 32, 33});
}

TEST_CASE("bounds on areas count on interfaces, too") {
  const double whole = length_for(1);
  const Cut8 cut({whole, whole, whole, whole, whole, whole, whole, whole, whole});
  CHECK(cut.wanted(twice_area_of_edge(whole)).empty());
  CHECK(cut.wanted(twice_area_of_edge(length_for(0.5))) == Paths{1});
  CHECK(cut.wanted(twice_area_of_edge(length_for(0.25))) == Paths{1, 2, 3});
}

TEST_CASE("points of both, and those of one alone") {
  CHECK(united({1, 3, 6}, {1, 2}) == Paths{1, 2, 3, 6});
  CHECK(without({1, 3, 6}, {1, 2}) == Paths{3, 6});
}

TEST_CASE("lengths between corners are bounded by how steep they are, in whatever direction") {
  const double longest = 0.1 * std::sqrt(2.0), farthest = longest / std::sqrt(3.0);  // from the nearest corner
  for (const auto& [right, top] : {std::pair{2.0, 1.0}, {1.0, 2.0}}) {
    const HalfSquare half(1, right, top);
    const LinearLengths field(half.mesh, half.lengths);
    CHECK(field.least_between(kSmallTriangle, 1.2) == doctest::Approx(1.2 - farthest).epsilon(1e-3));
  }
}

TEST_CASE("a corner without a bound does not count at the others, nor on the edge between them") {
  const HalfSquare half(1, 3, kInfinity);
  const LinearLengths field(half.mesh, half.lengths);
  CHECK(field.edge_length({0, 0}) == 1);
  CHECK(field.edge_length({1, 0}) == 3);
  CHECK(field.edge_length({0.5, 0}) == 2);
}

TEST_CASE("a field that is scaled to fit is so between points, and has its shortest length there") {
  const Dented field(1, 0.8);
  AdaptiveOptions options;
  FittedField fitted(field, options);
  fitted.scale(2);
  CHECK(fitted.edge_length({0, 0}) == 2);
  CHECK(fitted.least_between(kSmallTriangle, 2) == doctest::Approx(0.4));
  options.shortest = 0.5;
  CHECK(fitted.least_between(kSmallTriangle, 2) == doctest::Approx(1));
}

TEST_CASE("a triangle that suits the lengths at its corners may be too large for those between") {
  const HalfSquare half(2, 2, 2);
  CHECK_FALSE(demand_of(half.mesh, {}, half.lengths).too_large);
  const Dented flat(2, 0), dented(2, 1.9);
  CHECK_FALSE(demand_of(half.mesh, {}, half.lengths, &flat).too_large);
  CHECK(demand_of(half.mesh, {}, half.lengths, &dented).too_large);
}

TEST_CASE("light subdomains are joined with neighbors if enough of them go") {
  using Asked = std::vector<std::pair<std::int32_t, double>>;
  const auto groups = [](std::size_t count, const Asked& other) {
    IdVector<SubdomainId, double> asked(count, 1000.0);
    for (const auto& [s, triangles] : other) asked[SubdomainId{s}] = triangles;
    return light_groups(row_of(count), asked, static_cast<std::int32_t>(count));
  };
  CHECK(groups(16, {}).empty());
  CHECK(groups(16, {{3, 10}, {4, 500}}).empty());  // one of 16 is not worth it, though it has where to go
  const auto pair = groups(16, {{3, 10}, {4, 10}});
  REQUIRE(pair.size() == 16);
  for (const SubdomainId s : ids_of(pair)) CHECK(pair[s] == (to_int(s) == 4 ? SubdomainId{3} : s));
  CHECK(groups(48, {{3, 10}, {4, 10}, {20, 10}, {30, 10}}).empty());  // of four light ones, one would go
}

TEST_CASE("a part is kept, mended or made anew by what changes, and by how worn its memory is") {
  const HalfSquare half(1, 1, 1);
  const auto fate = [&](const Demand& demand, double density, std::size_t free_triangles) {
    auto mesh = std::make_shared<SubdomainMesh>();
    mesh->mesh = half.mesh;
    for (std::size_t i = 0; i < free_triangles; ++i) {
      mesh->mesh.free_triangles.push_back(mesh->mesh.triangles.next_id());
      mesh->mesh.triangles.push_back({.vertex = {kNone, kNone, kNone}, .neighbor = {kNone, kNone, kNone}});
    }
    const Part part{mesh, 1, density, std::make_shared<const Lengths>(half.lengths)};
    return fate_of(part, demand, 0.25);
  };
  CHECK(fate({.triangles = 1}, 1, 0) == Fate::kKeep);
  CHECK(fate({.triangles = 0.8}, 1, 0) == Fate::kKeep);
  CHECK(fate({.triangles = 0.7, .changes = 0.3}, 1, 0) == Fate::kMend);
  CHECK(fate({.triangles = 1.2, .too_large = true, .changes = 0.4}, 1, 0) == Fate::kMend);
  CHECK(fate({.triangles = 1.2, .too_large = true, .changes = 0.4}, 1, 1) == Fate::kMend);
  CHECK(fate({.triangles = 1.2, .too_large = true, .changes = 0.4}, 1, 2) == Fate::kRemake);
  CHECK(fate({.triangles = 1.2, .too_large = true, .changes = 0.7}, 1, 0) == Fate::kRemake);
  CHECK(fate({.triangles = 1}, 0.9, 0) == Fate::kRemake);  // has more than a tenth too many
}
