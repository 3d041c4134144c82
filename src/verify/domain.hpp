#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "verify/arrangement.hpp"

namespace driftmesh {

/// The part of the plane that an input asks to be meshed, from an arrangement of its segments: the faces that its
/// polygons cover (see FaceCover) or, without polygons, all but the unbounded face; those that hold a hole point are
/// carved, and, if asked for, every second face of rings within rings (see inside_of_alternating_rings). Duplicate
/// points and segments count once. Without segments, the domain is the convex hull of the points, with marker 1 on its
/// border.
class Domain {
 public:
  struct Segment {
    std::int32_t a = 0;  ///< index into points()
    std::int32_t b = 0;  ///< index into points()
    std::int32_t marker = 0;
    std::int32_t left_face = 0;   ///< to the left on the way a -> b
    std::int32_t right_face = 0;  ///< to the right on the way a -> b
  };

  /// `places` are located in the domain and have no part in it.
  explicit Domain(const Pslg& input, HoleRule holes = HoleRule::kPoints, std::span<const Point> places = {});

  /// Why the input describes no domain (segments that cross, overlap or pass through points, polygons without
  /// segments), if so. If so, nothing below may be called.
  [[nodiscard]] const std::optional<std::string>& conflict() const { return conflict_; }

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

  [[nodiscard]] std::int32_t face_count() const { return static_cast<std::int32_t>(inside_.size()); }
  /// Arrangement::kOnBoundary if the place lies on a segment.
  [[nodiscard]] std::int32_t face_of_place(std::size_t place) const { return face_of_place_[place]; }
  [[nodiscard]] bool inside(std::int32_t face) const { return inside_[face] != 0; }
  [[nodiscard]] bool inside(const Segment& s) const { return inside(s.left_face) || inside(s.right_face); }
  /// Whether a point lies in the closed domain.
  [[nodiscard]] bool point_inside(std::int32_t point) const { return point_inside_[point] != 0; }

  [[nodiscard]] double area() const { return area_; }
  /// The area of a bounded face. This and what follows of areas is known if there are polygons.
  [[nodiscard]] double area(std::int32_t face) const { return area_of_face_[face]; }
  /// The areas of all regions of the domain by their attributes; where there is no region, that is 0.
  [[nodiscard]] std::map<double, double> areas_of_regions() const;
  /// By how much sums of areas may differ because split points on the boundary are rounded.
  [[nodiscard]] double area_tolerance() const { return area_tolerance_; }
  /// The same for the area of a part of the domain after repair, which rounds everywhere as at the largest coordinates.
  [[nodiscard]] double border_tolerance() const { return border_tolerance_; }
  /// The length of all segments in the domain, if there are polygons.
  [[nodiscard]] double border_length() const { return border_length_; }
  /// Vertices - edges + faces of any triangulation of the domain.
  [[nodiscard]] std::int64_t euler_number() const { return euler_number_; }
  /// How far a split point of a segment between these ends may be off the segment.
  [[nodiscard]] static double split_tolerance(const Point& a, const Point& b);

  [[nodiscard]] bool has_regions() const { return has_regions_; }
  /// The region of a face: that of the last seed in it, otherwise that of the last polygon with a region which covers
  /// it, or null.
  [[nodiscard]] const Pslg::Region* region_of(std::int32_t face) const;

 private:
  void take_points(const Pslg& input, std::vector<std::int32_t>& number);
  void take_segments(const Pslg& input, const std::vector<std::int32_t>& number);
  void take_polygons(const Pslg& input, const std::vector<std::int32_t>& number);
  [[nodiscard]] bool has_segment(std::int32_t a, std::int32_t b) const;
  void take_hull();
  void classify(const Pslg& input, HoleRule holes, const Arrangement& arrangement);
  void find_regions(const Pslg& input, const Arrangement& arrangement);
  void measure(const Arrangement& arrangement);
  void measure_faces();

  std::optional<std::string> conflict_;
  std::vector<Point> points_;
  std::vector<Segment> segments_;        // ascending by their ends, a < b, if there are polygons
  std::vector<Pslg::Polygon> polygons_;  // rings are indices into points_
  std::vector<std::int32_t> face_of_place_;
  std::vector<double> area_of_face_;
  std::vector<char> inside_;        // per face
  std::vector<char> point_inside_;  // per point
  std::vector<Pslg::Region> regions_;
  std::vector<std::int32_t> region_of_face_;  // -1: none
  bool has_regions_ = false;
  double area_ = 0;
  double area_tolerance_ = 0;
  double border_tolerance_ = 0;
  double border_length_ = 0;
  std::int64_t euler_number_ = 0;
};

}  // namespace driftmesh
