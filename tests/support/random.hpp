#pragma once

#include <cstdint>
#include <random>

#include "geometry/box.hpp"

namespace driftmesh::testing {

using Random = std::mt19937_64;

[[nodiscard]] inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

[[nodiscard]] inline std::int32_t integer(Random& random, std::int32_t low, std::int32_t high) {
  return std::uniform_int_distribution<std::int32_t>(low, high)(random);
}

[[nodiscard]] inline Point somewhere_in(Random& random, const Box& box) {
  const double x = uniform(random, box.low.x, box.high.x);
  return {x, uniform(random, box.low.y, box.high.y)};
}

}  // namespace driftmesh::testing
