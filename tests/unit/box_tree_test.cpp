#include "geometry/box_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace driftmesh;

namespace {

/// Boxes with corners at multiples of 1/64, so that queries meet their borders and distances tie.
std::vector<Box> random_boxes(std::mt19937_64& random, int count) {
  std::uniform_int_distribution<int> place(0, 64), extent(0, 6);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    box.low = {place(random) / 64.0, place(random) / 64.0};
    box.high = {box.low.x + extent(random) / 64.0, box.low.y + extent(random) / 64.0};
  }
  return boxes;
}

std::vector<std::int32_t> containing_one_by_one(const std::vector<Box>& boxes, const Point& p) {
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].low.x <= p.x && p.x <= boxes[i].high.x && boxes[i].low.y <= p.y && p.y <= boxes[i].high.y)
      found.push_back(static_cast<std::int32_t>(i));
  return found;
}

}  // namespace

TEST_CASE("a box tree finds the boxes that contain a point and the nearest one") {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> place(-10, 80);
  for (const int count : {1, 2, 7, 8, 9, 64, 65, 1000}) {
    const std::vector<Box> boxes = random_boxes(random, count);
    const BoxTree tree(boxes);
    for (int i = 0; i < 300; ++i) {
      const Point p{place(random) / 64.0, place(random) / 64.0};
      std::vector<std::int32_t> found;
      tree.visit_containing(p, [&](std::int32_t item) { found.push_back(item); });
      std::sort(found.begin(), found.end());
      CHECK(found == containing_one_by_one(boxes, p));

      const auto distance = [&](std::int32_t item) { return boxes[item].squared_distance(p); };
      std::int32_t nearest = 0;
      for (std::int32_t k = 1; k < count; ++k)
        if (distance(k) < distance(nearest)) nearest = k;
      CHECK(tree.nearest(p, distance) == nearest);
    }
  }
}

TEST_CASE("a box tree finds all pairs of boxes that overlap, each once") {
  std::mt19937_64 random(5);
  for (const int count : {1, 2, 8, 9, 65, 1000}) {
    CAPTURE(count);
    const std::vector<Box> boxes = random_boxes(random, count);
    std::vector<std::pair<std::int32_t, std::int32_t>> found, expected;
    BoxTree(boxes).visit_overlapping([&](std::int32_t i, std::int32_t j) { found.emplace_back(i, j); });
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t j = i + 1; j < count; ++j)
        if (boxes[static_cast<std::size_t>(i)].overlaps(boxes[static_cast<std::size_t>(j)]))
          expected.emplace_back(i, j);
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
  }
}

TEST_CASE("a distant outlier does not slow the search") {
  std::mt19937_64 random(4);
  std::vector<Box> boxes = random_boxes(random, 20000);
  boxes.push_back(Box::around({1e30, 1e30}, {1e30, 1e30}));
  const BoxTree tree(boxes);
  const Box place = Box::around({0.5, 0.5}, {0.51, 0.51});
  std::size_t found = 0, looked_at = 0;
  tree.search(
      [&](const Box& box) {
        ++looked_at;
        return box.overlaps(place);
      },
      [&](std::int32_t) { ++found; });
  CHECK(found == std::count_if(boxes.begin(), boxes.end(), [&](const Box& box) { return box.overlaps(place); }));
  CHECK(found > 0);
  CHECK(looked_at < 2000);
}

TEST_CASE("an empty tree has no answer") {
  const BoxTree tree(std::vector<Box>{});
  tree.visit_containing({0, 0}, [](std::int32_t) { FAIL("there is no box"); });
  CHECK(tree.nearest({0, 0}, [](std::int32_t) { return 0.0; }) == -1);
}

TEST_CASE("the distance to a box") {
  Box box;
  box.extend(Point{0, 0});
  box.extend(Point{4, 2});
  CHECK(box.squared_distance({1, 1}) == 0);
  CHECK(box.squared_distance({7, 6}) == 25);
  CHECK(box.squared_distance({-3, 1}) == 9);
  CHECK(box.center() == Point{2, 1});
}
