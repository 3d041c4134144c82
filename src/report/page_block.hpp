#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// Appends bytes, compressed, as an element of the page that has these attributes.
void add_block(std::string& to, const std::string& attributes, const void* bytes, std::size_t count);
template <class Value>
void add_array(std::string& to, const std::string& attributes, const std::vector<Value>& array) {
  add_block(to, attributes, array.data(), array.size() * sizeof(Value));
}

/// The corners of the least box around points, of which there is at least one.
struct Corners {
  Point low, high;
};
[[nodiscard]] Corners corners_of(const std::vector<Point>& points);
[[nodiscard]] Point middle_of(const Corners& corners);

/// x and y of each, seen from the middle: a float has seven digits.
[[nodiscard]] std::vector<float> near_the_middle(const std::vector<Point>& points, const Point& middle);

}  // namespace driftmesh
