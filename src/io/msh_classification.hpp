#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "geometry/box.hpp"

namespace driftmesh {

/// An entity of the file (a curve for each marker, a surface for each region), which is also a physical group.
struct MshEntity {
  std::int32_t tag = 0;
  std::string name;
  Box box;
  double value = 0;          ///< marker or region
  bool hides_value = false;  ///< neither name nor tag tells it
};

/// Which entity everything belongs to. Curves and surfaces are numbered from 0; a node on both belongs to the curve.
struct MshClassification {
  explicit MshClassification(const Mesh& mesh);

  std::vector<MshEntity> curves;
  std::vector<MshEntity> surfaces;
  std::vector<std::int32_t> curve_of_edge;
  std::vector<std::int32_t> surface_of_triangle;
  std::vector<std::int32_t> entity_of_node;           ///< curves, then surfaces
  std::vector<std::vector<std::int32_t>> boundaries;  ///< the curves at each surface
  std::vector<std::array<std::int32_t, 2>> at_edges;  ///< triangles, as by triangles_at_edges

 private:
  void classify_edges(const Mesh& mesh);
  void classify_triangles(const Mesh& mesh);
  void find_boxes(const Mesh& mesh);
  void classify_nodes(const Mesh& mesh);
  void find_boundaries(const Mesh& mesh);
};

}  // namespace driftmesh
