#include "mesh/domain_warnings.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

#include "geometry/triangle_geometry.hpp"
#include "pslg/describe.hpp"
#include "pslg/open_boundary.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMostMeetings = 3;

class Warnings {
 public:
  Warnings(const Pslg& pslg, const RepairReport& repairs)
      : pslg_(pslg), repairs_(repairs), open_ends_(find_open_boundary(pslg).open_ends) {}

  void add_dropped(const std::vector<std::int32_t>& dropped) {
    if (dropped.empty()) return;
    const std::string count =
        dropped.size() == 1 ? "1 segment bounds" : std::to_string(dropped.size()) + " segments bound";
    std::string text = count + " no part of the domain and " + (dropped.size() == 1 ? "is" : "are") + " left out";
    if (const auto end = open_end_of(dropped))
      text += ": the chain is open at " + name(*end) + gap_of(dropped);
    else
      text += ", the first at " + name(pslg_.segments[dropped[0]].a);
    all.push_back(text);
  }

  void add_meetings(const std::vector<CarveReport::Meeting>& meetings) {
    for (std::size_t i = 0; i < std::min(meetings.size(), kMostMeetings); ++i) add_meeting(meetings[i]);
    if (meetings.size() > kMostMeetings)
      all.push_back(std::to_string(meetings.size() - kMostMeetings) + " more regions are not separated from others");
  }

  void add_flaws(const std::vector<CarveReport::Flaw>& flaws) {
    for (const CarveReport::Flaw& flaw : flaws) all.push_back(words_of(flaw));
  }

  /// Rings of polygons have a meaning.
  void add_unexplained(const Triangulation& mesh, std::vector<VertexId> rings) {
    std::vector<bool> of_polygons(pslg_.points.size(), false);
    for (const Pslg::Polygon& polygon : pslg_.polygons)
      for (const Pslg::Ring& ring : polygon.rings)
        for (const std::int32_t corner : ring) of_polygons[corner] = true;
    std::erase_if(rings, [&](VertexId v) { return of_polygons[mesh.origin[v]]; });
    if (rings.empty()) return;
    const std::string count =
        rings.size() == 1 ? "1 closed ring" : std::to_string(rings.size()) + " groups of closed rings";
    all.push_back(
        count + " inside the domain, " + (rings.size() == 1 ? "" : "the first ") + "at " + name(mesh.origin[rings[0]]) +
        ", without a hole or region point inside: meshed through. For holes, add hole points or choose nested "
        "holes");
  }

  std::vector<std::string> all;

 private:
  [[nodiscard]] std::string name(std::int32_t point) const {
    return vertex_name(pslg_, repairs_.original_point[point], pslg_.points[point]);
  }

  [[nodiscard]] std::optional<std::int32_t> open_end_of(const std::vector<std::int32_t>& segments) const {
    for (const std::int32_t s : segments)
      for (const std::int32_t v : {pslg_.segments[s].a, pslg_.segments[s].b})
        if (std::binary_search(open_ends_.begin(), open_ends_.end(), v)) return v;
    return std::nullopt;
  }
  [[nodiscard]] std::string gap_of(const std::vector<std::int32_t>& segments) const {
    std::set<std::int32_t> ends;
    for (const std::int32_t s : segments) ends.insert({pslg_.segments[s].a, pslg_.segments[s].b});
    std::vector<std::int32_t> open;
    std::ranges::set_intersection(ends, open_ends_, std::back_inserter(open));
    const std::string gap = describe_gap(pslg_, open);
    return gap.empty() ? "" : "; " + gap;
  }

  [[nodiscard]] std::string words_of(const CarveReport::Flaw& flaw) const {
    using Kind = PolygonFlaw::Kind;
    const PolygonFlaw& what = flaw.what;
    const std::string polygon = polygon_name(pslg_, what.polygon), at = flaw.at ? " at " + coordinates(*flaw.at) : "";
    const std::string ring =
        what.ring == 0 ? "the first ring of " + polygon : "ring " + std::to_string(what.ring + 1) + " of " + polygon;
    switch (what.kind) {
      case Kind::kCrossesItself:
        return ring + " crosses itself; what it encloses an even number of times is outside it, for example" + at;
      case Kind::kRepeatsEdge:
        return ring + " runs more than once along one edge, which counts only if their number is odd," + at;
      case Kind::kSharesEdge:
        return ring + " shares an edge with " +
               (what.other == 0 ? "the first" : "ring " + std::to_string(what.other + 1)) + at;
      case Kind::kLeavesOuter:
        return "a hole of " + polygon + " reaches outside its first ring, where it removes nothing," + at;
      case Kind::kHolesOverlap:
        return "holes of " + polygon + " overlap" + at + "; both are removed";
      case Kind::kCoversNothing:
        return polygon + at + " covers no area";
      case Kind::kPartsOverlap:
        return "polygons of " + polygon + " overlap" + at + "; both are meshed";
      case Kind::kRegionsDiffer:
        return polygon_name(pslg_, what.other) + " and " + polygon + " overlap" + at +
               ", where the region is that of the latter";
    }
    return {};
  }

  /// The gap between two regions is where a chain of segments ends, most likely one near both.
  void add_meeting(const CarveReport::Meeting& meeting) {
    const Pslg::Region &first = pslg_.regions[meeting.first], &second = pslg_.regions[meeting.second];
    std::string text = "regions " + std::to_string(meeting.first + 1) + " at " + coordinates(first.at) + " and " +
                       std::to_string(meeting.second + 1) + " at " + coordinates(second.at) +
                       " lie in one area, which gets the label and the bound of the latter";
    double least = std::numeric_limits<double>::infinity();
    std::int32_t nearest = kNone;
    for (const std::int32_t v : open_ends_) {
      const double distance =
          squared_distance(pslg_.points[v], first.at) + squared_distance(pslg_.points[v], second.at);
      if (distance >= least) continue;
      least = distance;
      nearest = v;
    }
    if (nearest != kNone) text += "; a chain of segments is open at " + name(nearest);
    all.push_back(text);
  }

  const Pslg& pslg_;
  const RepairReport& repairs_;
  std::vector<std::int32_t> open_ends_;  // ascending
};

}  // namespace

std::vector<std::string> domain_warnings(const Pslg& pslg, const RepairReport& repairs, const CarveReport& report,
                                         const Triangulation& carved) {
  Warnings warnings(pslg, repairs);
  warnings.add_flaws(report.flaws);
  warnings.add_dropped(report.dropped);
  warnings.add_meetings(report.meetings);
  warnings.add_unexplained(carved, find_nested_rings(carved).unexplained);
  return std::move(warnings.all);
}

}  // namespace driftmesh
