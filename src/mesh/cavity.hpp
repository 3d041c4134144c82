#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/triangulation.hpp"

namespace driftmesh {

/// The region around a constrained segment that no free vertex may enter: the points that see the segment under more
/// than a given angle (Shewchuk's diametral lens; with 90 degrees, Ruppert's diametral circle).
struct Lens {
  /// Square of the cosine of the angle, which is at least 90 degrees.
  double cos_squared = 0;
};

/// Insertion of one point by Bowyer and Watson's algorithm. `gather` finds the cavity (the triangles whose open
/// circumdisks hold the point, never across a constrained segment) and changes nothing; `fill` replaces it by the
/// triangles between the point and the cavity's border. One object serves a mesh for its lifetime, so that the loop
/// allocates nothing.
///
/// The point's differences to the vertices around it, their squared lengths and the cross products along the border
/// are computed once each: the orientation of a border edge, the in-circle determinant of the triangle behind it, and
/// the area of the triangle that will stand on it share them. Signs are exact: a static error bound decides, or the
/// expansion arithmetic of predicates.hpp.
class Cavity {
 public:
  explicit Cavity(Triangulation& mesh);

  /// Gives its memory back; no point can be inserted before wake().
  void rest() { reserve(0); }
  void wake() { reserve(kCorners); }
  /// From now on, borders begin where the coordinates say so, not at the first corner of a triangle: the result is the
  /// same in a mesh whose triangles have been turned.
  void begin_by_place() { by_place_ = true; }

  enum class Found {
    kClear,       ///< the cavity is ready to be filled
    kEncroached,  ///< the point lies in the lens of a constrained segment or beyond it, see encroached()
    kOccupied,    ///< there is a vertex at the point
    kDegenerate,  ///< rounding left no room for the point: some triangle would not be counterclockwise
  };

  /// The cavity of a free point, found from `start`, a triangle whose circumdisk holds the point.
  Found gather(const Point& p, TriangleId start, const Lens& lens);
  /// The same, ignoring constrained segments and walking from any triangle (for the initial triangulation).
  Found gather_from_afar(const Point& p, TriangleId start);
  /// The cavity of point `m` on the leaf subsegment `s`, on both sides of it (or on one side at the boundary of the
  /// domain).
  Found gather_on(SubsegmentId s, const Point& m);

  [[nodiscard]] SubsegmentId encroached() const { return encroached_; }

  /// Fills the cavity of a free point with triangles around `v`, the vertex at that point.
  void fill(VertexId v);
  /// Fills the cavity found by gather_on and links the two pieces of the subsegment: `at_start` from its start to `v`,
  /// and `at_end` from `v` to its end.
  void fill_on(VertexId v, SubsegmentId at_start, SubsegmentId at_end);

  /// One of the triangles that the last fill made, with the values that determine its quality.
  struct Fresh {
    TriangleId triangle;
    double twice_area;
    double ab, bc, ca;  ///< squared lengths of the edges
  };
  [[nodiscard]] int fresh_count() const { return border_count_; }
  [[nodiscard]] TriangleId fresh_triangle(int i) const { return slots_[i]; }
  [[nodiscard]] Fresh fresh(int i) const;

 private:
  /// A vertex near the point, relative to it.
  struct Corner {
    double dx, dy;
    double lift;  // squared distance
    VertexId vertex;
  };
  /// An edge of the growing cavity, a to b with the point on its left.
  struct Edge {
    double cross;  // twice the area of (point, a, b)
    const Corner* a;
    const Corner* b;
    HalfEdge outer;
  };

  void start(const Point& p);
  [[nodiscard]] Corner relative(VertexId v) const;
  static double cross(const Corner& a, const Corner& b) { return a.dx * b.dy - b.dx * a.dy; }
  [[nodiscard]] double exact_orientation(const Corner& a, const Corner& b) const;
  template <bool kMindConstraints>
  Found walk(TriangleId t);
  Found leave(const Triangle& triangle, const double (&sides)[3]);
  [[nodiscard]] Triangle load(TriangleId t);
  template <bool kMindLens>
  Found expand(double cos_squared);
  void gather_side(HalfEdge h, int from, int to);
  Found check_star() const;
  void push(HalfEdge outer, int a, int b, double cross_ab);
  void take_slots();
  static constexpr std::size_t kCorners = 64;  // enough for nearly all cavities
  void reserve(std::size_t corners);
  Edge with_more_room(const Edge& e);
  /// One past the last element in use of each array, as pointers for the inner loop.
  struct Ends {
    Corner* corner;
    Edge* stack;
    Edge* border;
    TriangleId* slot;
  };
  [[nodiscard]] Ends ends();
  void keep(const Ends& ends);

  Triangulation& mesh_;
  Point p_;
  SubsegmentId encroached_ = kNone;
  bool by_place_ = false;
  std::vector<Corner> corners_;
  std::vector<Edge> stack_;
  std::vector<Edge> border_;
  std::vector<TriangleId> slots_;  // first those of the cavity's triangles, then added ones
  int corner_count_ = 0;
  int stack_count_ = 0;
  int border_count_ = 0;
  int killed_count_ = 0;
  int first_left_ = 0;  // for a split, where the border passes from the right side of the segment to the left
  std::array<std::uint16_t, 2> regions_{};  // left and right of a split; of a free point, left
  TriangleId next_ = kNone;                 // where the walk continues
  double least_cross_ = 0;                  // the least among the border's edges
  double largest_lifts_ = 0;                // sum of the squared distances of an edge's ends, of the border's edges
};

}  // namespace driftmesh
