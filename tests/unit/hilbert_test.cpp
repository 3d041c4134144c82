#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "geometry/hilbert_sort.hpp"

using namespace driftmesh;

namespace {

struct Cell {
  int x = -1;
  int y = -1;
};

/// The cells of a 2^k x 2^k grid in the order of the upper bits of their index.
std::vector<Cell> cells_along_curve(int k) {
  std::vector<Cell> cells(std::size_t{1} << (2 * k));
  for (int x = 0; x < 1 << k; ++x)
    for (int y = 0; y < 1 << k; ++y) {
      const auto index = hilbert_index(std::uint32_t(x) << (32 - k), std::uint32_t(y) << (32 - k));
      cells[index >> (64 - 2 * k)] = {x, y};
    }
  return cells;
}

}  // namespace

TEST_CASE("the Hilbert curve visits every cell once and moves to a neighbor each time") {
  for (int k = 1; k <= 8; ++k) {
    const std::vector<Cell> cells = cells_along_curve(k);
    CHECK(cells.front().x == 0);
    CHECK(cells.front().y == 0);
    int steps_to_neighbor = 0;
    for (std::size_t i = 1; i < cells.size(); ++i)
      steps_to_neighbor +=
          std::abs(cells[i].x - cells[i - 1].x) + std::abs(cells[i].y - cells[i - 1].y) == 1 && cells[i].x >= 0;
    CHECK(steps_to_neighbor == static_cast<int>(cells.size()) - 1);
  }
}

TEST_CASE("the finest cells of a square are distinct, and neighbors on the curve are neighbors in the plane") {
  // Across the middle of the whole grid, where all 32 levels of the curve take part.
  std::vector<std::uint64_t> indices;
  for (std::uint32_t x = 0x7ffffff8; x < 0x80000008; ++x)
    for (std::uint32_t y = 0x7ffffff8; y < 0x80000008; ++y) indices.push_back(hilbert_index(x, y));
  std::sort(indices.begin(), indices.end());
  CHECK(std::adjacent_find(indices.begin(), indices.end()) == indices.end());
  // The 16 x 16 block is four aligned 8 x 8 blocks: each is one run of 64 indices.
  int jumps = 0;
  for (std::size_t i = 1; i < indices.size(); ++i) jumps += indices[i] != indices[i - 1] + 1;
  CHECK(jumps <= 3);
}

TEST_CASE("points of a box are mapped to the curve, those outside to its edge") {
  const HilbertOrder order({-2, 10}, {6, 12});
  CHECK(order.index({-2, 10}) == 0);
  CHECK(order.index({-2, 10}) == order.index({-3, -1e70}));
  CHECK(order.index({6, 10}) == ~std::uint64_t{0});
  CHECK(order.index({6, 10}) == order.index({1e70, 9}));
  CHECK(order.index({5.9999, 10.0001}) != order.index({6, 10}));
}

TEST_CASE("a box may have no width or height") {
  const HilbertOrder point({3, 3}, {3, 3}), line({0, 3}, {10, 3});
  CHECK(point.index({3, 3}) == 0);
  CHECK(line.index({4, 3}) != line.index({7, 3}));
}

TEST_CASE("many things are sorted as a few are, wherever on the curve they lie") {
  std::mt19937_64 random(51);
  for (const int narrowed : {0, 8, 40, 60}) {  // bits in which no two positions differ
    AlongCurve<int> places;
    for (int i = 0; i < 50'000; ++i) places.emplace_back(~std::uint64_t{0} - (random() >> narrowed), i % 777);
    AlongCurve<int> sorted = places;
    std::sort(sorted.begin(), sorted.end());
    sort_along_curve(places);
    CHECK(places == sorted);
  }
}
