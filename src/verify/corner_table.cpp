#include "verify/corner_table.hpp"

#include "base/huge_pages.hpp"
#include "base/narrow.hpp"

namespace driftmesh {

CornerTable::CornerTable(const Mesh& mesh) {
  reserve_in_huge_pages(first_, mesh.points.size() + 1);
  reserve_in_huge_pages(corners_, 3 * mesh.triangles.size());
  first_.resize(mesh.points.size() + 1);
  corners_.resize(3 * mesh.triangles.size());
  (void)narrow<std::uint32_t>(corners_.size(), "triangle corners to check");
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t v : triangle) ++first_[v];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : first_) entry = sum += entry;
  // Each entry is now the end of its group; filling backwards turns it into the beginning.
  for (std::size_t t = mesh.triangles.size(); t-- > 0;)
    for (std::size_t k = 3; k-- > 0;) corners_[--first_[mesh.triangles[t][k]]] = static_cast<std::uint32_t>(3 * t + k);
}

}  // namespace driftmesh
