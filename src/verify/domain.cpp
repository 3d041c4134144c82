#include "verify/domain.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "driftmesh/id_vector.hpp"
#include "geometry/predicates.hpp"
#include "verify/alternating_rings.hpp"
#include "verify/extended.hpp"
#include "verify/face_cover.hpp"
#include "verify/point_index.hpp"
#include "verify/words.hpp"

namespace driftmesh {
namespace {

constexpr std::int32_t kNoRegion = -1;

/// The convex hull counterclockwise, with the points on its edges (Andrew 1979). Empty when all points are collinear.
std::vector<std::int32_t> convex_hull(const std::vector<Point>& points) {
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
  const auto at = [&](std::int32_t i) -> const Point& { return points[i]; };
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return std::tie(at(a).x, at(a).y) < std::tie(at(b).x, at(b).y); });
  std::vector<std::int32_t> hull;
  const auto add_side = [&](auto first, auto last) {
    const std::size_t base = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= base + 2 && orient2d(at(hull[hull.size() - 2]), at(hull.back()), at(*first)) < 0)
        hull.pop_back();
      hull.push_back(*first);
    }
    hull.pop_back();
  };
  if (order.size() < 3) return {};
  add_side(order.begin(), order.end());
  if (hull.size() + 1 == order.size() && std::all_of(hull.begin(), hull.end(), [&](std::int32_t i) {
        return orient2d(at(order.front()), at(i), at(order.back())) == 0;
      }))
    return {};
  add_side(order.rbegin(), order.rend());
  return hull;
}

}  // namespace

Domain::Domain(const Pslg& input, HoleRule holes, std::span<const Point> places) {
  std::vector<std::int32_t> number;
  take_points(input, number);
  if (conflict_) return;
  if (input.segments.empty() && input.polygons.empty())
    take_hull();
  else
    take_segments(input, number);
  if (!conflict_) take_polygons(input, number);
  if (conflict_) return;

  std::vector<Arrangement::Link> links;
  links.reserve(segments_.size());
  for (const Segment& s : segments_) links.push_back({s.a, s.b});
  std::vector<Point> seeds = input.holes;
  for (const auto& region : input.regions) seeds.push_back(region.at);
  const std::size_t seeds_count = seeds.size();
  seeds.insert(seeds.end(), places.begin(), places.end());
  const Arrangement arrangement(points_, std::move(links), std::move(seeds));
  conflict_ = arrangement.conflict();
  if (conflict_) return;
  classify(input, holes, arrangement);
  measure(arrangement);
  if (!polygons_.empty()) measure_faces();
  for (std::size_t i = seeds_count; i < seeds_count + places.size(); ++i)
    face_of_place_.push_back(arrangement.face_of_query(i));
}

void Domain::take_points(const Pslg& input, std::vector<std::int32_t>& number) {
  PointIndex points(input.points);
  std::vector<std::int32_t> number_of_first(input.points.size(), -1);
  for (const std::int32_t i : first_ids<std::int32_t>(input.points.size())) {
    const Point& p = input.points[i];
    if (!in_input_range(p.x) || !in_input_range(p.y)) {
      conflict_ = "the point " + place_words(p) + " is outside the range of coordinates";
      return;
    }
    const std::int32_t first = points.add(i);
    if (first == i) {
      number_of_first[i] = static_cast<std::int32_t>(points_.size());
      points_.push_back(p);
    }
    number.push_back(number_of_first[first]);
  }
}

void Domain::take_segments(const Pslg& input, const std::vector<std::int32_t>& number) {
  std::vector<Segment> all;
  for (const auto& s : input.segments) {
    if (to_index(s.a) >= number.size() || to_index(s.b) >= number.size()) {
      conflict_ = "a segment names a point that does not exist";
      return;
    }
    const auto [a, b] = std::minmax(number[s.a], number[s.b]);
    if (a != b) all.push_back({a, b, s.marker, 0, 0});
  }
  const auto ends = [](const Segment& s) { return std::pair(s.a, s.b); };
  std::stable_sort(all.begin(), all.end(), [&](const Segment& s, const Segment& t) { return ends(s) < ends(t); });
  std::unique_copy(all.begin(), all.end(), std::back_inserter(segments_),
                   [&](const Segment& s, const Segment& t) { return ends(s) == ends(t); });
}

/// Corners that repeat the one before them are left out.
void Domain::take_polygons(const Pslg& input, const std::vector<std::int32_t>& number) {
  for (const Pslg::Polygon& given : input.polygons) {
    Pslg::Polygon& polygon = polygons_.emplace_back();
    polygon.region = to_index(given.region) < input.regions.size() ? given.region : kNoRegion;
    for (const Pslg::Ring& given_ring : given.rings) {
      Pslg::Ring& ring = polygon.rings.emplace_back();
      for (const std::int32_t corner : given_ring) {
        if (to_index(corner) >= number.size()) {
          conflict_ = "a polygon names a point that does not exist";
          return;
        }
        if (ring.empty() || ring.back() != number[corner]) ring.push_back(number[corner]);
      }
      while (!ring.empty() && ring.back() == ring.front()) ring.pop_back();
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (const std::int32_t a = ring[i], b = ring[(i + 1) % ring.size()]; !has_segment(a, b)) {
          conflict_ = "no segment joins the corners " + place_words(points_[a]) + " and " + place_words(points_[b]) +
                      " of a polygon";
          return;
        }
    }
  }
}

bool Domain::has_segment(std::int32_t a, std::int32_t b) const {
  const auto ends = [](const Segment& s) { return std::pair(s.a, s.b); };
  return std::ranges::binary_search(segments_, std::pair<std::int32_t, std::int32_t>(std::minmax(a, b)), {}, ends);
}

void Domain::take_hull() {
  const std::vector<std::int32_t> hull = convex_hull(points_);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const auto [a, b] = std::minmax(hull[i], hull[(i + 1) % hull.size()]);
    segments_.push_back({a, b, 1, 0, 0});
  }
}

void Domain::classify(const Pslg& input, HoleRule holes, const Arrangement& arrangement) {
  inside_.assign(arrangement.face_count(), 1);
  inside_[Arrangement::kUnbounded] = 0;
  region_of_face_.assign(inside_.size(), kNoRegion);
  if (!polygons_.empty()) {
    const FaceCover cover(arrangement, polygons_);
    for (std::int32_t face = 0; face < face_count(); ++face) {
      inside_[face] = cover.covered(face) ? 1 : 0;
      region_of_face_[face] = cover.region(face);
    }
  }
  for (std::size_t hole = 0; hole < input.holes.size(); ++hole)
    if (const std::int32_t face = arrangement.face_of_query(hole); face != Arrangement::kOnBoundary) inside_[face] = 0;

  find_regions(input, arrangement);
  if (holes == HoleRule::kNested) {
    const std::vector<char> odd = inside_of_alternating_rings(arrangement);
    for (std::int32_t face = 0; face < face_count(); ++face)
      if (odd[face] == 0 && region_of_face_[face] == kNoRegion) inside_[face] = 0;
  }

  point_inside_.assign(points_.size(), 0);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    Segment& s = segments_[i];
    s.left_face = arrangement.left_face(static_cast<std::int32_t>(i));
    s.right_face = arrangement.right_face(static_cast<std::int32_t>(i));
    if (inside(s)) point_inside_[s.a] = point_inside_[s.b] = 1;
  }
  for (std::size_t p = 0; p < points_.size(); ++p)
    if (const std::int32_t face = arrangement.face_of_point(static_cast<std::int32_t>(p));
        face != Arrangement::kOnBoundary)
      point_inside_[p] = inside_[face];
}

/// Regions that no polygon names are seeds. Where polygons name some and none of these is left, all triangles have
/// none.
void Domain::find_regions(const Pslg& input, const Arrangement& arrangement) {
  regions_ = input.regions;
  std::vector<char> is_seed(regions_.size(), 1);
  for (const Pslg::Polygon& polygon : polygons_)
    if (polygon.region != kNoRegion) {
      is_seed[polygon.region] = 0;
      has_regions_ = true;
    }
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    const std::int32_t face = arrangement.face_of_query(input.holes.size() + r);
    if (is_seed[r] != 0 && face != Arrangement::kOnBoundary) region_of_face_[face] = static_cast<std::int32_t>(r);
  }
  for (std::int32_t face = 0; face < face_count(); ++face) {
    if (!inside(face)) region_of_face_[face] = kNoRegion;
    has_regions_ = has_regions_ || region_of_face_[face] != kNoRegion;
  }
}

// Euler number: points minus segments of the closed domain, plus for each open face 2 minus the parts of its boundary
// (a disk with k - 1 holes).
void Domain::measure(const Arrangement& arrangement) {
  CompensatedSum twice_area;
  double tolerance = 0;
  for (const Segment& s : segments_) {
    if (!inside(s)) continue;
    --euler_number_;
    if (inside(s.left_face) && inside(s.right_face)) continue;
    const Point &a = points_[s.a], &b = points_[s.b];
    const long double cross = cross_extended(points_.front(), a, b);
    twice_area.add(inside(s.left_face) ? cross : -cross);
    tolerance += split_tolerance(a, b) * std::hypot(b.x - a.x, b.y - a.y);
  }
  area_ = twice_area.value() / 2;
  area_tolerance_ = tolerance + 1e-14 * area_;
  euler_number_ += std::count(point_inside_.begin(), point_inside_.end(), 1);
  for (std::int32_t face = 0; face < arrangement.face_count(); ++face)
    if (inside(face)) euler_number_ += 2 - arrangement.boundary_parts(face);
}

void Domain::measure_faces() {
  double largest = 0;
  std::vector<CompensatedSum> of_faces(inside_.size());
  for (const Segment& s : segments_) {
    const Point &a = points_[s.a], &b = points_[s.b];
    if (inside(s)) border_length_ += std::hypot(b.x - a.x, b.y - a.y);
    largest = std::max(largest, split_tolerance(a, b));
    const long double cross = cross_extended(points_.front(), a, b);
    of_faces[s.left_face].add(cross);
    of_faces[s.right_face].add(-cross);
  }
  border_tolerance_ = largest * border_length_ + 1e-14 * area_;
  for (const CompensatedSum& twice : of_faces) area_of_face_.push_back(twice.value() / 2);
}

std::map<double, double> Domain::areas_of_regions() const {
  std::map<double, double> areas;
  for (std::int32_t face = 0; face < face_count(); ++face) {
    const Pslg::Region* const region = region_of(face);
    if (inside(face)) areas[region != nullptr ? region->attribute : 0] += area(face);
  }
  return areas;
}

// Each of two coordinates of a midpoint is rounded by half a unit in the last place; nested midpoints add up to a
// dozen such units at the greatest depth.
double Domain::split_tolerance(const Point& a, const Point& b) {
  const double magnitude = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  return 32 * 0x1p-52 * magnitude;
}

const Pslg::Region* Domain::region_of(std::int32_t face) const {
  const std::int32_t region = region_of_face_[face];
  return region == kNoRegion ? nullptr : &regions_[region];
}

}  // namespace driftmesh
