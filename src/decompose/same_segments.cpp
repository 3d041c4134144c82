#include "decompose/same_segments.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/formatted.hpp"
#include "decompose/same_input.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/predicates.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh {
namespace {

/// A root along which a chain leads, from its start to its end.
struct Link {
  GlobalRootId root{};
  bool ascending = true;  // in the root's direction
};

/// Roots from one vertex of the domain to another.
struct Chain {
  std::vector<GlobalPointId> points;  // one more than links
  std::vector<Link> links;
};

/// A part of a shell piece of the domain: its shell, and the part's heap index from the start of the piece on.
using ShellPart = std::pair<std::int32_t, std::uint64_t>;
constexpr std::uint64_t kWhole = 1, kDeepest = std::uint64_t{1} << 60;

/// Names of shells (of parts that are roots) and of circles (in the middle of parts that are halved).
struct ShellNames {
  std::map<std::int32_t, ShellPart> shells, circles;

  /// Whether no name stands for two parts.
  [[nodiscard]] bool agrees_with(const ShellNames& others) const {
    const auto agree = [](const auto& own, const auto& known) {
      return std::all_of(own.begin(), own.end(), [&](const auto& entry) {
        const auto found = known.find(entry.first);
        return found == known.end() || found->second == entry.second;
      });
    };
    return agree(shells, others.shells) && agree(circles, others.circles);
  }
  void add(const ShellNames& others) {
    shells.insert(others.shells.begin(), others.shells.end());
    circles.insert(others.circles.begin(), others.circles.end());
  }
};

class SegmentCheck {
 public:
  SegmentCheck(const Decomposition& d, const Triangulation& domain, const std::string& file)
      : d_(d),
        domain_(domain),
        file_(file),
        roots_at_(d.points.size()),
        vertex_of_(d.points.size(), kNone),
        seen_(d.roots.size(), false) {}

  void run() {
    match_points();
    for (const GlobalRootId r : ids_of(d_.roots)) check_kind(r);
    for (const GlobalPointId v : ids_of(d_.points))
      if (vertex_of_[v] != kNone)
        for (const GlobalRootId r : roots_at_[v])
          if (!seen_[r]) check_chain(chain_from(v, r));
    for (const GlobalRootId r : ids_of(d_.roots))
      if (!d_.roots[r].separator && !seen_[r]) refuse_root(r, "is on no segment of the input");
    for (const RootId root : ids_of(domain_.roots))
      if (in_domain(root) && !found_.contains(ends_of(root))) refuse(": a segment" + words(root) + " is missing");
    check_inner_points();
  }

 private:
  using Ends = std::pair<VertexId, VertexId>;

  [[noreturn]] void refuse(const std::string& why) const { refuse_as_another(file_, why); }
  [[noreturn]] void refuse_root(GlobalRootId r, const std::string& what) const {
    refuse(": its root " + to_string(r) + " " + what);
  }
  static std::string place(const Point& p) { return formatted(" ({}, {})", p.x, p.y); }
  [[nodiscard]] std::string words(RootId root) const {
    const auto& [a, b] = domain_.roots[root].vertex;
    return " from" + place(domain_.points[a]) + " to" + place(domain_.points[b]);
  }

  static Ends ascending(VertexId u, VertexId v) { return {std::min(u, v), std::max(u, v)}; }
  [[nodiscard]] Ends ends_of(RootId root) const {
    return ascending(domain_.roots[root].vertex[0], domain_.roots[root].vertex[1]);
  }
  [[nodiscard]] const Subsegment& leaf(RootId root) const { return domain_.subsegments[domain_.roots[root].tree]; }
  [[nodiscard]] bool in_domain(RootId root) const { return leaf(root).half[0] != kNone || leaf(root).half[1] != kNone; }

  /// Finds the vertex of each point that is one, by its bits and its origin.
  void match_points() {
    const auto key = [](const Point& p, VertexOrigin origin) {
      return std::tuple(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y), origin);
    };
    std::map<std::tuple<std::uint64_t, std::uint64_t, VertexOrigin>, VertexId> vertices;
    for (const VertexId v : ids_of(domain_.points))
      if (is_input(domain_.origin[v]) || is_shell_end(domain_.origin[v]))
        vertices.emplace(key(domain_.points[v], domain_.origin[v]), v);
    std::vector<bool> taken(domain_.points.size(), false);
    for (const GlobalPointId v : ids_of(d_.points)) {
      const auto found = vertices.find(key(d_.points[v], d_.origin[v]));
      if (found == vertices.end()) continue;
      if (taken[to_index(found->second)]) refuse(": its point " + to_string(v) + " is there twice");
      taken[to_index(found->second)] = true;
      vertex_of_[v] = found->second;
    }
    for (const Triangle& t : domain_.triangles)
      for (int i = 0; i < 3 && t.alive(); ++i)
        if (!taken[to_index(t.vertex[i])]) refuse(": the point" + place(domain_.points[t.vertex[i]]) + " is missing");
    for (const RootId root : ids_of(domain_.roots))
      if (in_domain(root)) root_between_.emplace(ends_of(root), root);
  }

  /// Separators carry nothing of the input's.
  void check_kind(GlobalRootId r) {
    const Decomposition::Root& root = d_.roots[r];
    if (!root.separator)
      for (const GlobalPointId v : {root.a, root.b}) roots_at_[v].push_back(r);
    else if (root.marker != 0 || root.shell != kNone)
      refuse_root(r, "is a separator with a marker or a shell");
  }

  [[nodiscard]] Chain chain_from(GlobalPointId v, GlobalRootId r) {
    Chain chain{{v}, {}};
    while (true) {
      if (seen_[r]) refuse_root(r, "is on no segment of the input");
      seen_[r] = true;
      const Decomposition::Root& root = d_.roots[r];
      chain.links.push_back({r, root.a == v});
      v = root.a == v ? root.b : root.a;
      chain.points.push_back(v);
      if (vertex_of_[v] != kNone) return chain;
      if (roots_at_[v].size() != 2) refuse_root(r, "ends where no segment of the input does");
      r = roots_at_[v][0] == r ? roots_at_[v][1] : roots_at_[v][0];
    }
  }

  void check_chain(Chain chain) {
    const Ends ends = ascending(vertex_of_[chain.points.front()], vertex_of_[chain.points.back()]);
    const auto found = root_between_.find(ends);
    if (found == root_between_.end() || !found_.emplace(ends, chain.links[0].root).second)
      refuse_root(chain.links[0].root, "is on no segment of the input");
    const RootSegment& segment = domain_.roots[found->second];
    if (vertex_of_[chain.points.front()] != segment.vertex[0]) reverse(chain);
    for (const Link& link : chain.links) check_sides(link, found->second);
    if (segment.shell == kNone)
      check_line(chain);
    else
      check_shell_piece(chain, segment.shell);
  }

  static void reverse(Chain& chain) {
    std::reverse(chain.points.begin(), chain.points.end());
    std::reverse(chain.links.begin(), chain.links.end());
    for (Link& link : chain.links) link.ascending = !link.ascending;
  }

  void check_sides(const Link& link, RootId segment) const {
    const Decomposition::Root& root = d_.roots[link.root];
    if (root.marker != domain_.roots[segment].marker)
      refuse_root(link.root, "has marker " + std::to_string(root.marker) + ", and the segment has " +
                                 std::to_string(domain_.roots[segment].marker));
    for (const bool left : {true, false}) {
      const HalfEdge half = leaf(segment).half[left ? 0 : 1];
      const bool of_left = left == link.ascending;
      const SubdomainId subdomain = of_left ? root.left : root.right;
      const std::uint16_t region = of_left ? root.left_region : root.right_region;
      if ((subdomain == kNoSubdomain) != (half == kNone)) refuse_root(link.root, "has the domain on another side");
      const std::uint16_t expected = half == kNone || domain_.region.empty() ? 0 : domain_.region[triangle_of(half)];
      if (region != expected)
        refuse_root(link.root,
                    "lies at region " + std::to_string(region) + ", and the segment at " + std::to_string(expected));
    }
  }

  /// Points between the ends of a straight segment: anywhere on it, but for rounding.
  void check_line(const Chain& chain) const {
    const Point &a = d_.points[chain.points.front()], &b = d_.points[chain.points.back()];
    const double length = std::sqrt(squared_distance(a, b));
    const double magnitude = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
    const double tolerance = 32 * 0x1p-52 * magnitude;  // some units in the last place for each of a few nested cuts
    double before = 0;
    for (std::size_t i = 0; i < chain.links.size(); ++i) {
      const GlobalRootId r = chain.links[i].root;
      if (d_.roots[r].shell != kNone) refuse_root(r, "has a shell, and the segment has none");
      if (i == 0) continue;
      const GlobalPointId v = chain.points[i];
      const double dx = d_.points[v].x - a.x, dy = d_.points[v].y - a.y;
      const double off = (dx * (b.y - a.y) - dy * (b.x - a.x)) / length;
      const double along = (dx * (b.x - a.x) + dy * (b.y - a.y)) / length;
      if (!(std::fabs(off) <= tolerance) || !(along > before) || !(along < length))
        refuse(": its point " + to_string(v) + place(d_.points[v]) + " is not on its segment");
      if (d_.origin[v] != kNone) refuse(": its point " + to_string(v) + " has a wrong origin");
      before = along;
    }
  }

  /// Pieces of one shell are halved alike, named alike, and directed alike: away from their corner.
  void check_shell_piece(const Chain& chain, std::int32_t shell) {
    ShellNames names;
    check_shell(chain, 0, chain.links.size(), {shell, kWhole}, names);
    for (const Link& link : chain.links)
      if (!link.ascending) refuse_root(link.root, "runs against its shell piece");
    if (!names.agrees_with(names_)) refuse_root(chain.links[0].root, "is on a shell whose pieces differ");
    names_.add(names);
  }

  /// Links [first, last) of a chain along a part of a shell piece: one, or two halves. Where a piece is halved, the
  /// halves are shells named c and c + 1, for a circle named c.
  void check_shell(const Chain& chain, std::size_t first, std::size_t last, const ShellPart& part,
                   ShellNames& names) const {
    if (last - first == 1) {
      const GlobalRootId r = chain.links[first].root;
      const std::int32_t name = d_.roots[r].shell;
      if ((part.second == kWhole && name != part.first) || !names.shells.emplace(name, part).second)
        refuse_root(r, "has a wrong shell");
      return;
    }
    const std::size_t cut = find_middle(chain, first, last);
    const VertexOrigin origin = d_.origin[chain.points[cut]];
    if (!is_shell_end(origin) || !names.circles.emplace(origin, part).second ||
        !halves_fit(chain, {first, cut, last}, origin))
      refuse(": its point " + to_string(chain.points[cut]) + " has a wrong origin, or the roots at it wrong shells");
    if (part.second >= kDeepest) refuse_root(chain.links[first].root, "is too short a part of a shell");
    check_shell(chain, first, cut, {part.first, 2 * part.second}, names);
    check_shell(chain, cut, last, {part.first, 2 * part.second + 1}, names);
  }

  [[nodiscard]] std::size_t find_middle(const Chain& chain, std::size_t first, std::size_t last) const {
    const Point middle = midpoint(d_.points[chain.points[first]], d_.points[chain.points[last]]);
    for (std::size_t cut = first + 1; cut < last; ++cut)
      if (d_.points[chain.points[cut]] == middle) return cut;
    refuse_root(chain.links[first].root, "ends neither where its shell piece does nor at a midpoint of it");
  }

  [[nodiscard]] bool halves_fit(const Chain& chain, const std::array<std::size_t, 3>& cuts, VertexOrigin circle) const {
    const std::int32_t name = circle - kShellEnd;
    std::array<std::int32_t, 2> shells{kNone, kNone};  // shells of the halves that are one root
    for (std::size_t half = 0; half < 2; ++half) {
      if (cuts[half + 1] - cuts[half] != 1) continue;
      shells[half] = d_.roots[chain.links[cuts[half]].root].shell;
      if (shells[half] != name && shells[half] != name + 1) return false;
    }
    return shells[0] != shells[1] || shells[0] == kNone;
  }

  void check_inner_points() const {
    IdVector<GlobalPointId, bool> placed(d_.points.size(), false);
    for (const Decomposition::Root& root : d_.roots) placed[root.a] = placed[root.b] = true;
    for (const SubdomainId s : ids_of(d_.subdomains))
      for (const GlobalPointId v : d_.inner_points_of(s)) {
        if (placed[v] || vertex_of_[v] == kNone || !lies_in(d_.points[v], s))
          refuse(": its point " + to_string(v) + " is not on its own in subdomain " + to_string(s));
        placed[v] = true;
      }
    for (const GlobalPointId v : ids_of(placed))
      if (!placed[v]) refuse(": its point " + to_string(v) + " is in no subdomain");
  }

  /// Whether a ray to the right crosses the subdomain's border an odd number of times.
  [[nodiscard]] bool lies_in(const Point& p, SubdomainId s) const {
    bool inside = false;
    for (const GlobalRootId r : d_.roots_of(s)) {
      const Decomposition::Root& root = d_.roots[r];
      if (root.left == root.right) continue;
      const Point &a = d_.points[root.a], &b = d_.points[root.b];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
    }
    return inside;
  }

  const Decomposition& d_;
  const Triangulation& domain_;
  const std::string& file_;
  IdVector<GlobalPointId, std::vector<GlobalRootId>> roots_at_;  // without separators
  IdVector<GlobalPointId, VertexId> vertex_of_;                  // in the domain; kNone between its vertices
  IdVector<GlobalRootId, bool> seen_;
  std::map<Ends, RootId> root_between_;
  std::map<Ends, GlobalRootId> found_;
  ShellNames names_;  // names in all pieces so far
};

}  // namespace

void require_same_segments(const Decomposition& decomposition, const Triangulation& domain, const std::string& file) {
  SegmentCheck(decomposition, domain, file).run();
}

}  // namespace driftmesh
