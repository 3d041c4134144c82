#include "mesh/cavity.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

// Static bounds from Shewchuk's stage A (1997, sections 4.2 and 4.5), with the permanents replaced by upper bounds
// that the loop has at hand. Let a, b, c be the distances of three vertices from the point.
//   orientation: |ax by| + |ay bx| <= |a||b| <= (a^2 + b^2)/2, times (3 + 16 eps) eps = 3.3306690738754716e-16;
//   in-circle:   the sum of a^2 (|bx cy| + |by cx|) <= abc(a + b + c) <= (a^2 + b^2 + c^2)^2 / 3 (equality for equal
//                distances), times (10 + 96 eps) eps = 1.1102230246251577e-15.
// Both are rounded up to cover the rounding of the bound itself. The added constant covers products that underflow.
constexpr double kOrientationBound = 1.67e-16;
constexpr double kInCircleBound = 3.71e-16;
constexpr double kUnderflow = 1e-290;

}  // namespace

Cavity::Cavity(Triangulation& mesh) : mesh_(mesh) {
  reserve(64);
}

void Cavity::reserve(std::size_t more) {
  const std::size_t size = std::max<std::size_t>(corners_.size() * 2, more);
  corners_.resize(size);
  stack_.resize(size);
  border_.resize(size);
  slots_.resize(size);
}

inline void Cavity::start(const Point& p) {
  p_ = p;
  corner_count_ = stack_count_ = border_count_ = killed_count_ = 0;
  doubtful_ = false;
}

inline Cavity::Corner Cavity::relative(VertexId v) const {
  const Point& q = mesh_.points[Triangulation::id(v)];
  const double dx = q.x - p_.x;
  const double dy = q.y - p_.y;
  return {dx, dy, dx * dx + dy * dy, v};
}

inline void Cavity::push(HalfEdge outer, int a, int b, double cross_ab) {
  if (outer >= 0) __builtin_prefetch(&mesh_.triangles[Triangulation::id(triangle_of(outer))]);
  stack_[at(stack_count_++)] = {cross_ab, outer, a, b};
}

inline void Cavity::emit(const Edge& e) {
  doubtful_ |= e.cross <= kOrientationBound * (corners_[at(e.a)].lift + corners_[at(e.b)].lift) + kUnderflow;
  border_[at(border_count_++)] = e;
}

double Cavity::exact_orientation(const Corner& a, const Corner& b) const {
  return orient2d(p_, mesh_.points[Triangulation::id(a.vertex)], mesh_.points[Triangulation::id(b.vertex)]);
}

inline bool Cavity::in_circle(const Edge& e, const Corner& c, double ac, double cb) const {
  const Corner& a = corners_[at(e.a)];
  const Corner& b = corners_[at(e.b)];
  const double determinant = b.lift * ac + a.lift * cb - c.lift * e.cross;
  const double sum = a.lift + b.lift + c.lift;
  const double bound = kInCircleBound * (sum * sum) + kUnderflow;
  if (determinant > bound) return true;
  if (determinant < -bound) return false;
  const auto point = [this](const Corner& k) -> const Point& { return mesh_.points[Triangulation::id(k.vertex)]; };
  return incircle(point(b), point(a), point(c), p_) > 0;
}

inline void Cavity::load(TriangleId t) {
  const Triangle& triangle = mesh_.triangles[Triangulation::id(t)];
  for (int i = 0; i < 3; ++i) corners_[at(i)] = relative(triangle.vertex[at(i)]);
}

/// One step of the walk from triangle t, which does not obviously hold the point: either across an edge that the point
/// lies beyond (then next_ is set), or the answer.
Cavity::Found Cavity::leave(TriangleId t, const double (&sides)[3]) {
  const Triangle& triangle = mesh_.triangles[Triangulation::id(t)];
  encroached_ = kNone;
  next_ = kNone;
  for (int i = 0; i < 3; ++i) {
    const Corner& a = corners_[at(next(i))];
    const Corner& b = corners_[at(previous(i))];
    if (a.lift == 0 || b.lift == 0) return Found::kOccupied;
    const double bound = kOrientationBound * (a.lift + b.lift) + kUnderflow;
    const bool beyond = sides[i] < -bound || (sides[i] <= bound && exact_orientation(a, b) < 0);
    if (!beyond) continue;
    const HalfEdge outer = triangle.neighbor[at(i)];
    if (is_constrained(outer)) {
      encroached_ = subsegment_of(outer);
    } else {
      next_ = triangle_of(outer);
      return Found::kClear;
    }
  }
  return encroached_ == kNone ? Found::kClear : Found::kEncroached;
}

/// Visibility walk to the triangle that holds the point. In a Delaunay triangulation each step lowers the power of the
/// point with respect to the circumcircle, so it ends; and from a triangle whose circumdisk holds the point, every
/// triangle on the way is in the cavity. Leaves that triangle's edges on the stack.
template <bool kMindConstraints>
Cavity::Found Cavity::walk(TriangleId t) {
  for (;;) {
    load(t);
    const double sides[3] = {cross(corners_[1], corners_[2]), cross(corners_[2], corners_[0]),
                             cross(corners_[0], corners_[1])};
    const double sum = corners_[0].lift + corners_[1].lift + corners_[2].lift;
    if (std::min({sides[0], sides[1], sides[2]}) <= kOrientationBound * sum + kUnderflow) {
      const Found found = leave(t, sides);
      if (found != Found::kClear) return found;
      if (next_ != kNone) {
        t = next_;
        continue;
      }
    }
    const Triangle& triangle = mesh_.triangles[Triangulation::id(t)];
    corner_count_ = 3;
    slots_[at(killed_count_++)] = t;
    push(triangle.neighbor[1], 2, 0, sides[1]);
    push(triangle.neighbor[0], 1, 2, sides[0]);
    push(triangle.neighbor[2], 0, 1, sides[2]);
    return Found::kClear;
  }
}

/// Grows the cavity across the edges on the stack, depth first and counterclockwise, so that the border comes out in
/// order around the point and the new triangles link up without a search. Started from the triangle that holds the
/// point, every edge reached is seen from the point in full (the wedge of an edge is divided at each new corner), so no
/// triangle is met twice.
template <bool kMindLens>
Cavity::Found Cavity::expand(double cos_squared) {
  while (stack_count_ != 0) {
    const Edge e = stack_[at(--stack_count_)];
    const Corner& a = corners_[at(e.a)];
    const Corner& b = corners_[at(e.b)];
    if (is_constrained(e.outer)) {
      if constexpr (kMindLens) {
        const double dot = a.dx * b.dx + a.dy * b.dy;
        if (dot < 0 && dot * dot > cos_squared * (a.lift * b.lift)) {
          encroached_ = subsegment_of(e.outer);
          return Found::kEncroached;
        }
      }
      emit(e);
      continue;
    }
    const Triangle& triangle = mesh_.triangles[Triangulation::id(triangle_of(e.outer))];
    const int i = index_of(e.outer);
    const Corner c = relative(triangle.vertex[at(i)]);
    const double ac = cross(a, c);
    const double cb = cross(c, b);
    if (!in_circle(e, c, ac, cb)) {
      emit(e);
      continue;
    }
    if (at(corner_count_) + 4 >= corners_.size()) reserve(0);
    const int k = corner_count_++;
    corners_[at(k)] = c;
    slots_[at(killed_count_++)] = triangle_of(e.outer);
    push(triangle.neighbor[at(previous(i))], k, e.b, cb);
    push(triangle.neighbor[at(next(i))], e.a, k, ac);
  }
  return Found::kClear;
}

Cavity::Found Cavity::check_star() const {
  for (int i = 0; i < border_count_; ++i) {
    const Edge& e = border_[at(i)];
    if (!(exact_orientation(corners_[at(e.a)], corners_[at(e.b)]) > 0)) return Found::kDegenerate;
  }
  return Found::kClear;
}

Cavity::Found Cavity::gather(const Point& p, TriangleId t, const Lens& lens) {
  start(p);
  if (const Found found = walk<true>(t); found != Found::kClear) return found;
  if (const Found found = expand<true>(lens.cos_squared); found != Found::kClear) return found;
  return doubtful_ ? check_star() : Found::kClear;
}

Cavity::Found Cavity::gather_from_afar(const Point& p, TriangleId t) {
  start(p);
  if (const Found found = walk<false>(t); found != Found::kClear) return found;
  expand<false>(0);
  return doubtful_ ? check_star() : Found::kClear;
}

Cavity::Found Cavity::gather_on(SubsegmentId s, const Point& m) {
  start(m);
  const Subsegment& segment = mesh_.subsegments[Triangulation::id(s)];
  corners_[0] = relative(segment.vertex[0]);
  corners_[1] = relative(segment.vertex[1]);
  corner_count_ = 2;
  if (corners_[0].lift == 0 || corners_[1].lift == 0) return Found::kDegenerate;
  // Right side first: its border runs from the segment's start to its end, that of the left side back to the start.
  for (const int side : {1, 0}) {
    if (side == 0) first_left_ = border_count_;
    const HalfEdge h = segment.half[at(side)];
    if (h == kNone) continue;
    const int from = side == 1 ? 0 : 1;  // corner where this side's border begins
    const int to = 1 - from;
    const int apex = corner_count_++;
    corners_[at(apex)] = relative(mesh_.apex(h));
    slots_[at(killed_count_++)] = triangle_of(h);
    const Triangle& triangle = mesh_.triangles[Triangulation::id(triangle_of(h))];
    const int i = index_of(h);
    push(triangle.neighbor[at(previous(i))], apex, to, cross(corners_[at(apex)], corners_[at(to)]));
    push(triangle.neighbor[at(next(i))], from, apex, cross(corners_[at(from)], corners_[at(apex)]));
    expand<false>(0);
  }
  return doubtful_ ? check_star() : Found::kClear;
}

/// Gives every border edge a slot for its triangle: those of the cavity's triangles, then added ones.
inline void Cavity::take_slots() {
  if (!mesh_.region.empty()) {
    // A cavity never crosses a constrained segment, so each side keeps its region.
    const std::uint16_t left = mesh_.region[Triangulation::id(slots_[at(killed_count_ - 1)])];
    const std::uint16_t right = mesh_.region[Triangulation::id(slots_[0])];
    for (int i = killed_count_; i < border_count_; ++i) slots_[at(i)] = mesh_.add_triangle();
    for (int i = 0; i < border_count_; ++i)
      mesh_.region[Triangulation::id(slots_[at(i)])] = i < first_left_ ? right : left;
    return;
  }
  for (int i = killed_count_; i < border_count_; ++i) slots_[at(i)] = mesh_.add_triangle();
}

void Cavity::fill(VertexId v) {
  first_left_ = 0;
  take_slots();
  const int n = border_count_;
  Triangle* const triangles = mesh_.triangles.data();
  TriangleId before = slots_[at(n - 1)];
  TriangleId here = slots_[0];
  for (int i = 0; i < n; ++i) {
    const Edge& e = border_[at(i)];
    const TriangleId after = slots_[at(i + 1 == n ? 0 : i + 1)];
    triangles[here] = {{v, corners_[at(e.a)].vertex, corners_[at(e.b)].vertex},
                       {e.outer, half_edge(after, 2), half_edge(before, 1)}};
    if (is_constrained(e.outer)) [[unlikely]]
      mesh_.link(half_edge(here, 0), e.outer);
    else
      triangles[triangle_of(e.outer)].neighbor[at(index_of(e.outer))] = half_edge(here, 0);
    before = here;
    here = after;
  }
}

void Cavity::fill_on(VertexId v, SubsegmentId at_start, SubsegmentId at_end) {
  const int right = first_left_;
  take_slots();
  const int n = border_count_;
  for (int i = 0; i < n; ++i) {
    const Edge& e = border_[at(i)];
    const TriangleId here = slots_[at(i)];
    const bool opens = i == 0 || i == right;
    const bool closes = i == n - 1 || i == right - 1;
    Triangle& triangle = mesh_.triangles[Triangulation::id(here)];
    triangle.vertex = {v, corners_[at(e.a)].vertex, corners_[at(e.b)].vertex};
    mesh_.link(half_edge(here, 0), e.outer);
    if (!opens) mesh_.link(half_edge(here, 2), half_edge(slots_[at(i - 1)], 1));
    // The right border runs from the segment's start to its end, the left one back.
    const bool on_right = i < right;
    if (opens) mesh_.link(half_edge(here, 2), constrained(on_right ? at_start : at_end));
    if (closes) mesh_.link(half_edge(here, 1), constrained(on_right ? at_end : at_start));
  }
}

Cavity::Fresh Cavity::fresh(int i) const {
  const Edge& e = border_[at(i)];
  const Corner& a = corners_[at(e.a)];
  const Corner& b = corners_[at(e.b)];
  const double dx = b.dx - a.dx;
  const double dy = b.dy - a.dy;
  return {slots_[at(i)], e.cross, a.lift, dx * dx + dy * dy, b.lift};
}

}  // namespace driftmesh
