#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "adapt/agree.hpp"
#include "adapt/demand.hpp"
#include "adapt/granularity.hpp"
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
