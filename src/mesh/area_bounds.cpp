#include "mesh/area_bounds.hpp"

#include <utility>

namespace driftmesh {

AreaBounds::AreaBounds(const Triangulation& mesh, SizeBounds sizes, double margin)
    : mesh_(mesh),
      sizes_(std::move(sizes)),
      by_place_(sizes_.by_place()),
      twice_area_of_least_(by_place_ ? twice_area_of_edge(sizes_.least_length()) : 0) {
  for (std::size_t label = 0; label < sizes_.regions(); ++label)
    by_region_.push_back(sizes_.twice_area(label) * (1 - margin));
}

}  // namespace driftmesh
