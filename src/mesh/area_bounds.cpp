#include "mesh/area_bounds.hpp"

#include <cstdint>

namespace driftmesh {

AreaBounds::AreaBounds(const Triangulation& mesh, const QualityBounds& bounds, double margin)
    : mesh_(mesh),
      size_(bounds.size),
      twice_area_of_least_(bounds.size != nullptr ? twice_area_of_edge(bounds.size->least()) : 0) {
  const std::size_t labels = std::max<std::size_t>(1, bounds.region_max_area.size());
  for (std::size_t label = 0; label < labels; ++label)
    by_region_.push_back(2 * area_bound(bounds, static_cast<std::uint16_t>(label)) * (1 - margin));
}

}  // namespace driftmesh
