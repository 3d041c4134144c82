#include "verify/face_cover.hpp"

#include <algorithm>
#include <compare>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

/// A ring that changes sides at a link.
struct Change {
  std::int32_t link = 0;
  std::int32_t polygon = 0;
  std::int32_t ring = 0;
  friend auto operator<=>(const Change&, const Change&) = default;
};

/// The links between two points.
class LinkFinder {
 public:
  explicit LinkFinder(const std::vector<Arrangement::Link>& links) {
    for (const std::int32_t link : first_ids<std::int32_t>(links.size()))
      entries_.push_back({std::minmax({links[link].a, links[link].b}), link});
    std::ranges::sort(entries_);
  }
  [[nodiscard]] std::int32_t find(std::int32_t a, std::int32_t b) const {
    return std::ranges::lower_bound(entries_, std::pair<std::int32_t, std::int32_t>(std::minmax(a, b)), {},
                                    &Entry::ends)
        ->link;
  }

 private:
  struct Entry {
    std::pair<std::int32_t, std::int32_t> ends;
    std::int32_t link;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  std::vector<Entry> entries_;
};

/// All changes, by link: of what a ring walks twice, none are left.
std::vector<Change> changes_of(const Arrangement& arrangement, std::span<const Pslg::Polygon> polygons) {
  const LinkFinder links(arrangement.links());
  std::vector<Change> all, odd;
  for (const std::int32_t p : first_ids<std::int32_t>(polygons.size()))
    for (const std::int32_t r : first_ids<std::int32_t>(polygons[p].rings.size())) {
      const Pslg::Ring& ring = polygons[p].rings[r];
      for (std::size_t i = 0; i < ring.size(); ++i)
        all.push_back({links.find(ring[i], ring[(i + 1) % ring.size()]), p, r});
    }
  std::ranges::sort(all);
  for (auto change = all.begin(); change != all.end();) {
    const auto end = std::find_if(change, all.end(), [&](const Change& other) { return other != *change; });
    if ((end - change) % 2 == 1) odd.push_back(*change);
    change = end;
  }
  return odd;
}

/// The polygons around a place, which moves from face to face.
class Place {
 public:
  explicit Place(std::span<const Pslg::Polygon> polygons) : polygons_(polygons), holes_(polygons.size()) {
    for (const Pslg::Polygon& polygon : polygons) inside_.emplace_back(polygon.rings.size());
  }

  void change_sides(const Change& change) {
    const auto p = change.polygon;
    if (covers(p)) leave(p);
    char& inside = inside_[p][change.ring];
    inside = inside == 0 ? 1 : 0;
    if (change.ring > 0) holes_[p] += inside != 0 ? 1 : -1;
    if (covers(p)) enter(p);
  }

  [[nodiscard]] bool covered() const { return count_ > 0; }
  [[nodiscard]] std::int32_t region() const { return named_.empty() ? -1 : polygons_[*named_.rbegin()].region; }

 private:
  [[nodiscard]] bool covers(std::int32_t p) const { return inside_[p][0] != 0 && holes_[p] == 0; }
  void enter(std::int32_t p) {
    ++count_;
    if (polygons_[p].region >= 0) named_.insert(p);
  }
  void leave(std::int32_t p) {
    --count_;
    named_.erase(p);
  }

  std::span<const Pslg::Polygon> polygons_;
  std::vector<std::vector<char>> inside_;  // per ring
  std::vector<std::int32_t> holes_;        // around the place, of each polygon
  std::int32_t count_ = 0;                 // polygons that cover the place
  std::set<std::int32_t> named_;           // those of them that have a region
};

/// A walk from the unbounded face to all others and back, over as few links as there are faces.
class Walk {
 public:
  Walk(const Arrangement& arrangement, std::span<const Pslg::Polygon> polygons)
      : arrangement_(arrangement), changes_(changes_of(arrangement, polygons)), place_(polygons) {
    const auto faces = static_cast<std::size_t>(arrangement.face_count());
    first_.assign(faces + 1, 0);
    for (const std::int32_t link : links()) ++first_[left(link) + 1], ++first_[right(link) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    around_.resize(2 * arrangement.links().size());
    std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
    for (const std::int32_t link : links()) around_[next[left(link)]++] = around_[next[right(link)]++] = link;
  }

  template <class Visit>
  void run(const Visit& visit) {
    std::vector<char> seen(first_.size() - 1);
    std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
    struct Step {
      std::int32_t face, link;
    };
    std::vector<Step> way{{Arrangement::kUnbounded, -1}};
    seen[Arrangement::kUnbounded] = 1;
    visit(Arrangement::kUnbounded, place_);
    while (!way.empty()) {
      const auto [face, entry] = way.back();
      if (next[face] == first_[face + 1]) {
        way.pop_back();
        if (!way.empty()) cross(entry);
        continue;
      }
      const std::int32_t link = around_[next[face]++], other = left(link) == face ? right(link) : left(link);
      if (seen[other] != 0) continue;
      seen[other] = 1;
      cross(link);
      visit(other, place_);
      way.push_back({other, link});
    }
  }

 private:
  [[nodiscard]] IdRange<std::int32_t> links() const { return first_ids<std::int32_t>(arrangement_.links().size()); }
  [[nodiscard]] std::int32_t left(std::int32_t link) const { return arrangement_.left_face(link); }
  [[nodiscard]] std::int32_t right(std::int32_t link) const { return arrangement_.right_face(link); }

  void cross(std::int32_t link) {
    for (auto change = std::ranges::lower_bound(changes_, link, {}, &Change::link);
         change != changes_.end() && change->link == link; ++change)
      place_.change_sides(*change);
  }

  const Arrangement& arrangement_;
  std::vector<Change> changes_;
  Place place_;
  std::vector<std::int32_t> first_, around_;  // links by the faces on their sides
};

}  // namespace

FaceCover::FaceCover(const Arrangement& arrangement, std::span<const Pslg::Polygon> polygons)
    : covered_(arrangement.face_count()), region_(arrangement.face_count()) {
  Walk(arrangement, polygons).run([&](std::int32_t face, const Place& place) {
    covered_[face] = place.covered() ? 1 : 0;
    region_[face] = place.region();
  });
}

}  // namespace driftmesh
