#include "adapt/sums_at_points.hpp"

#include <utility>

#include "adapt/shared_points.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh::adapt {

SumsAtPoints::SumsAtPoints(const DistributedPiece& piece, std::size_t width)
    : piece_(piece), width_(width), sums_(width * piece.mesh.points.size()), is_shared_(piece.mesh.points.size()) {
  for (const DistributedPiece::Neighbor& neighbor : piece.neighbors)
    for (const std::int32_t point : neighbor.shared) is_shared_[to_index(point)] = true;
}

void SumsAtPoints::add(SubdomainId s, std::int32_t point, std::span<const double> values) {
  if (is_shared_[to_index(point)])
    shared_[point][s].assign(values.begin(), values.end());
  else
    for (std::size_t i = 0; i < width_; ++i) sums_[to_index(point) * width_ + i] += values[i];
}

std::vector<double> SumsAtPoints::take(Ranks& ranks) {
  std::map<std::int32_t, Parts> others;
  const auto write = [&](std::int32_t point, ByteWriter& writer) {
    const Parts& parts = shared_[point];
    writer.value(static_cast<std::uint32_t>(parts.size()));
    for (const auto& [s, values] : parts) {
      writer.value(s);
      writer.array(values);
    }
  };
  const auto read = [&](std::int32_t point, ByteReader& reader, Rank /*from*/) {
    for (auto left = reader.value<std::uint32_t>(); left > 0; --left) {
      const auto s = reader.value<SubdomainId>();
      reader.array(others[point][s]);
    }
  };
  tell_at_shared_points(ranks, piece_, write, read);
  for (auto& [point, parts] : shared_) {
    parts.merge(others[point]);
    for (const auto& [s, values] : parts)
      for (std::size_t i = 0; i < width_; ++i) sums_[to_index(point) * width_ + i] += values.at(i);
  }
  return std::move(sums_);
}

}  // namespace driftmesh::adapt
