#include "driftmesh/close_channels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/segment_geometry.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/areas.hpp"
#include "mesh/cdt.hpp"
#include "mesh/outline_samples.hpp"
#include "pslg/keep_points.hpp"
#include "pslg/polygons.hpp"

namespace driftmesh {
namespace {

constexpr double kSpacing = 1.0 / 8;  // between samples, relative to the width
constexpr double kDetour = 2;         // a line that saves less of the way along the shore crosses no channel

/// How far it is along the outline of a triangulation from one end of an edge to the other.
class Shore {
 public:
  explicit Shore(const Triangulation& mesh) : mesh_(mesh), at_(4 * mesh.triangles.size(), Place{kNone, 0}) {
    for (const TriangleId t : ids_of(mesh.triangles))
      for (int i = 0; mesh.triangles[t].alive() && i < 3; ++i)
        if (const HalfEdge h = half_edge(t, i); mesh.across(h) == kNone && at_[to_index(h)].ring == kNone)
          follow_ring(h);
  }

  /// Along the shorter way; infinite between two rings.
  [[nodiscard]] double way_between_ends(HalfEdge h) const {
    const Place from = place_of_start(h), to = place_of_start(mesh_.across(h));
    if (from.ring != to.ring) return HUGE_VAL;
    const double way = std::fabs(from.along - to.along);
    return std::min(way, lengths_[to_index(from.ring)] - way);
  }

  /// The next bank behind the end of a bank, or of any edge on its left side.
  [[nodiscard]] HalfEdge next_bank(HalfEdge h) const {
    for (h = following(h); mesh_.across(h) != kNone;) h = following(mesh_.across(h));
    return h;
  }

  [[nodiscard]] static HalfEdge following(HalfEdge h) { return half_edge(triangle_of(h), next(index_of(h))); }

 private:
  struct Place {
    std::int32_t ring;
    double along;
  };

  void follow_ring(HalfEdge first) {
    const auto ring = static_cast<std::int32_t>(lengths_.size());
    double along = 0;
    HalfEdge h = first;
    do {
      at_[to_index(h)] = {ring, along};
      along += std::sqrt(squared_distance(mesh_.points[mesh_.edge_start(h)], mesh_.points[mesh_.edge_end(h)]));
      h = next_bank(h);
    } while (h != first);
    lengths_.push_back(along);
  }

  /// A point where rings touch is at several places: at that between the banks beside the edge.
  [[nodiscard]] Place place_of_start(HalfEdge h) const { return at_[to_index(next_bank(mesh_.across(h)))]; }

  const Triangulation& mesh_;
  std::vector<Place> at_;  // by bank: its start
  std::vector<double> lengths_;
};

/// Finds triangles by the points in them.
class TriangleFinder {
 public:
  explicit TriangleFinder(const Triangulation& mesh) : mesh_(mesh) {
    std::vector<Box> boxes;
    for (const TriangleId t : ids_of(mesh.triangles))
      boxes.push_back(mesh.triangles[t].alive() ? Box::of(corners(t)) : Box{});
    tree_ = BoxTree(boxes);
  }

  /// kNone: the point is outside.
  [[nodiscard]] TriangleId find(const Point& p) const {
    TriangleId found{kNone};
    tree_.visit_containing(p, [&](std::int32_t i) {
      if (found == kNone && contains(corners(TriangleId{i}), p)) found = TriangleId{i};
    });
    return found;
  }

 private:
  [[nodiscard]] CornerPoints corners(TriangleId t) const {
    return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
  }

  const Triangulation& mesh_;
  BoxTree tree_;
};

/// The triangles between the samples of an outline, those of which are to be filled, and the gaps.
class Channels {
 public:
  Channels(const OutlineSamples& outline, double width)
      : outline_(outline),
        width_(width),
        mesh_(outline.triangulated()),
        narrow_(4 * mesh_.triangles.size()),
        filled_(mesh_.triangles.size()),
        part_(mesh_.triangles.size()) {
    const Shore shore(mesh_);
    for (const TriangleId t : mesh_ids())
      for (int i = 0; i < 3; ++i)
        narrow_[to_index(half_edge(t, i))] = is_narrow(mesh_, shore, half_edge(t, i), width) ? 1 : 0;
    for (const TriangleId t : mesh_ids()) filled_[t] = is_inside_channel(t) ? 1 : 0;
    for (const TriangleId t : mesh_ids())
      for (int i = 0; i < 3; ++i)
        if (const HalfEdge h = half_edge(t, i); is_open(h)) part_.join(t, triangle_of(mesh_.across(h)));
  }

  [[nodiscard]] bool any() const { return std::ranges::find(narrow_, 1) != narrow_.end(); }

  /// Parts that are cut off and in which no disk of the width has room are filled, too.
  void fill_small_parts() {
    const TriangleFinder finder(mesh_);
    std::map<TriangleId, bool> cut;  // parts, and whether they have room
    for (const TriangleId t : mesh_ids())
      for (int i = 0; i < 3; ++i)
        if (filled_[t] == 0 && narrow_[to_index(half_edge(t, i))] != 0) cut.emplace(part_.find(t), false);
    for (const TriangleId t : mesh_ids())
      if (const auto part = cut.find(part_.find(t)); part != cut.end() && !part->second)
        part->second = filled_[t] == 0 && has_room(t, finder);
    for (const TriangleId t : mesh_ids())
      if (const auto part = cut.find(part_.find(t)); part != cut.end() && !part->second) filled_[t] = 1;
  }

  [[nodiscard]] const Triangulation& mesh() const { return mesh_; }
  [[nodiscard]] bool is_filled(TriangleId t) const { return filled_[t] != 0; }
  [[nodiscard]] TriangleId part_of(TriangleId t) { return part_.find(t); }
  [[nodiscard]] std::vector<TriangleId> mesh_ids() const {
    std::vector<TriangleId> ids;
    for (const TriangleId t : ids_of(mesh_.triangles))
      if (mesh_.triangles[t].alive()) ids.push_back(t);
    return ids;
  }

  enum class Side { kOpen, kBank, kCut, kGap };
  /// What an edge of a triangle that is not filled is to it.
  [[nodiscard]] Side side(HalfEdge h) const {
    const HalfEdge g = mesh_.across(h);
    if (g == kNone) return Side::kBank;
    if (is_filled(triangle_of(g))) return Side::kCut;
    return narrow_[to_index(h)] != 0 ? Side::kGap : Side::kOpen;
  }

 private:
  [[nodiscard]] bool is_open(HalfEdge h) const {
    return mesh_.across(h) != kNone && filled_[triangle_of(h)] == filled_[triangle_of(mesh_.across(h))] &&
           (is_filled(triangle_of(h)) || narrow_[to_index(h)] == 0);
  }

  /// Whether an edge runs across a channel: it is short, and the way along the shore is not.
  [[nodiscard]] static bool is_narrow(const Triangulation& mesh, const Shore& shore, HalfEdge h, double width) {
    if (mesh.across(h) == kNone) return false;
    const double squared = squared_distance(mesh.points[mesh.edge_start(h)], mesh.points[mesh.edge_end(h)]);
    return squared < width * width && shore.way_between_ends(h) > kDetour * std::sqrt(squared);
  }

  [[nodiscard]] bool is_inside_channel(TriangleId t) const {
    bool leads_on = false;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = half_edge(t, i);
      if (mesh_.across(h) == kNone) continue;
      if (narrow_[to_index(h)] == 0) return false;
      leads_on = true;
    }
    return leads_on;
  }

  /// Whether the disk around one of some points that are likely centers has room there.
  [[nodiscard]] bool has_room(TriangleId t, const TriangleFinder& finder) {
    const Point &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
    for (const Point& p :
         {circumcenter(a, b, c), centroid({a, b, c}), midpoint(a, b), midpoint(b, c), midpoint(c, a)}) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !is_far(p)) continue;
      const TriangleId around = finder.find(p);
      if (around != kNone && part_.find(around) == part_.find(t)) return true;
    }
    return false;
  }

  /// From all banks, by half of the width; a bit less, since banks bend between samples.
  [[nodiscard]] bool is_far(const Point& p) {
    if (!pieces_) {
      std::vector<Box> boxes;
      for (const auto& piece : outline_.pieces())
        boxes.push_back(Box::around(outline_.points()[piece.from], outline_.points()[piece.to]));
      pieces_.emplace(boxes);
    }
    constexpr double kSlack = 0.98;
    const double most = kSlack * kSlack * width_ * width_ / 4;
    bool is_near = false;
    pieces_->search([&](const Box& box) { return !is_near && box.squared_distance(p) < most; },
                    [&](std::int32_t i) {
                      const auto& piece = outline_.pieces()[i];
                      is_near = is_near || squared_distance_to_segment(p, outline_.points()[piece.from],
                                                                       outline_.points()[piece.to]) < most;
                    });
    return !is_near;
  }

  const OutlineSamples& outline_;
  double width_;
  Triangulation mesh_;
  std::vector<char> narrow_;  // by half-edge
  IdVector<TriangleId, char> filled_;
  DisjointSets<TriangleId> part_;
  std::optional<BoxTree> pieces_;
};

/// A domain without its channels, from the domain with them.
class Rest {
 public:
  Rest(const Pslg& before, const Triangulation& domain, const OutlineSamples& outline, Channels& channels)
      : before_(before), domain_(domain), outline_(outline), channels_(channels), finder_(channels.mesh()) {
    measure_filled();
    number_points();
    take_constraints();
    trace_rings();
  }

  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double area() const { return area_; }

  /// As repair() leaves it; `original`: for each point its index before, or -1.
  [[nodiscard]] Pslg finished(const std::string& file, std::vector<std::int32_t>& original) {
    const RepairReport repaired = repair(rest_, file);
    const std::vector<bool> of_rings = segments_of_rings(rest_);
    std::vector<bool> gone(rest_.points.size(), true);
    std::vector<Pslg::Segment> kept;
    for (const std::int32_t i : first_ids<std::int32_t>(rest_.segments.size())) {
      const Pslg::Segment& s = rest_.segments[i];
      if (!of_rings[to_index(i)] && !stays(midpoint(rest_.points[s.a], rest_.points[s.b]))) continue;
      gone[to_index(s.a)] = gone[to_index(s.b)] = false;
      kept.push_back(s);
    }
    rest_.segments = std::move(kept);
    for (const std::int32_t i : first_ids<std::int32_t>(rest_.points.size())) {
      const std::int32_t point = repaired.original_point[i];
      if (point >= 0 && point < count_before() && !ends_segment_[to_index(point)] && stays(rest_.points[i]))
        gone[to_index(i)] = false;
    }
    original.clear();
    for (const std::int32_t i : keep_points(rest_, gone)) {
      const std::int32_t point = repaired.original_point[i];
      original.push_back(point < count_before() ? point : kNone);
    }
    take_regions();
    return std::move(rest_);
  }

 private:
  /// Toward an edge between two triangles that stay, from both of its sides: in the place of a gap.
  struct Bridge {
    CornerPoints land;
    std::int32_t tip;  // the point
  };

  [[nodiscard]] std::int32_t count_before() const { return static_cast<std::int32_t>(before_.points.size()); }
  [[nodiscard]] const Triangulation& mesh() const { return channels_.mesh(); }

  // ---- What is filled ----

  void measure_filled() {
    DisjointSets<TriangleId> channels(mesh().triangles.size());
    for (const TriangleId t : channels_.mesh_ids()) {
      if (!channels_.is_filled(t)) continue;
      area_ += signed_area(mesh().corner(t, 0), mesh().corner(t, 1), mesh().corner(t, 2));
      for (int i = 0; i < 3; ++i)
        if (const HalfEdge g = mesh().across(half_edge(t, i)); g != kNone && channels_.is_filled(triangle_of(g)))
          channels.join(t, triangle_of(g));
    }
    std::map<TriangleId, std::map<std::int32_t, double>> lengths;  // of banks, by marker
    for (const TriangleId t : channels_.mesh_ids()) {
      if (!channels_.is_filled(t)) continue;
      auto& of_markers = lengths[channels.find(t)];
      for (int i = 0; i < 3; ++i)
        if (const HalfEdge h = half_edge(t, i); mesh().across(h) == kNone)
          of_markers[marker_of(h)] +=
              std::sqrt(squared_distance(mesh().points[mesh().edge_start(h)], mesh().points[mesh().edge_end(h)]));
    }
    count_ = static_cast<std::int64_t>(lengths.size());
    marker_of_filled_ = IdVector<TriangleId, std::int32_t>(mesh().triangles.size());
    for (const TriangleId t : channels_.mesh_ids())
      if (channels_.is_filled(t)) {
        const auto& of_markers = lengths[channels.find(t)];
        marker_of_filled_[t] = std::ranges::max_element(of_markers, {}, [](const auto& m) { return m.second; })->first;
      }
  }

  [[nodiscard]] const OutlineSamples::Piece& piece_of(HalfEdge h) const {
    return outline_.pieces()[mesh().roots[mesh().subsegments[subsegment_of(mesh().twin(h))].root].marker];
  }
  [[nodiscard]] std::int32_t marker_of(HalfEdge h) const { return outline_.banks()[piece_of(h).bank].marker; }

  /// Whether a point is in what is left, and not on a bridge.
  [[nodiscard]] bool stays(const Point& p) const {
    const TriangleId t = finder_.find(p);
    if (t == kNone || channels_.is_filled(t)) return false;
    for (int i = 0; i < 3; ++i)
      if (const auto bridge = bridges_.find(half_edge(t, i)); bridge != bridges_.end())
        if (contains(bridge->second.land, p)) return false;
    return true;
  }

  // ---- Points ----

  [[nodiscard]] std::int32_t sample(VertexId v) const { return mesh().origin[v]; }

  void number_points() {
    rest_.points = before_.points;
    rest_.point_markers = before_.point_markers;
    rest_.attributes = before_.attributes;
    rest_.attributes_per_point = before_.attributes_per_point;
    rest_.names = before_.names;
    rest_.first_number = before_.first_number;
    number_.assign(outline_.points().size(), kNone);
    for (const std::int32_t i : first_ids<std::int32_t>(number_.size())) number_[i] = outline_.original(i);
    for (const TriangleId t : channels_.mesh_ids()) {
      if (channels_.is_filled(t)) continue;
      for (int i = 0; i < 3; ++i) {
        const HalfEdge h = half_edge(t, i);
        const Channels::Side side = channels_.side(h);
        if (side != Channels::Side::kCut && side != Channels::Side::kGap) continue;
        for (const VertexId v : {mesh().edge_start(h), mesh().edge_end(h)}) need(sample(v));
        if (side == Channels::Side::kGap) add_bridge(h);
      }
    }
  }

  /// A new point if it is not one of the input.
  void need(std::int32_t i) {
    if (number_[i] != kNone) return;
    const Bank& bank = outline_.banks()[outline_.banks_at(i)[0]];
    number_[i] = add_point(outline_.points()[i], bank.a, bank.b,
                           nearest_on_segment(outline_.points()[i], before_.points[bank.a], before_.points[bank.b]),
                           bank.marker);
  }

  /// Attributes are interpolated between two points.
  std::int32_t add_point(const Point& p, std::int32_t a, std::int32_t b, double part, std::int32_t marker) {
    rest_.points.push_back(p);
    if (!rest_.point_markers.empty()) rest_.point_markers.push_back(marker);
    const auto stride = to_index(rest_.attributes_per_point);
    for (std::size_t k = 0; k < stride; ++k) {
      const double at_a = rest_.attributes[to_index(a) * stride + k], at_b = rest_.attributes[to_index(b) * stride + k];
      rest_.attributes.push_back(at_a + part * (at_b - at_a));
    }
    return static_cast<std::int32_t>(rest_.points.size()) - 1;
  }

  void add_bridge(HalfEdge h) {
    constexpr double kThick = 0.25, kMost = 0.3;  // relative to the gap, and to the height of the triangle
    const VertexId u = mesh().edge_start(h), v = mesh().edge_end(h);
    const Point &a = mesh().points[u], &b = mesh().points[v], &apex = mesh().points[mesh().apex(h)];
    const Point middle = midpoint(a, b);
    const double part = std::min(kMost, kThick * std::sqrt(squared_distance(a, b) / squared_distance(middle, apex)));
    const Point tip{middle.x + part * (apex.x - middle.x), middle.y + part * (apex.y - middle.y)};
    area_ += signed_area(a, b, tip);
    if (to_int(h) < to_int(mesh().across(h))) ++count_;
    const std::int32_t number = add_point(tip, number_[sample(u)], number_[sample(v)], 0.5, marker_at(u, v));
    bridges_.emplace(h, Bridge{{a, b, tip}, number});
  }

  [[nodiscard]] std::int32_t marker_at(VertexId u, VertexId v) const {
    std::int32_t least = INT32_MAX;
    for (const VertexId end : {u, v})
      for (const std::int32_t bank : outline_.banks_at(sample(end)))
        least = std::min(least, outline_.banks()[bank].marker);
    return least;
  }

  // ---- Segments ----

  void take_constraints() {
    ends_segment_.assign(before_.points.size(), false);
    for (const RootSegment& root : domain_.roots) {
      const std::int32_t a = domain_.origin[root.vertex[0]], b = domain_.origin[root.vertex[1]];
      ends_segment_[to_index(a)] = ends_segment_[to_index(b)] = true;
      const auto& half = domain_.subsegments[root.tree].half;
      if (half[0] != kNone && half[1] != kNone) rest_.segments.push_back({a, b, root.marker});
    }
  }

  /// Around each part, the outer ring first.
  void trace_rings() {
    std::vector<char> seen(4 * mesh().triangles.size());
    std::map<TriangleId, Pslg::Polygon> polygons;
    for (const TriangleId t : channels_.mesh_ids()) {
      if (channels_.is_filled(t)) continue;
      for (int i = 0; i < 3; ++i) {
        const HalfEdge h = half_edge(t, i);
        if (seen[to_index(h)] != 0 || channels_.side(h) == Channels::Side::kOpen) continue;
        Pslg::Polygon& polygon = polygons[channels_.part_of(t)];
        polygon.rings.push_back(ring_from(h, seen));
        if (is_counterclockwise(polygon.rings.back())) std::swap(polygon.rings.front(), polygon.rings.back());
      }
    }
    for (auto& [part, polygon] : polygons) rest_.polygons.push_back(std::move(polygon));
  }

  /// The ring of a part to its left, with segments along it. Samples that are not needed are passed over.
  Pslg::Ring ring_from(HalfEdge first, std::vector<char>& seen) {
    Pslg::Ring ring;
    std::vector<std::int32_t> markers;  // behind each corner
    HalfEdge h = first;
    do {
      seen[to_index(h)] = 1;
      const std::int32_t from = number_[sample(mesh().edge_start(h))], marker = marker_along(h);
      if (from != kNone) {
        ring.push_back(from);
        markers.push_back(marker);
      }
      if (const auto bridge = bridges_.find(h); bridge != bridges_.end()) {
        ring.push_back(bridge->second.tip);
        markers.push_back(marker);
      }
      for (h = Shore::following(h); channels_.side(h) == Channels::Side::kOpen;) h = Shore::following(mesh().across(h));
    } while (h != first);
    for (std::size_t i = 0; i < ring.size(); ++i)
      rest_.segments.push_back({ring[i], ring[(i + 1) % ring.size()], markers[i]});
    return ring;
  }

  [[nodiscard]] std::int32_t marker_along(HalfEdge h) const {
    if (mesh().across(h) == kNone) return marker_of(h);
    const TriangleId beyond = triangle_of(mesh().across(h));
    return channels_.is_filled(beyond) ? marker_of_filled_[beyond]
                                       : marker_at(mesh().edge_start(h), mesh().edge_end(h));
  }

  [[nodiscard]] bool is_counterclockwise(const Pslg::Ring& ring) const {
    double area = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      area += signed_area(rest_.points[ring[0]], rest_.points[ring[i]], rest_.points[ring[i + 1]]);
    return area > 0;
  }

  /// Seeds in all areas of the rest that were in a region; those of the input where they still are in one.
  void take_regions() {
    if (domain_.region.empty() || rest_.polygons.empty()) return;
    const Triangulation mesh = triangulate(rest_);
    const Areas areas(mesh);
    const TriangleFinder now(mesh), before(domain_);
    std::map<AreaId, Pslg::Region> regions;
    for (const AreaId area : areas.ids()) {
      const Point at = center_of(mesh, areas.largest(area));
      const TriangleId t = before.find(at);
      if (t == kNone || domain_.region[t] == 0) continue;
      Pslg::Region& region = regions[area] = before_.regions[to_index(domain_.region[t]) - 1];
      const TriangleId seeded = now.find(region.at);
      if (seeded == kNone || areas.of(seeded) != area) region.at = at;
    }
    for (const auto& [area, region] : regions) rest_.regions.push_back(region);
  }

  const Pslg& before_;
  const Triangulation& domain_;
  const OutlineSamples& outline_;
  Channels& channels_;
  TriangleFinder finder_;
  std::int64_t count_ = 0;
  double area_ = 0;
  IdVector<TriangleId, std::int32_t> marker_of_filled_;
  std::vector<std::int32_t> number_;  // of samples: in the rest; kNone: not needed
  std::vector<bool> ends_segment_;    // by point of the input
  std::map<HalfEdge, Bridge> bridges_;
  Pslg rest_;
};

/// Returns the domain without the channels that are found at first sight.
Pslg filled_once(const Pslg& before, const Triangulation& domain, const OutlineSamples& outline, Channels& channels,
                 const std::string& file, ClosedChannels& closed) {
  channels.fill_small_parts();
  Rest rest(before, domain, outline, channels);
  closed.channels += rest.count();
  closed.area += rest.area();
  std::vector<std::int32_t> original;
  Pslg finished = rest.finished(file, original);
  for (std::int32_t& point : original) point = point < 0 ? point : closed.original_point[to_index(point)];
  closed.original_point = std::move(original);
  return finished;
}

}  // namespace

ClosedChannels close_channels(Pslg& pslg, double width, const std::string& file) {
  if (!(width > 0) || !std::isfinite(width))
    throw Error(formatted("the width of channels to close must be a positive length, but is {}", width));
  constexpr int kMostPasses = 100;  // two or three are common
  ClosedChannels closed;
  closed.original_point.resize(pslg.points.size());
  std::iota(closed.original_point.begin(), closed.original_point.end(), 0);
  Pslg rest = pslg;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Triangulation domain = triangulate(rest);
    const OutlineSamples outline(rest.points, banks_of(domain), width, kSpacing * width);
    Channels channels(outline, width);
    if (!channels.any()) break;
    rest = filled_once(rest, domain, outline, channels, file, closed);
    closed.parts = static_cast<std::int64_t>(rest.polygons.size());
    if (closed.parts == 0)
      throw InputError({file, 0}, "all of it is narrower than the width up to which channels are closed",
                       "give a smaller width");
  }
  pslg = std::move(rest);
  return closed;
}

}  // namespace driftmesh
