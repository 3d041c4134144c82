#include "io/triangle_tables.hpp"

#include <algorithm>

namespace driftmesh {

void write_nodes(FileSink& sink, const NodeLines& nodes, std::int32_t first) {
  const std::size_t width = nodes.attributes_per_point, markers = nodes.markers.empty() ? 0 : 1;
  sink.line(nodes.points.size(), 2, width, markers);
  for (std::size_t v = 0; v < nodes.points.size(); ++v)
    sink.line(first + static_cast<std::int64_t>(v), nodes.points[v].x, nodes.points[v].y,
              nodes.attributes.subspan(v * width, width), nodes.markers.subspan(markers * v, markers));
}

void write_elements(FileSink& sink, const ElementLines& elements, std::int32_t first) {
  const std::size_t size = elements.points_per_element, width = elements.attributes_per_element;
  const std::size_t count = elements.points.size() / size;
  sink.line(count, size, width);
  std::array<std::int32_t, 6> numbers{};
  for (std::size_t t = 0; t < count; ++t) {
    std::ranges::transform(elements.points.subspan(t * size, size), numbers.begin(),
                           [first](std::int32_t v) { return v + first; });
    sink.line(first + static_cast<std::int64_t>(t), std::span(numbers).first(size),
              elements.attributes.subspan(t * width, width));
  }
}

void write_neighbors(FileSink& sink, std::span<const std::array<std::int32_t, 3>> neighbors, std::int32_t first) {
  sink.line(neighbors.size(), 3);
  const auto numbered = [first](std::int32_t t) { return t < 0 ? -1 : t + first; };
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    sink.line(first + static_cast<std::int64_t>(t), numbered(neighbors[t][0]), numbered(neighbors[t][1]),
              numbered(neighbors[t][2]));
}

void write_edges(FileSink& sink, std::span<const std::array<std::int32_t, 2>> edges,
                 std::span<const std::int32_t> markers, std::int32_t first) {
  const std::size_t marked = markers.empty() ? 0 : 1;
  sink.line(edges.size(), marked);
  for (std::size_t e = 0; e < edges.size(); ++e)
    sink.line(first + static_cast<std::int64_t>(e), edges[e][0] + first, edges[e][1] + first,
              markers.subspan(marked * e, marked));
}

}  // namespace driftmesh
