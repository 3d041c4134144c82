#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "driftmesh/point.hpp"
#include "geometry/box_tree.hpp"
#include "mesh/triangulation.hpp"
#include "sizing/background_mesh.hpp"

namespace driftmesh::adapt {

/// Finds the triangle around a point by walking from where the last point was, which takes a step or two if points
/// follow each other as refinement makes them. What it finds depends on the point alone, by exact predicates: on an
/// edge it is the triangle with the lower number. For one thread at a time.
class Locator {
 public:
  /// The mesh must outlive the object, and stay as it is.
  explicit Locator(const Triangulation& mesh);

  struct Place {
    TriangleId triangle{};
    std::array<double, 3> weight{};  ///< the point as a convex combination of the corners
    int corner = kNoCorner;          ///< the corner at which the point is, if it is at one
    bool beyond = false;             ///< the point is outside, by more than rounding
    [[nodiscard]] bool is_vertex() const { return corner != kNoCorner; }
  };
  /// A point outside, as rounding puts them there, or one of another domain, has the place of the nearest point of the
  /// boundary.
  [[nodiscard]] Place locate(const Point& p) const;

 private:
  static constexpr int kNoCorner = -1;
  struct Stop;

  [[nodiscard]] Stop seen_from(TriangleId t, const Point& p) const;
  [[nodiscard]] Stop walk(TriangleId start, const Point& p, int most_steps) const;
  [[nodiscard]] int most_steps() const;
  [[nodiscard]] bool is_settled(const Stop& stop, const Point& p) const;
  [[nodiscard]] TriangleId start_near(const Point& p) const;
  void make_starts() const;
  void make_rim() const;
  void index_all() const;
  [[nodiscard]] std::optional<Stop> search_from_rim(const Point& p) const;
  [[nodiscard]] Stop search_all(const Point& p) const;
  [[nodiscard]] Stop beyond_edge(HalfEdge edge, const Point& p) const;
  [[nodiscard]] Place place_at(const Stop& stop, const Point& p) const;

  const Triangulation& mesh_;
  mutable TriangleId last_ = kNone;

  // For long walks, and those that end at the boundary of a domain that is not convex: a triangle near each square of a
  // grid. Made when the first of them does.
  mutable std::vector<TriangleId> starts_;
  mutable Point low_{};
  mutable double width_ = 0;
  mutable std::size_t columns_ = 0;

  // For points outside, and where walks end at the boundary: the edges of that. Made when the first of them comes.
  mutable std::vector<HalfEdge> rim_;
  mutable BoxTree rim_tree_;

  // Where walks from there do, too. Made when the first of them comes.
  mutable std::shared_ptr<const BackgroundMesh> all_;
  mutable std::vector<TriangleId> in_all_;
};

}  // namespace driftmesh::adapt
