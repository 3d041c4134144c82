#include "pslg/keep_points.hpp"

#include <cstddef>

#include "driftmesh/id_vector.hpp"
#include "pslg/polygons.hpp"

namespace driftmesh {
namespace {

/// Keeps these entries, each of which consists of `width` values.
template <class T>
void keep_entries(std::vector<T>& values, const std::vector<std::int32_t>& kept, std::size_t width) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t k = 0; k < width; ++k) values[i * width + k] = values[to_index(kept[i]) * width + k];
  values.resize(kept.size() * width);
}

}  // namespace

std::vector<std::int32_t> keep_points(Pslg& pslg, const std::vector<bool>& gone) {
  std::vector<std::int32_t> kept, place(gone.size(), kNone);
  for (const std::int32_t p : first_ids<std::int32_t>(gone.size())) {
    if (gone[to_index(p)]) continue;
    place[to_index(p)] = static_cast<std::int32_t>(kept.size());
    kept.push_back(p);
  }
  keep_entries(pslg.points, kept, 1);
  keep_entries(pslg.point_markers, kept, 1);
  keep_entries(pslg.attributes, kept, to_index(pslg.attributes_per_point));
  for (Pslg::Segment& s : pslg.segments) s = {place[to_index(s.a)], place[to_index(s.b)], s.marker};
  for (Pslg::Polygon& polygon : pslg.polygons)
    for (Pslg::Ring& ring : polygon.rings) {
      for (std::int32_t& corner : ring) corner = place[to_index(corner)];
      std::erase(ring, kNone);
      drop_repetitions(ring);
    }
  return kept;
}

}  // namespace driftmesh
