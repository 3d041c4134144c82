#include "adapt/slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftmesh::adapt {
namespace {

constexpr double kTrianglesPerSquare = 4;

float rounded_up(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

Box box_of(const Triangulation& mesh, TriangleId t) {
  Box box;
  for (int i = 0; i < 3; ++i) box.extend(mesh.corner(t, i));
  return box;
}

}  // namespace

Slopes::Slopes(const Triangulation& mesh, const IdVector<TriangleId, double>& slope) {
  Box all;
  for (const VertexId v : ids_of(mesh.points))
    if (mesh.origin[v] != kDeleted) all.extend(mesh.points[v]);
  low_ = all.low;
  const double x = all.high.x - all.low.x, y = all.high.y - all.low.y;
  const double squares = std::max(1.0, static_cast<double>(mesh.live_triangles()) / kTrianglesPerSquare);
  // Not more than that many of them in the one direction, however narrow the box.
  width_ = std::max(std::sqrt(x * y / squares), std::max(x, y) / squares);
  columns_ = static_cast<std::size_t>(x / width_) + 1;
  rows_ = static_cast<std::size_t>(y / width_) + 1;
  at_.assign(columns_ * rows_, -1);
  for (const TriangleId t : ids_of(mesh.triangles)) {
    if (!mesh.triangles[t].alive()) continue;
    most_ = std::max(most_, slope[t]);
    const float most = rounded_up(slope[t]);
    const Squares in = squares_of(box_of(mesh, t));
    for (std::size_t row = in.bottom; row <= in.top; ++row)
      for (std::size_t k = in.left; k <= in.right; ++k)
        at_[row * columns_ + k] = std::max(at_[row * columns_ + k], most);
  }
}

Slopes::Squares Slopes::squares_of(const Box& box) const {
  const auto place = [&](double from, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(from / width_, 0.0, static_cast<double>(count - 1)));
  };
  return {place(box.low.x - low_.x, columns_), place(box.high.x - low_.x, columns_), place(box.low.y - low_.y, rows_),
          place(box.high.y - low_.y, rows_)};
}

double Slopes::most_in(const Box& box) const {
  constexpr std::size_t kFew = 36;
  const Squares in = squares_of(box);
  if (in.count() > kFew) return most_;
  float most = 0;
  for (std::size_t row = in.bottom; row <= in.top; ++row)
    for (std::size_t k = in.left; k <= in.right; ++k) {
      const float at = at_[row * columns_ + k];
      if (at < 0) return most_;
      most = std::max(most, at);
    }
  return std::min(static_cast<double>(most), most_);
}

}  // namespace driftmesh::adapt
