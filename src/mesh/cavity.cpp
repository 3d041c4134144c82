#include "mesh/cavity.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "geometry/predicates.hpp"

namespace driftmesh {
namespace {

// Static bounds from Shewchuk's stage A (1997, sections 4.2 and 4.5), with the permanents replaced by upper bounds that
// are available in the loop. Let a, b, c be the distances of three vertices from the point.
//   orientation: |ax by| + |ay bx| <= |a||b| <= (a^2 + b^2)/2, times (3 + 16 eps) eps = 3.3306690738754716e-16;
//   in-circle:   the sum of a^2 (|bx cy| + |by cx|) <= abc(a + b + c) <= (a^2 + b^2 + c^2)^2 / 3 (equality for equal
//                distances), times (10 + 96 eps) eps = 1.1102230246251577e-15.
// Both are rounded up to cover the rounding of the bound itself. The added constant covers products that underflow.
constexpr double kOrientationBound = 1.67e-16;
constexpr double kInCircleBound = 3.71e-16;
constexpr double kUnderflow = 1e-290;

/// Turns a triangle so that it begins with its least corner, by x and then y.
void begin_at_least_corner(Triangle& triangle, const GrowingArray<Point, VertexId>& points) {
  const auto before = [&](VertexId a, VertexId b) {
    const Point &p = points[a], &q = points[b];
    return p.x != q.x ? p.x < q.x : p.y < q.y;
  };
  const auto turn = std::ranges::min_element(triangle.vertex, before) - triangle.vertex.begin();
  std::rotate(triangle.vertex.begin(), triangle.vertex.begin() + turn, triangle.vertex.end());
  std::rotate(triangle.neighbor.begin(), triangle.neighbor.begin() + turn, triangle.neighbor.end());
}

}  // namespace

Cavity::Cavity(Triangulation& mesh) : mesh_(mesh) {
  wake();
}

void Cavity::reserve(std::size_t corners) {
  const auto set_size = [corners](auto& array) {
    array.resize(corners);
    array.shrink_to_fit();
  };
  set_size(corners_);
  set_size(stack_);
  set_size(border_);
  set_size(slots_);
}

/// Doubles the capacity. This moves the corners, and all pointers to them are adjusted; returns `e` adjusted.
Cavity::Edge Cavity::with_more_room(const Edge& e) {
  std::vector<Corner> old = corners_;
  old.swap(corners_);  // `old` is what the edges point into
  reserve(2 * old.size());
  const auto moved = [&](const Edge& edge) {
    return Edge{edge.cross, corners_.data() + (edge.a - old.data()), corners_.data() + (edge.b - old.data()),
                edge.outer};
  };
  for (int i = 0; i < stack_count_; ++i) stack_[i] = moved(stack_[i]);
  for (int i = 0; i < border_count_; ++i) border_[i] = moved(border_[i]);
  return moved(e);
}

inline Cavity::Ends Cavity::ends() {
  return {corners_.data() + corner_count_, stack_.data() + stack_count_, border_.data() + border_count_,
          slots_.data() + killed_count_};
}

inline void Cavity::keep(const Ends& ends) {
  corner_count_ = static_cast<int>(ends.corner - corners_.data());
  stack_count_ = static_cast<int>(ends.stack - stack_.data());
  border_count_ = static_cast<int>(ends.border - border_.data());
  killed_count_ = static_cast<int>(ends.slot - slots_.data());
}

inline void Cavity::start(const Point& p) {
  p_ = p;
  corner_count_ = stack_count_ = border_count_ = killed_count_ = 0;
  least_cross_ = INFINITY;
  largest_lifts_ = 0;
}

inline Cavity::Corner Cavity::relative(VertexId v) const {
  const Point& q = mesh_.points[v];
  const double dx = q.x - p_.x;
  const double dy = q.y - p_.y;
  return {dx, dy, dx * dx + dy * dy, v};
}

inline void Cavity::push(HalfEdge outer, int a, int b, double cross_ab) {
  stack_[stack_count_++] = {cross_ab, &corners_[a], &corners_[b], outer};
}

double Cavity::exact_orientation(const Corner& a, const Corner& b) const {
  return orient2d(p_, mesh_.points[a.vertex], mesh_.points[b.vertex]);
}

/// Triangle t, with its corners in corners_.
inline Triangle Cavity::load(TriangleId t) {
  Triangle triangle = mesh_.triangles[t];
  if (by_place_) [[unlikely]]
    begin_at_least_corner(triangle, mesh_.points);
  for (int i = 0; i < 3; ++i) corners_[i] = relative(triangle.vertex[i]);
  return triangle;
}

/// One step of the walk from a triangle which does not obviously hold the point: either across an edge that the point
/// lies beyond (then next_ is set), or the answer.
Cavity::Found Cavity::leave(const Triangle& triangle, const double (&sides)[3]) {
  encroached_ = kNone;
  next_ = kNone;
  for (int i = 0; i < 3; ++i) {
    const Corner& a = corners_[next(i)];
    const Corner& b = corners_[previous(i)];
    if (a.lift == 0 || b.lift == 0) return Found::kOccupied;
    const double bound = kOrientationBound * (a.lift + b.lift) + kUnderflow;
    const bool beyond = sides[i] < -bound || (sides[i] <= bound && exact_orientation(a, b) < 0);
    if (!beyond) continue;
    const HalfEdge outer = triangle.neighbor[i];
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
    const Triangle triangle = load(t);
    const double sides[3] = {cross(corners_[1], corners_[2]), cross(corners_[2], corners_[0]),
                             cross(corners_[0], corners_[1])};
    const double sum = corners_[0].lift + corners_[1].lift + corners_[2].lift;
    if (std::min({sides[0], sides[1], sides[2]}) <= kOrientationBound * sum + kUnderflow) {
      const Found found = leave(triangle, sides);
      if (found != Found::kClear) return found;
      if (next_ != kNone) {
        t = next_;
        continue;
      }
    }
    corner_count_ = 3;
    slots_[killed_count_++] = t;
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
  // Local copies of what the loop touches: otherwise a store to one array would force the addresses of the others to
  // be reloaded.
  const IdSpan<TriangleId, const Triangle> triangles(mesh_.triangles);
  const IdSpan<VertexId, const Point> points(mesh_.points);
  const double px = p_.x, py = p_.y;
  Ends ends = this->ends();
  const Corner* corners_end = corners_.data() + corners_.size() - 4;
  const Edge* bottom = stack_.data();
  double least_cross = least_cross_, largest_lifts = largest_lifts_;

  Edge e = *--ends.stack;
  for (;;) {
    const double lifts = e.a->lift + e.b->lift;
    if (!is_constrained(e.outer)) [[likely]] {
      const Triangle& triangle = triangles[triangle_of(e.outer)];
      const int i = index_of(e.outer);
      const VertexId v = triangle.vertex[i];
      const double dx = points[v].x - px, dy = points[v].y - py;
      const double lift = dx * dx + dy * dy;
      const double ac = e.a->dx * dy - dx * e.a->dy;
      const double cb = dx * e.b->dy - e.b->dx * dy;
      const double determinant = e.b->lift * ac + e.a->lift * cb - lift * e.cross;
      const double sum = lifts + lift;
      const double bound = kInCircleBound * (sum * sum) + kUnderflow;
      bool inside = determinant > bound;
      if (std::abs(determinant) <= bound) [[unlikely]]
        inside = incircle(points[e.b->vertex], points[e.a->vertex], points[v], p_) > 0;
      if (inside) {
        *ends.corner = {dx, dy, lift, v};
        *ends.slot++ = triangle_of(e.outer);
        *ends.stack++ = {cb, ends.corner, e.b, triangle.neighbor[previous(i)]};
        e = {ac, e.a, ends.corner++, triangle.neighbor[next(i)]};
        if (ends.corner >= corners_end) [[unlikely]] {
          keep(ends);
          e = with_more_room(e);
          ends = this->ends();
          corners_end = corners_.data() + corners_.size() - 4;
          bottom = stack_.data();
        }
        continue;
      }
    } else if constexpr (kMindLens) {
      const double dot = e.a->dx * e.b->dx + e.a->dy * e.b->dy;
      if (dot < 0 && dot * dot > cos_squared * (e.a->lift * e.b->lift)) {
        encroached_ = subsegment_of(e.outer);
        return Found::kEncroached;
      }
    }
    least_cross = std::min(least_cross, e.cross);
    largest_lifts = std::max(largest_lifts, lifts);
    *ends.border++ = e;
    if (ends.stack == bottom) break;
    e = *--ends.stack;
  }
  keep(ends);
  least_cross_ = least_cross;
  largest_lifts_ = largest_lifts;
  return Found::kClear;
}

/// Whether every border edge has the point strictly on its left. This holds in a constrained Delaunay triangulation,
/// except near midpoints that rounding has moved off their segments.
inline Cavity::Found Cavity::check_star() const {
  if (least_cross_ > kOrientationBound * largest_lifts_ + kUnderflow) [[likely]]
    return Found::kClear;
  for (int i = 0; i < border_count_; ++i)
    if (!(exact_orientation(*border_[i].a, *border_[i].b) > 0)) return Found::kDegenerate;
  return Found::kClear;
}

Cavity::Found Cavity::gather(const Point& p, TriangleId t, const Lens& lens) {
  start(p);
  if (const Found found = walk<true>(t); found != Found::kClear) return found;
  if (const Found found = expand<true>(lens.cos_squared); found != Found::kClear) return found;
  return check_star();
}

Cavity::Found Cavity::gather_from_afar(const Point& p, TriangleId t) {
  start(p);
  if (const Found found = walk<false>(t); found != Found::kClear) return found;
  expand<false>(0);
  return check_star();
}

/// One side of a split: the border from corner `from` to corner `to`, behind half-edge `h` of the subsegment. The
/// triangle there is tested like any other. It stays if rounding has put the point beyond the subsegment and outside
/// its circumcircle; the sliver between the straight and the bent subsegment is then Delaunay.
void Cavity::gather_side(HalfEdge h, int from, int to) {
  push(h, from, to, cross(corners_[from], corners_[to]));
  expand<false>(0);
}

Cavity::Found Cavity::gather_on(SubsegmentId s, const Point& m) {
  start(m);
  const Subsegment& segment = mesh_.subsegments[s];
  corners_[0] = relative(segment.vertex[0]);
  corners_[1] = relative(segment.vertex[1]);
  corner_count_ = 2;
  if (corners_[0].lift == 0 || corners_[1].lift == 0) return Found::kDegenerate;
  // Right side first: its border runs from the segment's start to its end, that of the left side back to the start.
  if (segment.half[1] != kNone) gather_side(segment.half[1], 0, 1);
  first_left_ = border_count_;
  if (segment.half[0] != kNone) gather_side(segment.half[0], 1, 0);
  if (!mesh_.region.empty())
    for (const std::size_t side : {0, 1})
      if (segment.half[side] != kNone) regions_[side] = mesh_.region[triangle_of(segment.half[side])];
  return check_star();
}

/// Assigns a slot for its triangle to every border edge: those of the cavity's triangles, then new ones.
inline void Cavity::take_slots() {
  const int added = border_count_ - killed_count_;
  mesh_.add_triangles(&slots_[killed_count_], added);
  if (mesh_.region.empty()) [[likely]]
    return;
  // A cavity never crosses a constrained segment, so each side keeps its region.
  for (int i = 0; i < border_count_; ++i) mesh_.region[slots_[i]] = regions_[i < first_left_ ? 1 : 0];
}

void Cavity::fill(VertexId v) {
  first_left_ = 0;
  if (!mesh_.region.empty()) regions_[0] = mesh_.region[slots_[0]];
  take_slots();
  const int n = border_count_;
  const IdSpan<TriangleId, Triangle> triangles(mesh_.triangles);
  TriangleId before = slots_[n - 1];
  TriangleId here = slots_[0];
  for (int i = 0; i < n; ++i) {
    const Edge& e = border_[i];
    const TriangleId after = slots_[i + 1 == n ? 0 : i + 1];
    triangles[here] = {{v, e.a->vertex, e.b->vertex}, {e.outer, half_edge(after, 2), half_edge(before, 1)}};
    if (is_constrained(e.outer)) [[unlikely]]
      mesh_.link(half_edge(here, 0), e.outer);
    else
      triangles[triangle_of(e.outer)].neighbor[index_of(e.outer)] = half_edge(here, 0);
    before = here;
    here = after;
  }
}

void Cavity::fill_on(VertexId v, SubsegmentId at_start, SubsegmentId at_end) {
  const int right = first_left_;
  take_slots();
  const int n = border_count_;
  for (int i = 0; i < n; ++i) {
    const Edge& e = border_[i];
    const TriangleId here = slots_[i];
    const bool opens = i == 0 || i == right;
    const bool closes = i == n - 1 || i == right - 1;
    Triangle& triangle = mesh_.triangles[here];
    triangle.vertex = {v, e.a->vertex, e.b->vertex};
    mesh_.link(half_edge(here, 0), e.outer);
    if (!opens) mesh_.link(half_edge(here, 2), half_edge(slots_[i - 1], 1));
    // The right border runs from the segment's start to its end, the left one back.
    const bool on_right = i < right;
    if (opens) mesh_.link(half_edge(here, 2), constrained(on_right ? at_start : at_end));
    if (closes) mesh_.link(half_edge(here, 1), constrained(on_right ? at_end : at_start));
  }
}

Cavity::Fresh Cavity::fresh(int i) const {
  const Edge& e = border_[i];
  const Corner &a = *e.a, &b = *e.b;
  const double dx = b.dx - a.dx;
  const double dy = b.dy - a.dy;
  return {slots_[i], e.cross, a.lift, dx * dx + dy * dy, b.lift};
}

}  // namespace driftmesh
