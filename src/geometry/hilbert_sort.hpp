#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/box.hpp"
#include "geometry/hilbert.hpp"

namespace driftmesh {

/// Things with their positions along a Hilbert curve.
template <class T>
using AlongCurve = std::vector<std::pair<std::uint64_t, T>>;

/// Sorts by position, then by the things. Many are first dealt out to equal parts of the curve, so that what is left to
/// sort fits into the cache.
template <class T>
void sort_along_curve(AlongCurve<T>& places) {
  constexpr std::size_t kMany = 20'000;
  constexpr int kPartBits = 12;
  if (places.size() < kMany) return std::sort(places.begin(), places.end());
  const auto part = [](const auto& place) { return place.first >> (64 - kPartBits); };
  std::vector<std::size_t> end((std::size_t{1} << kPartBits) + 1, 0);
  for (const auto& place : places) ++end[part(place) + 1];
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  AlongCurve<T> dealt(places.size());
  for (const auto& place : places) dealt[end[part(place)]++] = place;
  std::size_t begin = 0;
  for (const std::size_t next : end) {
    std::sort(dealt.begin() + begin, dealt.begin() + next);
    begin = next;
  }
  places.swap(dealt);
}

/// The indices of points in their order along a Hilbert curve, equal ones ascending.
[[nodiscard]] inline std::vector<std::size_t> in_hilbert_order(const std::vector<Point>& points) {
  std::vector<std::size_t> sorted;
  if (points.empty()) return sorted;
  const Box box = Box::of(points);
  const HilbertOrder order(box.low, box.high);
  AlongCurve<std::size_t> places;
  places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) places.emplace_back(order.index(points[i]), i);
  sort_along_curve(places);
  sorted.reserve(points.size());
  for (const auto& place : places) sorted.push_back(place.second);
  return sorted;
}

}  // namespace driftmesh
