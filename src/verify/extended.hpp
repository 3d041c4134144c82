#pragma once

#include <cmath>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A compensated sum (Neumaier 1974) in extended precision.
class CompensatedSum {
 public:
  void add(long double term) {
    const long double sum = sum_ + term;
    lost_ += std::fabs(sum_) >= std::fabs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  void add(const CompensatedSum& other) {
    add(other.sum_);
    lost_ += other.lost_;
  }
  [[nodiscard]] double value() const { return static_cast<double>(sum_ + lost_); }

 private:
  long double sum_ = 0;
  long double lost_ = 0;
};

/// Twice the signed area of the triangle o, a, b in extended precision.
[[nodiscard]] inline long double cross_extended(const Point& o, const Point& a, const Point& b) {
  const long double ax = static_cast<long double>(a.x) - o.x, ay = static_cast<long double>(a.y) - o.y;
  const long double bx = static_cast<long double>(b.x) - o.x, by = static_cast<long double>(b.y) - o.y;
  return ax * by - ay * bx;
}

/// The dot product of a - o and b - o in extended precision.
[[nodiscard]] inline long double dot_extended(const Point& o, const Point& a, const Point& b) {
  const long double ax = static_cast<long double>(a.x) - o.x, ay = static_cast<long double>(a.y) - o.y;
  const long double bx = static_cast<long double>(b.x) - o.x, by = static_cast<long double>(b.y) - o.y;
  return ax * bx + ay * by;
}

}  // namespace driftmesh
