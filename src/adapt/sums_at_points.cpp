#include "adapt/sums_at_points.hpp"

#include <map>
#include <utility>

#include "adapt/shared_points.hpp"

namespace driftmesh::adapt {

namespace {

/// What subdomains have at a point.
using OfSubdomains = std::map<SubdomainId, std::vector<double>>;

}  // namespace

SumsAtPoints::SumsAtPoints(const Generation& generation, std::size_t width)
    : piece_(generation.piece),
      width_(width),
      sums_(width * piece_.mesh.points.size()),
      is_shared_(piece_.mesh.points.size()),
      is_common_(piece_.mesh.points.size()),
      at_borders_(generation.parts.size()) {
  std::vector<bool> is_seen(piece_.mesh.points.size());
  for (const SubdomainId s : generation.here)
    for (const std::int32_t place : generation.places[s]) {
      if (place == kNone) continue;
      is_common_[to_index(place)] = is_seen[to_index(place)];
      is_seen[to_index(place)] = true;
    }
  for (const DistributedPiece::Neighbor& neighbor : piece_.neighbors)
    for (const std::int32_t point : neighbor.shared) is_shared_[to_index(point)] = is_common_[to_index(point)] = true;
}

void SumsAtPoints::add(SubdomainId s, std::int32_t point, std::span<const double> values) {
  if (is_common_[to_index(point)]) {
    at_borders_[s].points.push_back(point);
    at_borders_[s].values.insert(at_borders_[s].values.end(), values.begin(), values.end());
  } else {
    for (std::size_t i = 0; i < width_; ++i) sums_[to_index(point) * width_ + i] += values[i];
  }
}

std::vector<double> SumsAtPoints::take(Ranks& ranks) {
  std::map<std::int32_t, OfSubdomains> shared, others;
  for (const SubdomainId s : ids_of(at_borders_)) {
    const AtBorders own = std::move(at_borders_[s]);
    for (std::size_t i = 0; i < own.points.size(); ++i) {
      const std::int32_t point = own.points[i];
      const auto values = std::span(own.values).subspan(i * width_, width_);
      if (is_shared_[to_index(point)])
        shared[point][s].assign(values.begin(), values.end());
      else
        for (std::size_t k = 0; k < width_; ++k) sums_[to_index(point) * width_ + k] += values[k];
    }
  }
  const auto write = [&](std::int32_t point, ByteWriter& writer) {
    const OfSubdomains& parts = shared[point];
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
  for (auto& [point, parts] : shared) {
    parts.merge(others[point]);
    for (const auto& [s, values] : parts)
      for (std::size_t i = 0; i < width_; ++i) sums_[to_index(point) * width_ + i] += values.at(i);
  }
  return std::move(sums_);
}

}  // namespace driftmesh::adapt
