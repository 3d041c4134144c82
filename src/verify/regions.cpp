#include "verify/regions.hpp"

#include <algorithm>
#include <tuple>

#include "base/formatted.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {

DisjointSets<std::int32_t> parts_of_frame(const Frame& frame) {
  const auto key = [&](std::int32_t t) { return std::tuple(frame.places[t].piece, frame.parts[t], t); };
  std::vector<std::int32_t> order;
  for (const std::int32_t t : first_ids<std::int32_t>(frame.parts.size())) order.push_back(t);
  std::ranges::sort(order, {}, key);
  DisjointSets<std::int32_t> parts(order.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::int32_t s = order[i - 1], t = order[i];
    if (frame.places[s].piece == frame.places[t].piece && frame.parts[s] == frame.parts[t]) parts.join(s, t);
  }
  return parts;
}

FacesOfParts::FacesOfParts(const Frame& frame, const std::vector<std::int32_t>& faces) {
  for (std::size_t t = 0; t < faces.size(); ++t) entries_.push_back({frame.places[t].piece, frame.parts[t], faces[t]});
  std::ranges::sort(entries_);
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
}

std::vector<std::int32_t> FacesOfParts::of_triangles(std::int32_t piece, std::size_t triangles,
                                                     DisjointSets<std::int32_t>& parts) const {
  std::vector<std::int32_t> face_of_part(triangles, kNone), faces;
  for (auto entry = std::ranges::lower_bound(entries_, piece, {}, &Entry::piece);
       entry != entries_.end() && entry->piece == piece; ++entry)
    face_of_part[entry->part] = entry->face;
  faces.reserve(triangles);
  for (const std::int32_t t : first_ids<std::int32_t>(triangles)) faces.push_back(face_of_part[parts.find(t)]);
  return faces;
}

void check_regions(const NamedMesh& names, const Domain& domain, const std::vector<std::int32_t>& faces,
                   Findings& findings) {
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (faces[t] == kNone) continue;
    const Pslg::Region* region = domain.region_of(faces[t]);
    const double expected = region != nullptr ? region->attribute : 0, actual = names.mesh().regions[t];
    if (actual != expected)
      findings.add(Flaw::kWrongRegion, [&] {
        return formatted("{} has region attribute {}, expected {}", triangle_words(names, t), actual, expected);
      });
  }
}

}  // namespace driftmesh
