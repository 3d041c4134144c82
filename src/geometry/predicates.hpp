#pragma once

#include <cfloat>
#include <cmath>
#include <limits>

#include "driftmesh/point.hpp"

#ifdef __FAST_MATH__
#error "exact predicates need IEEE arithmetic: do not compile with -ffast-math"
#endif
#if FLT_EVAL_METHOD != 0
#error "exact predicates need doubles rounded after every operation: compile for SSE2 or better, not for x87"
#endif

// Exact predicates after J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", Discrete & Computational Geometry 18 (1997): his first filter, then, where it cannot
// decide, the exact value as an expansion. They also rely on -ffp-contract=off (cmake/DriftmeshTarget.cmake;
// tests prove it).

namespace driftmesh {

// The range. Expansions are exact as long as nothing overflows and no rounding error is lost to underflow.
//
// Overflow: with |x|, |y| <= M, differences are <= 2M, the lifted term of incircle <= 8 M^2, a 2x2 minor <= 8
// M^2, and the sum of three products <= 192 M^4; splitting a factor for an exact product multiplies it by
// 2^27 + 1, but only factors of degree 3, <= 2^5 M^3. M = 2^240 keeps everything below 2^968.
//
// Underflow: let every coordinate be a multiple of U. Sums, differences and their rounding errors are
// multiples of U, and so the terms of a product of four factors, errors included, are multiples of U^4. They
// are exact doubles if U^4 >= 2^-1074, and the filters' bounds (about 2^-50 of a sum of such products) are
// normal numbers if also 2^-50 U^4 >= 2^-1022. U = 2^-242 gives both: 2^-968 and 2^-1018.
//
// A double of magnitude >= 2^e is a multiple of 2^(e - 52), so from 2^-190 on the predicates take any. Input is
// held to multiples of 2^-172: a bisection of depth 62 between such points only makes multiples of 2^(-172 - 62) =
// 2^-234. Other computed points (circumcenters) are brought into range by snap_to_zero.
inline constexpr double kMaxCoordinate = 0x1p240;        ///< largest magnitude of an input coordinate, 1.8e72
inline constexpr double kInputGrid = 0x1p-172;           ///< input coordinates are multiples of this, 1.7e-52
inline constexpr double kCoordinateGrid = 0x1p-242;      ///< all coordinates are multiples of this, 1.4e-73
inline constexpr double kSmallestCoordinate = 0x1p-190;  ///< all larger doubles are such multiples

/// The nearest multiple of a power of two.
[[nodiscard]] inline double rounded_to(double x, double grid) {
  return std::fabs(x) >= grid * 0x1p53 ? x : std::nearbyint(x / grid) * grid;
}

/// Whether the predicates take a coordinate, of the input or computed. False for NaN and infinities.
[[nodiscard]] inline bool in_coordinate_range(double x) {
  return std::fabs(x) <= kMaxCoordinate && rounded_to(x, kCoordinateGrid) == x;
}
/// Whether an input coordinate may enter the mesher.
[[nodiscard]] inline bool in_input_range(double x) {
  return std::fabs(x) <= kMaxCoordinate && rounded_to(x, kInputGrid) == x;
}

/// A computed coordinate, or 0 where it is too small for exact predicates. A few cycles, no branch.
[[nodiscard]] inline double snap_to_zero(double x) {
  return std::fabs(x) < kSmallestCoordinate ? 0.0 : x;
}

/// The sign of the answer is exact: evaluated with expansions, no filter. Out of line, cold: 20 to 50 ns and 60 to 180
/// ns where the differences of the coordinates are exact, as for points close to each other; up to 1.5 us otherwise.
/// Magnitudes are those of the determinant, up to a relative error of 2^-52.
[[nodiscard, gnu::cold, gnu::noinline]] double orient2d_exact(const Point& a, const Point& b, const Point& c);
[[nodiscard, gnu::cold, gnu::noinline]] double incircle_exact(const Point& a, const Point& b, const Point& c,
                                                              const Point& d);

/// Half an ulp of 1: the largest relative error of one rounding.
inline constexpr double kRoundoff = 0x1p-53;
/// Bounds on the rounding error of orient2d relative to |l| + |r|, and of incircle relative to its permanent:
/// the first-stage bounds of Shewchuk 1997. Evaluation in the order that the functions below use.
inline constexpr double kOrient2dBound = (3 + 16 * kRoundoff) * kRoundoff;
inline constexpr double kIncircleBound = (10 + 96 * kRoundoff) * kRoundoff;

/// > 0 if a, b, c make a left turn, < 0 for a right turn, 0 exactly when they are collinear. Twice the signed
/// area of the triangle up to rounding. Coordinates in range.
[[nodiscard]] inline double orient2d(const Point& a, const Point& b, const Point& c) {
  const double l = (a.x - c.x) * (b.y - c.y);
  const double r = (a.y - c.y) * (b.x - c.x);
  const double det = l - r;
  if (std::fabs(det) >= kOrient2dBound * (std::fabs(l) + std::fabs(r))) [[likely]]
    return det;
  return orient2d_exact(a, b, c);
}

/// > 0 if d lies strictly inside the circle through a, b, c (counterclockwise), < 0 outside, 0 exactly when
/// cocircular. The sign is the opposite if a, b, c are clockwise. Coordinates in range.
[[nodiscard]] inline double incircle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double adx = a.x - d.x, ady = a.y - d.y;
  const double bdx = b.x - d.x, bdy = b.y - d.y;
  const double cdx = c.x - d.x, cdy = c.y - d.y;
  const double bc = bdx * cdy, cb = cdx * bdy, a_lift = adx * adx + ady * ady;
  const double ca = cdx * ady, ac = adx * cdy, b_lift = bdx * bdx + bdy * bdy;
  const double ab = adx * bdy, ba = bdx * ady, c_lift = cdx * cdx + cdy * cdy;
  const double det = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
  const double permanent = (std::fabs(bc) + std::fabs(cb)) * a_lift + (std::fabs(ca) + std::fabs(ac)) * b_lift +
                           (std::fabs(ab) + std::fabs(ba)) * c_lift;
  if (std::fabs(det) >= kIncircleBound * permanent) [[likely]]
    return det;
  return incircle_exact(a, b, c, d);
}

}  // namespace driftmesh
