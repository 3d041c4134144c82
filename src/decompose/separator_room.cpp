#include "decompose/separator_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftmesh {
namespace {

/// The height of the room, relative to the length of the separator.
constexpr double kLeastHeight = 0.01;
/// The tangent of the angle at which ends see the border of the room; its squared sine is 0.12.
const double kSlope = std::sqrt(0.12 / 0.88);

}  // namespace

SeparatorRoom::SeparatorRoom(const Point& a, const Point& b, double wanted)
    : a_(a),
      d_{b.x - a.x, b.y - a.y},
      squared_length_(d_.x * d_.x + d_.y * d_.y),
      height_(kLeastHeight * squared_length_),
      height_for_corners_(std::max(height_, wanted * std::sqrt(squared_length_))) {}

double SeparatorRoom::height() const {
  return height_for_corners_ / std::sqrt(squared_length_);
}

SeparatorRoom::Place SeparatorRoom::place_of(const Point& p) const {
  const double x = p.x - a_.x, y = p.y - a_.y;
  return {x * d_.x + y * d_.y, d_.x * y - d_.y * x};
}

bool SeparatorRoom::contains(const Point& corner) const {
  const Place at = place_of(corner);
  const double across = std::fabs(at.across);
  return across < height_for_corners_ && across < kSlope * std::min(at.along, squared_length_ - at.along);
}

/// The part of the wall inside each of the six sides of the room, from `begin` to `end` as fractions of the wall.
bool SeparatorRoom::is_entered_by(const Point& u, const Point& w) const {
  const auto depths = [this](const Place& at) {
    const double from_a = kSlope * at.along, from_b = kSlope * (squared_length_ - at.along);
    return std::array{height_ - at.across, height_ + at.across, from_a - at.across,
                      from_a + at.across,  from_b - at.across,  from_b + at.across};
  };
  const auto at_u = depths(place_of(u)), at_w = depths(place_of(w));
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < at_u.size(); ++i) {
    if (at_u[i] <= 0 && at_w[i] <= 0) return false;
    if (at_u[i] <= 0) begin = std::max(begin, at_u[i] / (at_u[i] - at_w[i]));
    if (at_w[i] <= 0) end = std::min(end, at_u[i] / (at_u[i] - at_w[i]));
  }
  return begin < end;
}

}  // namespace driftmesh
