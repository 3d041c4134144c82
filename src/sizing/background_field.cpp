#include "sizing/background_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

void require_count(std::size_t values, const char* of_what, std::size_t expected) {
  if (values != expected)
    throw Error("background mesh: " + std::to_string(values) + " values for " + std::to_string(expected) + " " +
                of_what);
}

std::vector<double> lengths_of_areas(const std::vector<double>& area_bounds) {
  std::vector<double> lengths(area_bounds.size());
  std::transform(area_bounds.begin(), area_bounds.end(), lengths.begin(), edge_length_of_area);
  return lengths;
}

}  // namespace

double edge_length_of_area(double area) {
  if (area <= 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(area * (4 / std::sqrt(3.0)));
}

VertexSizeField::VertexSizeField(BackgroundMesh mesh, std::vector<double> lengths)
    : mesh_(std::move(mesh)), lengths_(std::move(lengths)) {
  require_count(lengths_.size(), "points", mesh_.points().size());
  for (std::size_t i = 0; i < lengths_.size(); ++i)
    if (!(lengths_[i] > 0))
      throw Error("background mesh: the edge length at point " + std::to_string(i) + " (counted from 0) is " +
                  std::to_string(lengths_[i]) + ", not positive");
}

double VertexSizeField::edge_length(const Point& p) const {
  const BackgroundMesh::Place place = mesh_.locate(p);
  const auto& corners = mesh_.triangles()[place.triangle];
  double length = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (place.weight[i] == 0) continue;  // not 0 * infinity
    const double at_corner = lengths_[corners[i]];
    length += place.weight[i] * at_corner;
    shortest = std::min(shortest, at_corner);
    longest = std::max(longest, at_corner);
  }
  return std::clamp(length, shortest, longest);
}

TriangleAreaField::TriangleAreaField(BackgroundMesh mesh, const std::vector<double>& area_bounds)
    : mesh_(std::move(mesh)), lengths_(lengths_of_areas(area_bounds)) {
  require_count(area_bounds.size(), "triangles", mesh_.triangles().size());
  for (std::size_t t = 0; t < lengths_.size(); ++t)
    if (std::isnan(lengths_[t]))
      throw Error("background mesh: the area bound of triangle " + std::to_string(t) +
                  " (counted from 0) is not a number");
}

double TriangleAreaField::edge_length(const Point& p) const {
  double longest = 0;
  for (const std::int32_t triangle : mesh_.triangles_at(p)) longest = std::max(longest, lengths_[triangle]);
  return longest;
}

std::vector<double> shortest_at_points(const BackgroundMesh& mesh, const std::vector<double>& lengths_of_triangles) {
  std::vector<double> shortest(mesh.points().size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < lengths_of_triangles.size(); ++t)
    for (const std::int32_t corner : mesh.triangles()[t]) {
      double& at_corner = shortest[corner];
      at_corner = std::min(at_corner, lengths_of_triangles[t]);
    }
  return shortest;
}

}  // namespace driftmesh
