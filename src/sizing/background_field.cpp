#include "sizing/background_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/triangle_geometry.hpp"

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

/// For rounding.
constexpr double kBelow = 1 - 1e-9;

double least_of(const std::vector<double>& lengths) {
  return *std::min_element(lengths.begin(), lengths.end());
}

/// How far along pq, 0 to 1, it crosses ab; less than 0 if it does not.
double crossing(const Point& p, const Point& q, const Point& a, const Point& b) {
  const double at_p = rounded_cross(a, b, p), at_q = rounded_cross(a, b, q);
  if ((at_p > 0) == (at_q > 0)) return -1;
  if ((rounded_cross(p, q, a) > 0) == (rounded_cross(p, q, b) > 0)) return -1;
  return at_p / (at_p - at_q);
}

double longest_edge(const CornerPoints& t) {
  return std::sqrt(
      std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])}));
}

/// Whether all of t is to the right of one of s's edges, or no farther to the left of it than `margin`.
bool separate(const CornerPoints& s, const CornerPoints& t, double margin) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &a = s[i], &b = s[(i + 1) % 3];
    const double most = margin * std::sqrt(squared_distance(a, b));
    if (std::all_of(t.begin(), t.end(), [&](const Point& p) { return rounded_cross(a, b, p) <= most; })) return true;
  }
  return false;
}

/// Whether they share more than a boundary.
bool overlap(const CornerPoints& s, const CornerPoints& t) {
  const double margin = 1e-9 * std::min(longest_edge(s), longest_edge(t));
  return !separate(s, t, margin) && !separate(t, s, margin);
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
  least_ = least_of(lengths_);
  edges_ = mesh_.edges();
  std::vector<Box> boxes;
  std::vector<double> shorter;
  for (const auto& [a, b] : edges_) {
    boxes.push_back(Box::around(mesh_.points()[a], mesh_.points()[b]));
    shorter.push_back(std::min(lengths_[a], lengths_[b]));
  }
  edge_tree_ = BoxTree(boxes);
  shorter_ends_ = edge_tree_.least(shorter);
}

/// A function that is linear on the triangles of a mesh has its least value in a triangle at a corner of the triangle,
/// at a point of the mesh, or where edges cross.
bool VertexSizeField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  const double limit = length * kBelow;
  bool found = false;
  edge_tree_.search_below(shorter_ends_, limit, Box::of(triangle), [&](std::int32_t e) {
    const auto [a, b] = edges_[e];
    const Point &p = mesh_.points()[a], &q = mesh_.points()[b];
    found = found || (lengths_[a] < limit && contains(triangle, p)) || (lengths_[b] < limit && contains(triangle, q));
    for (std::size_t i = 0; i < 3 && !found; ++i) {
      const double t = crossing(p, q, triangle[i], triangle[(i + 1) % 3]);
      found = t >= 0 && (1 - t) * lengths_[a] + t * lengths_[b] < limit;
    }
  });
  return found;
}

void VertexSizeField::visit_marks(const std::function<void(const Point&)>& visit) const {
  for (const Point& p : mesh_.points()) visit(p);
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
  for (std::size_t t = 0; t < lengths_.size(); ++t)
    if (!mesh_.has_area(static_cast<std::int32_t>(t))) lengths_[t] = std::numeric_limits<double>::infinity();
  least_ = least_of(lengths_);
  shortest_ = mesh_.triangle_tree().least(lengths_);
}

bool TriangleAreaField::falls_below(const std::array<Point, 3>& triangle, double length) const {
  bool found = false;
  mesh_.triangle_tree().search_below(shortest_, length * kBelow, Box::of(triangle),
                                     [&](std::int32_t t) { found = found || overlap(triangle, mesh_.corners(t)); });
  return found;
}

void TriangleAreaField::visit_marks(const std::function<void(const Point&)>& visit) const {
  for (std::int32_t t = 0; to_index(t) < mesh_.triangles().size(); ++t) visit(centroid(mesh_.corners(t)));
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
