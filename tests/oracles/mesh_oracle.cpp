#include "oracles/mesh_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracles/exact.hpp"
#include "oracles/words.hpp"

namespace driftmesh::oracles {
namespace {

std::vector<ExactPoint> exact_points(const std::vector<Point>& points) {
  return {points.begin(), points.end()};
}

using Corners = std::array<ExactPoint, 3>;

/// The multiple of `way` at which the ray from `eye` enters the triangle; negative if it passes by.
Rational entry(const Corners& t, const ExactPoint& eye, const ExactPoint& way) {
  Rational first = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational hit = ray_hit(eye, way, t[k], t[(k + 1) % 3]);
    if (hit > 0 && (first < 0 || hit < first)) first = hit;
  }
  return first;
}

/// Whether any inner point of the triangle can be seen from `eye`, which is none of its corners and not inside it. What
/// blocks the view changes only at directions toward a vertex; between two of them, one ray represents all.
class View {
 public:
  View(const std::vector<ExactPoint>& points, const std::vector<Mesh::Edge>& walls) : points_(points), walls_(walls) {}

  [[nodiscard]] bool open(const ExactPoint& eye, const Corners& t) const {
    std::vector<ExactPoint> ways;
    ExactPoint right = t[0] - eye, left = right;
    for (const ExactPoint& corner : t) {
      const ExactPoint way = corner - eye;
      if (cross(right, way) < 0) right = way;
      if (cross(left, way) > 0) left = way;
    }
    for (const ExactPoint& p : points_) {
      const ExactPoint way = p - eye;
      if (cross(right, way) >= 0 && cross(way, left) >= 0 && (dot(right, way) > 0 || dot(left, way) > 0))
        ways.push_back(way);
    }
    std::sort(ways.begin(), ways.end(), [](const ExactPoint& a, const ExactPoint& b) { return cross(a, b) > 0; });
    for (std::size_t i = 0; i + 1 < ways.size(); ++i)
      if (cross(ways[i], ways[i + 1]) > 0 && open_along(eye, ways[i] + ways[i + 1], t)) return true;
    return false;
  }

 private:
  [[nodiscard]] bool open_along(const ExactPoint& eye, const ExactPoint& way, const Corners& t) const {
    const Rational reach = entry(t, eye, way);
    if (reach < 0) return false;
    return std::none_of(walls_.begin(), walls_.end(), [&](const Mesh::Edge& wall) {
      const Rational hit = ray_hit(eye, way, points_[wall.a], points_[wall.b]);
      return hit > 0 && hit <= reach;
    });
  }

  const std::vector<ExactPoint>& points_;
  const std::vector<Mesh::Edge>& walls_;
};

Corners corners_of(const std::vector<ExactPoint>& points, const std::array<std::int32_t, 3>& triangle) {
  return {points[triangle[0]], points[triangle[1]], points[triangle[2]]};
}

bool holds(const Corners& t, const ExactPoint& p) {
  return side(t[0], t[1], p) >= 0 && side(t[1], t[2], p) >= 0 && side(t[2], t[0], p) >= 0;
}

struct Piece {
  double from, to;
  std::int32_t first, last;
};

/// The part of the segment a b that the edge covers, if both of its ends are within the tolerance of it.
bool covers_part(const Mesh& mesh, const Mesh::Edge& edge, const Point& a, const Point& b, double tolerance,
                 Piece& piece) {
  const ExactPoint from(a), way = ExactPoint(b) - from;
  const Rational length2 = dot(way, way);
  const auto place = [&](std::int32_t v, double& along) {
    const ExactPoint off = ExactPoint(mesh.points[v]) - from;
    const Rational across = cross(way, off), t = dot(way, off) / length2;
    along = static_cast<double>(t);
    const Rational limit = Rational(tolerance) * Rational(tolerance) * length2;
    const double slack = tolerance / std::sqrt(static_cast<double>(length2));
    return across * across <= limit && along >= -slack && along <= 1 + slack;
  };
  piece.first = edge.a;
  piece.last = edge.b;
  if (!place(edge.a, piece.from) || !place(edge.b, piece.to)) return false;
  if (piece.from > piece.to) {
    std::swap(piece.from, piece.to);
    std::swap(piece.first, piece.last);
  }
  return true;
}

}  // namespace

std::vector<std::string> check_constrained_delaunay(const Mesh& mesh) {
  std::vector<std::string> wrong;
  const std::vector<ExactPoint> points = exact_points(mesh.points);
  const View view(points, mesh.edges);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners corners = corners_of(points, mesh.triangles[t]);
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (in_circle(corners[0], corners[1], corners[2], points[v]) <= 0) continue;
      if (holds(corners, points[v])) {
        wrong.push_back(words("point ", v, " lies in triangle ", t));
        continue;
      }
      if (view.open(points[v], corners))
        wrong.push_back(words("point ", v, " is in the circumcircle of triangle ", t, " and sees it"));
    }
  }
  return wrong;
}

std::vector<Mesh::Edge> find_boundary(const Mesh& mesh) {
  std::vector<Mesh::Edge> boundary;
  for (const auto& edge : mesh.edges) {
    int left = 0, right = 0;
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = t[k], b = t[(k + 1) % 3];
        left += a == edge.a && b == edge.b;
        right += a == edge.b && b == edge.a;
      }
    if (left == 1 && right == 0) boundary.push_back(edge);
    if (left == 0 && right == 1) boundary.push_back({edge.b, edge.a, edge.marker});
  }
  return boundary;
}

std::vector<std::string> check_area(const Mesh& mesh, const std::vector<Mesh::Edge>& boundary) {
  std::vector<std::string> wrong;
  const std::vector<ExactPoint> points = exact_points(mesh.points);
  Rational sum = 0, enclosed = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners_of(points, mesh.triangles[t]);
    const Rational twice = cross(c[1] - c[0], c[2] - c[0]);
    if (twice <= 0) wrong.push_back(words("triangle ", t, " has area ", static_cast<double>(twice) / 2));
    sum += twice;
  }
  for (const auto& edge : boundary) enclosed += cross(points[edge.a], points[edge.b]);
  if (sum != enclosed)
    wrong.push_back(words("the triangles sum to ", static_cast<double>(sum) / 2, ", the boundary encloses ",
                          static_cast<double>(enclosed) / 2));
  return wrong;
}

std::vector<std::string> check_coverage(const Mesh& mesh, const Pslg& input, double tolerance,
                                        const std::vector<bool>& outside) {
  std::vector<std::string> wrong;
  std::vector<int> uses(mesh.edges.size(), 0);
  for (std::size_t s = 0; s < input.segments.size(); ++s) {
    const Point &a = input.points[input.segments[s].a], &b = input.points[input.segments[s].b];
    std::vector<Piece> pieces;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      Piece piece{};
      if (!covers_part(mesh, mesh.edges[e], a, b, tolerance, piece)) continue;
      ++uses[e];
      pieces.push_back(piece);
      if (mesh.edges[e].marker != input.segments[s].marker)
        wrong.push_back(words("subsegment ", e, " has a different marker than segment ", s));
    }
    std::sort(pieces.begin(), pieces.end(), [](const Piece& p, const Piece& q) { return p.from < q.from; });
    if (outside[s] && !pieces.empty()) wrong.push_back(words("segment ", s, " is outside and has subsegments"));
    if (outside[s]) continue;
    const bool whole =
        !pieces.empty() && mesh.points[pieces.front().first] == a && mesh.points[pieces.back().last] == b;
    if (!whole) wrong.push_back(words("segment ", s, " is not covered from end to end"));
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
      if (pieces[i].last != pieces[i + 1].first)
        wrong.push_back(words("segment ", s, " has a gap or an overlap at ", pieces[i].to));
  }
  for (std::size_t e = 0; e < uses.size(); ++e)
    if (uses[e] != 1) wrong.push_back(words("subsegment ", e, " lies on ", uses[e], " input segments"));
  return wrong;
}

int count_covering(const Mesh& mesh, const Point& p) {
  const ExactPoint at(p);
  int count = 0;
  for (const auto& t : mesh.triangles) {
    const ExactPoint a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
    const int least = std::min({side(a, b, at), side(b, c, at), side(c, a, at)});
    if (least == 0) return -1;
    count += least > 0;
  }
  return count;
}

bool inside_by_parity(const Pslg& input, const std::vector<std::size_t>& boundary_segments, const Point& p) {
  const ExactPoint at(p);
  bool inside = false;
  for (const std::size_t s : boundary_segments) {
    const ExactPoint a(input.points[input.segments[s].a]), b(input.points[input.segments[s].b]);
    if ((a.y > at.y) == (b.y > at.y)) continue;
    const ExactPoint &low = a.y < b.y ? a : b, &high = a.y < b.y ? b : a;
    if (side(low, high, at) > 0) inside = !inside;
  }
  return inside;
}

}  // namespace driftmesh::oracles
