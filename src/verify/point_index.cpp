#include "verify/point_index.hpp"

#include <bit>

#include "base/huge_pages.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

// Adding 0.0 turns -0.0 into 0.0: both compare equal and must hash alike.
std::uint64_t hash(const Point& p) {
  std::uint64_t h = std::bit_cast<std::uint64_t>(p.x + 0.0) * 0x9e3779b97f4a7c15u;
  h ^= std::rotl(h, 32);
  h = (h + std::bit_cast<std::uint64_t>(p.y + 0.0)) * 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

}  // namespace

PointIndex::PointIndex(std::span<const Point> points) : points_(points) {
  const std::size_t slots = std::bit_ceil(2 * points.size() + 1);
  reserve_in_huge_pages(slots_, slots);
  slots_.assign(slots, kNone);
}

std::int32_t PointIndex::add(std::int32_t i) {
  std::int32_t& slot = slots_[slot_of(points_[i])];
  if (slot == kNone) slot = i;
  return slot;
}

std::size_t PointIndex::slot_of(const Point& p) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(p) & mask;
  while (slots_[slot] != kNone && !(points_[slots_[slot]] == p)) slot = (slot + 1) & mask;
  return slot;
}

}  // namespace driftmesh
