#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include "driftmesh/point.hpp"

// Plane geometry in exact rationals, slow and simple: the reference for tests.

namespace driftmesh::oracles {

using Rational = boost::multiprecision::cpp_rational;

struct ExactPoint {
  Rational x, y;
  ExactPoint() = default;
  ExactPoint(Rational px, Rational py) : x(std::move(px)), y(std::move(py)) {}
  explicit ExactPoint(const Point& p) : x(p.x), y(p.y) {}
  friend bool operator==(const ExactPoint&, const ExactPoint&) = default;
};

inline ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) {
  return {a.x - b.x, a.y - b.y};
}
inline ExactPoint operator+(const ExactPoint& a, const ExactPoint& b) {
  return {a.x + b.x, a.y + b.y};
}
inline Rational cross(const ExactPoint& a, const ExactPoint& b) {
  return a.x * b.y - a.y * b.x;
}
inline Rational dot(const ExactPoint& a, const ExactPoint& b) {
  return a.x * b.x + a.y * b.y;
}

inline int sign(const Rational& r) {
  return r.sign();
}

/// 1: c lies left of the line from a to b, -1: right, 0: on it.
inline int side(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  return sign(cross(b - a, c - a));
}

/// 1: d lies inside the circle through a, b, c (counterclockwise), -1: outside, 0: on it.
inline int in_circle(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  const ExactPoint u = a - d, v = b - d, w = c - d;
  return sign(Rational(dot(u, u) * cross(v, w) + dot(v, v) * cross(w, u) + dot(w, w) * cross(u, v)));
}

/// Where the ray from `from` along `way` meets the segment a b, as a multiple of `way`; negative if it does not, or if
/// the two are parallel.
inline Rational ray_hit(const ExactPoint& from, const ExactPoint& way, const ExactPoint& a, const ExactPoint& b) {
  const Rational across = cross(way, b - a);
  if (across.is_zero()) return -1;
  const Rational along_segment = cross(a - from, way) / across;  // 0 at a, 1 at b
  if (along_segment < 0 || along_segment > 1) return -1;
  return cross(a - from, b - a) / across;
}

}  // namespace driftmesh::oracles
