#pragma once

#include <array>
#include <functional>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// A target edge length as a function of position, in the units of the coordinates. A triangle is too large if its area
/// exceeds sqrt(3)/4 h^2, the area of the equilateral triangle with edges of length h, where h is the smallest value of
/// the field at its corners and its centroid, or if falls_below finds a smaller value that counts between them.
///
/// \code
/// struct Graded final : driftmesh::SizeField {
///   double edge_length(const driftmesh::Point& p) const override { return 5 + 0.1 * std::hypot(p.x, p.y); }
/// };
/// const Graded graded;
/// const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("pipe"), {.size = std::ref(graded)});
/// \endcode
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// The target edge length at `p`: > 0, or +infinity where the field sets no bound. Must depend on `p` alone and
  /// return the same bits on every rank. May throw; the exception ends meshing and propagates to the caller. Called
  /// on one object from several threads at once only if MeshOptions::threads asks for several.
  [[nodiscard]] virtual double edge_length(const Point& p) const = 0;
  /// Whether the field asks for less than `length` somewhere in a counterclockwise triangle, asked where it does not at
  /// the corners and the centroid. Depends on its arguments alone, like edge_length. What counts, and how surely it is
  /// found, is up to the field; this one knows no more than values at points, and says no.
  [[nodiscard]] virtual bool falls_below(const std::array<Point, 3>& /*triangle*/, double /*length*/) const {
    return false;
  }
  /// A length that no value falls below, so that falls_below need not be asked; 0: unknown.
  [[nodiscard]] virtual double least() const { return 0; }
  /// A length that nothing which counts in a triangle falls below, where the least of the values at the corners is
  /// known: for a field that knows how fast it changes. Takes less time than falls_below. 0: unknown.
  [[nodiscard]] virtual double least_between(const std::array<Point, 3>& /*triangle*/, double /*at_corners*/) const {
    return 0;
  }
  /// Calls visit(p) for the points where the field may be least, for those who check a mesh: the points of a background
  /// mesh. A field without such points visits none.
  virtual void visit_marks(const std::function<void(const Point&)>& /*visit*/) const {}
  /// edge_length, so that MeshOptions::size takes std::ref(field).
  [[nodiscard]] double operator()(const Point& p) const { return edge_length(p); }
};

}  // namespace driftmesh
