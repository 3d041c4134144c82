#include "verify/subsegments.hpp"

#include <utility>

#include "base/narrow.hpp"

namespace driftmesh {

Subsegments::Subsegments(std::size_t point_count, std::vector<Mesh::Edge> edges)
    : edges_(std::move(edges)),
      sides_(edges_.size(), {kNone, kNone}),
      first_(point_count + 1),
      by_end_(2 * edges_.size()) {
  (void)narrow<std::int32_t>(by_end_.size(), "subsegments to check");
  for (const auto& edge : edges_) ++first_[edge.a], ++first_[edge.b];
  std::uint32_t sum = 0;
  for (std::uint32_t& entry : first_) entry = sum += entry;
  for (std::size_t s = edges_.size(); s-- > 0;)
    for (const std::int32_t end : {edges_[s].a, edges_[s].b}) by_end_[--first_[end]] = static_cast<std::int32_t>(s);
}

std::int32_t Subsegments::find(std::int32_t u, std::int32_t v) const {
  if (at(u).empty()) return kNone;
  if (at(v).size() < at(u).size()) std::swap(u, v);
  for (const std::int32_t s : at(u))
    if (other_end(s, u) == v) return s;
  return kNone;
}

void Subsegments::set_sides(std::int32_t s, std::int32_t from, std::int32_t left, std::int32_t right) {
  if ((*this)[s].a == from)
    sides_[s] = {left, right};
  else
    sides_[s] = {right, left};
}

}  // namespace driftmesh
