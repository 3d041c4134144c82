#include "verify/chains.hpp"

#include <cmath>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

Chains::Chains(const Mesh& mesh, const Subsegments& subsegments, const std::function<bool(std::int32_t)>& is_corner)
    : subsegments_(&subsegments),
      through_(mesh.points.size(), kNone),
      ends_chain_(mesh.points.size()),
      taken_(subsegments.size()) {
  const auto count = static_cast<std::int32_t>(mesh.points.size());
  for (std::int32_t v = 0; v < count; ++v) {
    const std::size_t degree = subsegments.at(v).size();
    ends_chain_[v] = degree != 0 && (degree != 2 || is_corner(v));
  }
  for (std::int32_t v = 0; v < count; ++v)
    if (ends_chain_[v])
      for (const std::int32_t s : subsegments.at(v)) follow(v, s);
  for (const std::int32_t s : subsegments.ids()) {  // loops without a corner are left
    if (taken_[s]) continue;
    ends_chain_[subsegments[s].a] = 1;
    follow(subsegments[s].a, s);
  }
}

void Chains::follow(std::int32_t corner, std::int32_t subsegment) {
  if (taken_[subsegment]) return;
  const auto number = static_cast<std::int32_t>(chains_.size());
  Chain& chain = chains_.emplace_back();
  chain.vertices.push_back(corner);
  for (;;) {
    taken_[subsegment] = 1;
    chain.subsegments.push_back(subsegment);
    const std::int32_t v = subsegments_->other_end(subsegment, chain.vertices.back());
    chain.vertices.push_back(v);
    if (ends_chain_[v]) return;
    through_[v] = number;
    const auto both = subsegments_->at(v);
    subsegment = both[0] == subsegment ? both[1] : both[0];
  }
}

bool bends_at(const Mesh& mesh, const Subsegments& subsegments, std::int32_t point) {
  const auto both = subsegments.at(point);
  if (both.size() != 2) return true;
  const Point& hub = mesh.points[point];
  const Point& a = mesh.points[subsegments.other_end(both[0], point)];
  const Point& b = mesh.points[subsegments.other_end(both[1], point)];
  const double ax = a.x - hub.x, ay = a.y - hub.y, bx = b.x - hub.x, by = b.y - hub.y;
  return !(std::fabs(ax * by - ay * bx) <= 1e-6 * -(ax * bx + ay * by));
}

}  // namespace driftmesh
