#include "decompose/check_decomposition.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "decompose/decompose.hpp"
#include "support/id_literals.hpp"
#include "support/prepared_mesh.hpp"
#include "support/varied_domain.hpp"

// What is wrong with a decomposition that was damaged, one thing at a time.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

Decomposition cut_in_seven() {
  DecomposeOptions options;
  options.subdomains = 7;
  return decompose(prepared(varied_domain()), options);
}

bool is_said(const Decomposition& d, const std::string& words) {
  return std::ranges::any_of(check_decomposition(d).problems,
                             [&](const std::string& problem) { return problem.find(words) != std::string::npos; });
}

/// Whether a root from a to b and one from c to d are said to cross.
bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  Decomposition crossed;
  crossed.subdomains.resize(1);
  const auto number_of = [&](const Point& p) {
    const auto known = std::ranges::find(crossed.points, p);
    if (known == crossed.points.end()) crossed.points.push_back(p);
    return GlobalPointId{static_cast<std::int32_t>(std::ranges::find(crossed.points, p) - crossed.points.begin())};
  };
  for (const auto& [from, to] : {std::pair(a, b), std::pair(c, d)}) {
    Decomposition::Root root;
    root.a = number_of(from);
    root.b = number_of(to);
    root.left = 0_sub;
    crossed.roots.push_back(root);
  }
  crossed.origin.resize(crossed.points.size());
  return is_said(crossed, "roots 0 and 1 cross");
}

/// The first root of which that holds.
template <class Holds>
Decomposition::Root& root_of(Decomposition& d, const Holds& holds) {
  const auto found = std::ranges::find_if(d.roots, holds);
  REQUIRE(found != d.roots.end());
  return *found;
}

bool is_straight_interface(const Decomposition::Root& root) {
  return root.is_interface() && root.shell == kNone;
}

}  // namespace

TEST_CASE("each wrong root is named") {
  REQUIRE(check_decomposition(cut_in_seven()).valid());
  const auto said_of = [](const auto& holds, const auto& damage, const char* words) {
    Decomposition d = cut_in_seven();
    damage(root_of(d, holds));
    return is_said(d, words);
  };
  using Root = Decomposition::Root;
  CHECK(said_of(
      is_straight_interface, [](Root& root) { root.b = root.a; }, "joins points"));
  CHECK(said_of(
      is_straight_interface,
      [](Root& root) {
        std::swap(root.a, root.b);
        std::swap(root.left, root.right);
        std::swap(root.left_region, root.right_region);
      },
      "joins points"));
  CHECK(said_of(
      is_straight_interface, [](Root& root) { root.left = root.right = kNoSubdomain; }, "lies between subdomains"));
  CHECK(said_of([](const Root& root) { return !root.is_interface(); }, [](Root& root) { root.separator = true; },
                "is a separator without two subdomains"));
}

TEST_CASE("roots that share more than their ends cross") {
  CHECK(cross({0, 0}, {4, 4}, {0, 4}, {4, 0}));
  CHECK_FALSE(cross({0, 0}, {4, 4}, {3, 4}, {1, 3}));
  CHECK(cross({0, 0}, {4, 4}, {2, 2}, {4, 0}));  // ends in its middle
  CHECK(cross({0, 0}, {4, 4}, {0, 4}, {2, 2}));
  CHECK(cross({2, 2}, {4, 0}, {0, 0}, {4, 4}));
  CHECK_FALSE(cross({0, 0}, {4, 4}, {2.5, 2}, {4, 0}));
  CHECK(cross({0, 0}, {4, 4}, {2, 2}, {6, 6}));  // on one line
  CHECK_FALSE(cross({0, 0}, {4, 4}, {5, 5}, {6, 6}));
  CHECK(cross({0, 0}, {4, 4}, {0, 0}, {2, 2}));  // begin in one direction
  CHECK_FALSE(cross({0, 0}, {4, 4}, {0, 0}, {-2, -2}));
  CHECK_FALSE(cross({0, 0}, {4, 4}, {0, 0}, {2, 3}));
}

TEST_CASE("subdomains that are not what they claim are named") {
  const auto said_of = [](const auto& damage, const char* words) {
    Decomposition d = cut_in_seven();
    REQUIRE(!d.point_list.empty());
    damage(d);
    return is_said(d, words);
  };
  CHECK(said_of([](Decomposition& d) { root_of(d, is_straight_interface).left = kNoSubdomain; },
                "disagree on the subdomain between them"));
  CHECK(said_of([](Decomposition& d) { ++root_of(d, is_straight_interface).left_region; },
                "disagree on the subdomain between them"));
  CHECK(said_of([](Decomposition& d) { d.subdomains[2_sub].area *= 1.001; }, "subdomain 2 claims area"));
  CHECK(said_of([](Decomposition& d) { std::swap(d.root_list.front(), d.root_list.back()); },
                "the lists of roots do not agree"));
  CHECK(said_of([](Decomposition& d) { ++d.root_begin[1]; }, "the lists of roots do not agree"));
  CHECK(said_of(
      [](Decomposition& d) {  // what is in one subdomain seems to be in the one before or after
        std::size_t i = 0;
        while (d.point_begin[i + 1] == d.point_begin[i]) ++i;
        if (i > 0)
          d.point_begin[i] = d.point_begin[i + 1];
        else
          d.point_begin[1] = 0;
      },
      "in which it does not lie"));
  CHECK(said_of(
      [](Decomposition& d) {  // two that do not touch become one
        for (const SubdomainId s : ids_of(d.subdomains)) {
          const bool touches = std::ranges::any_of(d.roots, [&](const Decomposition::Root& root) {
            return root.is_interface() && (root.left == s || root.right == s) && root.across_from(s) == 0_sub;
          });
          if (touches || s == 0_sub) continue;
          for (Decomposition::Root& root : d.roots) {
            if (root.left == s) root.left = 0_sub;
            if (root.right == s) root.right = 0_sub;
          }
          return;
        }
        FAIL("all touch the first");
      },
      "has 2 outer borders: it is not connected"));
}

TEST_CASE("the smallest angle is in the first part of the histogram that has any") {
  const DecompositionReport report = check_decomposition(cut_in_seven());
  const auto first = std::ranges::find_if(report.angle_histogram, [](auto count) { return count > 0; });
  REQUIRE(first != report.angle_histogram.end());
  CHECK(static_cast<int>(report.smallest_angle / 10) == first - report.angle_histogram.begin());
}

TEST_CASE("angles of the input do not count, and loads are relative to the mean") {
  Pslg wedge;
  wedge.points = {{0, 0}, {10, 0}, {10, 1}};
  wedge.segments = {{0, 1, 1}, {1, 2, 1}, {2, 0, 1}};
  DecomposeOptions options;
  options.subdomains = 2;
  Decomposition d = decompose(prepared(wedge), options);
  CHECK(check_decomposition(d).smallest_angle > 30);
  d.subdomains[0_sub].predicted = 300;
  d.subdomains[1_sub].predicted = 100;
  CHECK(check_decomposition(d).largest_load == 1.5);
  CHECK(check_decomposition(d).smallest_load == 0.5);
}
