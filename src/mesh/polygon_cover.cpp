#include "mesh/polygon_cover.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "base/narrow.hpp"
#include "pslg/segment_finder.hpp"

namespace driftmesh {
namespace {

using Kind = PolygonFlaw::Kind;

/// A ring of any polygon; those of one polygon follow each other, the first one first.
enum class RingId : std::int32_t {};

/// How a ring walks along a segment.
struct Walk {
  RingId ring;
  std::int32_t net = 0;    ///< how much more often from the segment's first point to its second than back
  std::int32_t times = 0;  ///< in both directions
};

/// All rings, and which of them walk along each segment.
class Walks {
 public:
  explicit Walks(const Pslg& pslg) : begin_(pslg.segments.size() + 1, 0) {
    const SegmentFinder finder(pslg);
    std::vector<std::pair<std::int32_t, Walk>> all;  // with their segments
    for (std::int32_t p = 0; p < narrow<std::int32_t>(pslg.polygons.size(), "polygons"); ++p) {
      first_ring_.push_back(polygon_.next_id());
      for (const Pslg::Ring& ring : pslg.polygons[p].rings) {
        add(pslg, finder, ring, polygon_.next_id(), all);
        polygon_.push_back(p);
      }
    }
    join(all);
  }

  [[nodiscard]] std::size_t rings() const { return polygon_.size(); }
  [[nodiscard]] std::int32_t polygon_of(RingId ring) const { return polygon_[ring]; }
  /// Which one of its polygon's rings it is.
  [[nodiscard]] std::int32_t place_of(RingId ring) const { return to_int(ring) - to_int(first_ring_[polygon_[ring]]); }
  [[nodiscard]] bool is_outer(RingId ring) const { return place_of(ring) == 0; }
  /// By their rings.
  [[nodiscard]] std::span<const Walk> along(std::int32_t segment) const {
    return std::span(walks_).subspan(begin_[segment], begin_[segment + 1] - begin_[segment]);
  }

 private:
  static void add(const Pslg& pslg, const SegmentFinder& finder, const Pslg::Ring& ring, RingId id,
                  std::vector<std::pair<std::int32_t, Walk>>& all) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::int32_t from = ring[i], to = ring[i + 1 == ring.size() ? 0 : i + 1];
      const std::int32_t segment = from == to ? -1 : finder.between(from, to);
      if (segment >= 0) all.push_back({segment, {id, pslg.segments[segment].a == from ? 1 : -1, 1}});
    }
  }

  /// Walks of one ring along one segment become one.
  void join(std::vector<std::pair<std::int32_t, Walk>>& all) {
    const auto key = [](const auto& w) { return std::pair(w.first, w.second.ring); };
    std::ranges::sort(all, {}, key);
    walks_.reserve(all.size());
    for (auto w = all.begin(); w != all.end(); ++w) {
      if (w != all.begin() && key(*w) == key(*std::prev(w))) {
        walks_.back().net += w->second.net;
        ++walks_.back().times;
        continue;
      }
      walks_.push_back(w->second);
      ++begin_[w->first + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  }

  std::vector<RingId> first_ring_;  // one for each polygon
  IdVector<RingId, std::int32_t> polygon_;
  std::vector<std::size_t> begin_;  // for each segment, where its part of walks_ begins; and the end
  std::vector<Walk> walks_;
};

/// The walls of each area that lead to others.
class Doors {
 public:
  Doors(const std::vector<Wall>& walls, std::size_t areas) : begin_(areas + 2, 0) {
    for (const Wall& wall : walls)
      if (wall.left != wall.right)
        for (const AreaId side : {wall.left, wall.right}) ++begin_[to_index(side) + 2];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    doors_.resize(begin_.back());
    for (std::size_t i = 0; i < walls.size(); ++i)
      if (walls[i].left != walls[i].right)
        for (const AreaId side : {walls[i].left, walls[i].right})
          doors_[begin_[to_index(side) + 1]++] = static_cast<std::int32_t>(i);
  }

  [[nodiscard]] std::span<const std::int32_t> of(AreaId area) const {
    const std::size_t begin = begin_[to_index(area)];
    return std::span(doors_).subspan(begin, begin_[to_index(area) + 1] - begin);
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> doors_;
};

/// Which polygons cover the place that a walk has come to.
class Membership {
 public:
  Membership(const Pslg& pslg, const Walks& walks)
      : pslg_(pslg),
        walks_(walks),
        winding_(walks.rings(), 0),
        holes_(pslg.polygons.size(), 0),
        outer_(pslg.polygons.size(), false) {}

  /// Steps across a segment, from its left to its right or back.
  void cross(std::int32_t segment, bool to_right) {
    for (const Walk& walk : walks_.along(segment)) {
      winding_[walk.ring] += to_right ? -walk.net : walk.net;
      if (walk.net % 2 != 0) toggle(walk.ring);
    }
  }

  [[nodiscard]] std::int32_t winding(RingId ring) const { return winding_[ring]; }
  [[nodiscard]] bool in_outer(std::int32_t polygon) const { return outer_[polygon]; }
  /// How many rings but the first have the place inside.
  [[nodiscard]] std::int32_t holes(std::int32_t polygon) const { return holes_[polygon]; }
  [[nodiscard]] bool covers(std::int32_t polygon) const { return outer_[polygon] && holes_[polygon] == 0; }
  [[nodiscard]] bool covered() const { return covering_ > 0; }
  /// The polygons that cover the place and have a region.
  [[nodiscard]] const std::set<std::int32_t>& with_regions() const { return with_regions_; }
  [[nodiscard]] bool regions_differ() const { return regions_.size() > 1; }
  /// The polygons of this feature that cover the place.
  [[nodiscard]] std::int32_t parts(std::int32_t feature) const {
    const auto known = features_.find(feature);
    return known == features_.end() ? 0 : known->second;
  }

 private:
  void toggle(RingId ring) {
    const std::int32_t polygon = walks_.polygon_of(ring);
    const bool before = covers(polygon), enters = winding_[ring] % 2 != 0;
    if (walks_.is_outer(ring))
      outer_[polygon] = enters;
    else
      holes_[polygon] += enters ? 1 : -1;
    if (covers(polygon) != before) note(polygon, !before);
  }

  void note(std::int32_t polygon, bool covers) {
    const Pslg::Polygon& p = pslg_.polygons[polygon];
    covering_ += covers ? 1 : -1;
    count(features_, p.feature, covers);
    if (p.region < 0) return;
    count(regions_, p.region, covers);
    if (covers)
      with_regions_.insert(polygon);
    else
      with_regions_.erase(polygon);
  }

  static void count(std::map<std::int32_t, std::int32_t>& counts, std::int32_t what, bool more) {
    const auto at = counts.try_emplace(what, 0).first;
    at->second += more ? 1 : -1;
    if (at->second == 0) counts.erase(at);
  }

  const Pslg& pslg_;
  const Walks& walks_;
  IdVector<RingId, std::int32_t> winding_;
  std::vector<std::int32_t> holes_;
  std::vector<bool> outer_;
  std::int64_t covering_ = 0;
  std::set<std::int32_t> with_regions_;
  std::map<std::int32_t, std::int32_t> regions_, features_;  // counts of the polygons that cover the place
};

/// Looks for flaws along the way, and names each once.
class FlawFinder {
 public:
  FlawFinder(const Pslg& pslg, const Walks& walks)
      : pslg_(pslg),
        walks_(walks),
        covers_(pslg.polygons.size(), false),
        lowest_(walks.rings(), 0),
        highest_(walks.rings(), 0) {
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(pslg.segments.size()); ++s) look_along(s);
  }

  /// After the membership `m` has come across a segment into an area.
  void look_at(const Membership& m, AreaId area, std::int32_t crossed) {
    for (const Walk& walk : walks_.along(crossed)) {
      const std::int32_t p = walks_.polygon_of(walk.ring), feature = pslg_.polygons[p].feature;
      note_winding(walk.ring, m.winding(walk.ring), area);
      if (m.covers(p)) covers_[p] = true;
      if (m.holes(p) > 0 && !m.in_outer(p)) add(p, {Kind::kLeavesOuter, p, 0, kNone, area});
      if (m.holes(p) > 1) add(p, {Kind::kHolesOverlap, p, 0, kNone, area});
      if (feature > 0 && m.covers(p) && m.parts(feature) > 1) add(feature, {Kind::kPartsOverlap, p, 0, kNone, area});
    }
    if (m.regions_differ()) note_regions(m, area);
  }

  [[nodiscard]] std::vector<PolygonFlaw> flaws() && {
    for (std::size_t p = 0; p < covers_.size(); ++p)
      if (!covers_[p]) flaws_.push_back({Kind::kCoversNothing, static_cast<std::int32_t>(p)});
    return std::move(flaws_);
  }

 private:
  void look_along(std::int32_t segment) {
    const Walk* before = nullptr;
    for (const Walk& walk : walks_.along(segment)) {
      const std::int32_t p = walks_.polygon_of(walk.ring), ring = walks_.place_of(walk.ring);
      if (walk.times > 1) add(to_int(walk.ring), {Kind::kRepeatsEdge, p, ring, kNone, kNone, segment});
      if (before != nullptr && walks_.polygon_of(before->ring) == p)
        add(p, {Kind::kSharesEdge, p, ring, walks_.place_of(before->ring), kNone, segment});
      before = &walk;
    }
  }

  /// A ring that crosses itself has places whose winding numbers differ by two.
  void note_winding(RingId ring, std::int32_t winding, AreaId area) {
    lowest_[ring] = std::min(lowest_[ring], winding);
    highest_[ring] = std::max(highest_[ring], winding);
    if (highest_[ring] - lowest_[ring] > 1)
      add(to_int(ring), {Kind::kCrossesItself, walks_.polygon_of(ring), walks_.place_of(ring), kNone, area});
  }

  void note_regions(const Membership& m, AreaId area) {
    const std::int32_t last = *m.with_regions().rbegin();
    if (known_.contains({Kind::kRegionsDiffer, last})) return;
    const auto other = std::find_if(m.with_regions().rbegin(), m.with_regions().rend(), [&](std::int32_t p) {
      return pslg_.polygons[p].region != pslg_.polygons[last].region;
    });
    add(last, {Kind::kRegionsDiffer, last, 0, *other, area});
  }

  /// Unless there is one of this kind for `what` already.
  void add(std::int32_t what, const PolygonFlaw& flaw) {
    if (known_.emplace(flaw.kind, what).second) flaws_.push_back(flaw);
  }

  const Pslg& pslg_;
  const Walks& walks_;
  std::vector<bool> covers_;                         // any area
  IdVector<RingId, std::int32_t> lowest_, highest_;  // winding numbers
  std::set<std::pair<Kind, std::int32_t>> known_;
  std::vector<PolygonFlaw> flaws_;
};

/// The walk over all areas, depth first.
class CoverWalk {
 public:
  CoverWalk(const Pslg& pslg, const std::vector<Wall>& walls, std::size_t areas)
      : pslg_(pslg), walls_(walls), doors_(walls, areas), walks_(pslg), here_(pslg, walks_), finder_(pslg, walks_) {
    cover_.inside.assign(areas, false);
    cover_.region.assign(areas, kNone);
  }

  PolygonCover run(AreaId outside) {
    IdVector<AreaId, bool> seen(cover_.inside.size(), false);
    seen[outside] = true;
    std::vector<Step> way{{outside, -1}};
    while (!way.empty()) {
      const AreaId area = way.back().area;
      const auto doors = doors_.of(area);
      if (way.back().next_door == doors.size()) {
        if (way.back().entrance >= 0) here_.cross(way.back().entrance, walls_[way.back().entrance].left == area);
        way.pop_back();
        continue;
      }
      const std::int32_t door = doors[way.back().next_door++];
      const AreaId next = walls_[door].left == area ? walls_[door].right : walls_[door].left;
      if (seen[next]) continue;
      seen[next] = true;
      here_.cross(door, walls_[door].left == area);
      decide(next, door);
      way.push_back({next, door});
    }
    cover_.flaws = std::move(finder_).flaws();
    return std::move(cover_);
  }

 private:
  struct Step {
    AreaId area;
    std::int32_t entrance;  // the segment across which it was entered; -1: none
    std::size_t next_door = 0;
  };

  void decide(AreaId area, std::int32_t entrance) {
    cover_.inside[area] = here_.covered();
    if (!here_.with_regions().empty()) cover_.region[area] = pslg_.polygons[*here_.with_regions().rbegin()].region;
    finder_.look_at(here_, area, entrance);
  }

  const Pslg& pslg_;
  const std::vector<Wall>& walls_;
  Doors doors_;
  Walks walks_;
  Membership here_;
  FlawFinder finder_;
  PolygonCover cover_;
};

}  // namespace

PolygonCover cover_by_polygons(const Pslg& pslg, const std::vector<Wall>& walls, std::size_t areas, AreaId outside) {
  return CoverWalk(pslg, walls, areas).run(outside);
}

}  // namespace driftmesh
