#include <cstdint>
#include <utility>

#include "base/xml_text.hpp"
#include "io/vtu_format.hpp"
#include "io/vtu_header.hpp"
#include "io/vtu_values.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr std::uint64_t kMostComponents = 1000;

/// For each cell whether it is a triangle that the mesh has.
std::vector<bool> triangles_among(const VtuArrayReader& arrays, std::uint64_t cells) {
  std::vector<bool> counts;
  for (const std::uint8_t type : arrays.open<std::uint8_t>(arrays.get("Cells", "types"), cells).all())
    counts.push_back(type == kVtkTriangle);
  const VtuHeader::Array* const ghosts = arrays.find("CellData", "vtkGhostType");
  if (ghosts == nullptr) return counts;
  const std::vector<std::uint8_t> types = arrays.open<std::uint8_t>(*ghosts, cells).all();
  for (std::size_t cell = 0; cell < cells; ++cell) counts[cell] = counts[cell] && (types[cell] & kDuplicate) == 0;
  return counts;
}

}  // namespace

TriangleData parse_vtu_triangle_data(const std::string& file, std::string_view bytes) {
  const VtuHeader header = parse_vtu_header(file, bytes);
  const VtuArrayReader arrays(file, header);
  TriangleData data;
  std::vector<bool> counts;
  for (const auto& [place, array] : header.arrays) {
    const std::string name = unescaped(place.second);
    if (place.first != "CellData" || is_array_on_cells(name) || !fault_of_name(name).empty()) continue;
    if (counts.empty()) counts = triangles_among(arrays, header.cells);
    const std::vector<double> values = arrays.open<double>(array, header.cells, kMostComponents).all();
    for (std::size_t k = 0; k < array.components; ++k) {
      std::vector<double> column;
      for (std::size_t cell = 0; cell < counts.size(); ++cell)
        if (counts[cell]) column.push_back(values[cell * array.components + k]);
      data.try_emplace(name_of_component(name, array.components, k), std::move(column));
    }
  }
  return data;
}

}  // namespace driftmesh
