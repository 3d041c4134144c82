#pragma once

#include <cstddef>
#include <span>

#include "driftmesh/mesh.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"
#include "sizing/background_mesh.hpp"

namespace driftmesh {

/// The point attributes of an input as functions of position: linear interpolation in its constrained Delaunay
/// triangulation.
class AttributeField {
 public:
  /// `pslg`, a repaired input, outlives the field.
  explicit AttributeField(const Pslg& pslg);
  /// Sets the attributes_per_point values at `p`. They depend on the input and `p` alone.
  void evaluate(const Point& p, std::span<double> values) const;
  /// Those of a point of the mesh: what the input gives its own points, and evaluate() all others.
  void evaluate(VertexOrigin origin, const Point& p, std::span<double> values) const;
  /// The number of points of the input that its triangulation uses.
  [[nodiscard]] std::size_t used_points() const { return used_points_; }

 private:
  AttributeField(const Pslg& pslg, const Triangulation& initial);
  const Pslg& pslg_;
  std::size_t used_points_;
  BackgroundMesh background_;
};

/// Gives every added point of `piece` attributes: linear interpolation in the constrained Delaunay triangulation of
/// `pslg`, the repaired input that the piece was made from. Points on a segment of the input are thus interpolated
/// between its ends; those that rounding put outside the domain get the values of the nearest boundary point. Points of
/// the input (which come first, see to_piece) keep their values. Does nothing if the input has no attributes.
void interpolate_attributes(const Pslg& pslg, Mesh& piece);

}  // namespace driftmesh
