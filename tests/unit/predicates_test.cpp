#include "geometry/predicates.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

using namespace driftmesh;

TEST_CASE("orient2d tells left, right and straight") {
  CHECK(orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
  CHECK(orient2d({0, 0}, {0, 1}, {1, 0}) == -1);
  CHECK(orient2d({0, 0}, {1, 1}, {-3, -3}) == 0);
  CHECK(orient2d({5, 5}, {5, 5}, {1, 2}) == 0);
}

TEST_CASE("incircle tells inside, outside and on the circle") {
  CHECK(incircle({1, 0}, {0, 1}, {-1, 0}, {0, 0}) > 0);
  CHECK(incircle({1, 0}, {0, 1}, {-1, 0}, {0, -2}) < 0);
  CHECK(incircle({1, 0}, {0, 1}, {-1, 0}, {0, -1}) == 0);
  CHECK(incircle({0, 1}, {1, 0}, {-1, 0}, {0, 0}) < 0);  // clockwise: the sign is reversed
}

TEST_CASE("one ulp off a line is detected") {
  const double x = 1.0 / 3, up = std::nextafter(x, 1), down = std::nextafter(x, 0);
  CHECK(orient2d({0, 0}, {1, 1}, {x, x}) == 0);
  CHECK(orient2d({0, 0}, {1, 1}, {x, up}) > 0);
  CHECK(orient2d({0, 0}, {1, 1}, {x, down}) < 0);
  // Far beyond the end of a short segment, where plain doubles fail.
  const Point far_up{1e9 * x, std::nextafter(1e9 * x, 1e10)};
  CHECK(orient2d({0, 0}, {1e-9, 1e-9}, far_up) > 0);
}

TEST_CASE("one ulp off a circle is detected") {
  // The circle of diameter (0, 0) (8, 0): its points of integer coordinates, moved by an ulp.
  const Point a{0, 0}, b{8, 0}, c{4, 4};
  CHECK(incircle(a, b, c, {4, -4}) == 0);
  CHECK(incircle(a, b, c, {4, std::nextafter(-4, 0)}) > 0);
  CHECK(incircle(a, b, c, {4, std::nextafter(-4, -5)}) < 0);
  CHECK(incircle(a, b, c, {4, 4}) == 0);
}

TEST_CASE("both paths behind the filter are exact") {
  // Differences of these coordinates are exact ...
  CHECK(incircle_exact({0, 0}, {8, 0}, {4, 4}, {4, std::nextafter(-4, 0)}) > 0);
  CHECK(orient2d_exact({12, 12}, {24, 24}, {std::nextafter(18, 20), 18}) < 0);
  // ... and of these they are not.
  CHECK(incircle_exact({1, 0}, {0, 1}, {-1, 0}, {1e-20, -1}) < 0);
  CHECK(incircle_exact({1, 0}, {0, 1}, {-1, 0}, {1e-20, std::nextafter(-1, 0)}) > 0);
  CHECK(orient2d_exact({1e-20, 0}, {1, 1}, {2, 2}) < 0);
  CHECK(orient2d_exact({0, 1e-20}, {1, 1}, {2, 2}) > 0);
}

TEST_CASE("the coordinate range") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double inside : {0.0, -0.0, 1.0, -77.5, kMaxCoordinate, -kMaxCoordinate, 0x1p-120, 3 * kInputGrid})
    CHECK((in_coordinate_range(inside) && in_input_range(inside)));
  for (const double computed : {std::nextafter(0x1p-120, 0), 1.1 * kSmallestCoordinate, 5 * kCoordinateGrid})
    CHECK((in_coordinate_range(computed) && !in_input_range(computed)));
  for (const double outside : {std::nan(""), infinity, -infinity, 1e300, 1e-300, std::nextafter(kMaxCoordinate, 1e300),
                               1.5 * kCoordinateGrid, std::nextafter(kSmallestCoordinate, 0)})
    CHECK_FALSE((in_coordinate_range(outside) || in_input_range(outside)));
  CHECK(rounded_to(1e-300, kInputGrid) == 0);
  CHECK(rounded_to(-2.6 * kInputGrid, kInputGrid) == -3 * kInputGrid);
  CHECK(rounded_to(0.1, kInputGrid) == 0.1);
}
