#include "decompose/further_cut.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// Roots are not broken into smaller intervals than these: there are ends enough, and depths of points add up.
constexpr int kMostHalvings = 4;

/// One subdomain as a domain of its own, whose roots are broken wherever a separator may end.
class Alone {
 public:
  struct Piece {
    std::size_t root;  ///< counts those of the subdomain
    dyadic::Path path;
  };

  Alone(const Decomposition& d, SubdomainId s, const SubdomainMesh& part) : d_(d), s_(s), part_(part) {
    list_points();
    add_roots();
    domain_.subdomains.push_back(d.subdomains[s]);
    list_roots(domain_);
    std::vector<std::pair<SubdomainId, GlobalPointId>> inner;
    for (const GlobalPointId v : d.inner_points_of(s)) inner.emplace_back(SubdomainId{0}, local(v));
    list_inner_points(domain_, std::move(inner));
  }

  [[nodiscard]] Triangulation mesh() const { return subdomain_triangulation(domain_, SubdomainId{0}).mesh; }
  [[nodiscard]] const Decomposition& domain() const { return domain_; }
  /// What each root of the domain is.
  [[nodiscard]] const IdVector<GlobalRootId, Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const FurtherCut::End& end(GlobalPointId v) const { return ends_[v]; }
  /// The midpoint of an interval of a root, which has one.
  [[nodiscard]] const FurtherCut::End& end_on(GlobalRootId root, dyadic::Path path) const {
    return ends_[midpoints_.at({root, path})];
  }
  [[nodiscard]] GlobalPointId local(GlobalPointId known) const {
    const auto known_end = ends_.begin() + static_cast<std::ptrdiff_t>(known_points_);
    const auto found = std::lower_bound(ends_.begin(), known_end, known,
                                        [](const FurtherCut::End& e, GlobalPointId v) { return e.known < v; });
    return static_cast<GlobalPointId>(found - ends_.begin());
  }

 private:
  void list_points() {
    for (const GlobalPointId v : points_of(d_, s_)) add_point({.known = v, .at = d_.points[v]}, d_.origin[v]);
    known_points_ = ends_.size();
  }

  GlobalPointId add_point(const FurtherCut::End& end, VertexOrigin origin) {
    ends_.push_back(end);
    domain_.points.push_back(end.at);
    domain_.origin.push_back(origin);
    return static_cast<GlobalPointId>(ends_.size() - 1);
  }

  void add_roots() {
    const auto roots = d_.roots_of(s_);
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const auto in_part = std::ranges::lower_bound(part_.roots, roots[i]) - part_.roots.begin();
      const Decomposition::Root& root = d_.roots[roots[i]];
      add_below(root, i, part_.mesh.roots[static_cast<RootId>(in_part)].tree, local(root.a), local(root.b));
    }
  }

  void add_below(const Decomposition::Root& root, std::size_t i, SubsegmentId s, GlobalPointId a, GlobalPointId b) {
    const Subsegment& node = part_.mesh.subsegments[s];
    if (root.shell == kNone && !node.is_leaf() && dyadic::depth(node.path) < kMostHalvings) {
      const Point at = part_.mesh.points[part_.mesh.subsegments[node.child].vertex[1]];
      const GlobalRootId r = d_.roots_of(s_)[i];
      const GlobalPointId m = add_point({.root = r, .path = node.path, .at = at}, kNone);
      midpoints_[{r, node.path}] = m;
      add_below(root, i, node.child, a, m);
      add_below(root, i, node.second_child(), m, b);
      return;
    }
    Decomposition::Root piece = root;
    piece.a = a;
    piece.b = b;
    pieces_.push_back({i, node.path});
    piece.marker = static_cast<std::int32_t>(pieces_.size());  // by which it is known again
    piece.left = root.left == s_ ? SubdomainId{0} : kNoSubdomain;
    piece.right = root.right == s_ ? SubdomainId{0} : kNoSubdomain;
    domain_.roots.push_back(piece);
  }

  const Decomposition& d_;
  SubdomainId s_;
  const SubdomainMesh& part_;
  Decomposition domain_;
  IdVector<GlobalPointId, FurtherCut::End> ends_;
  std::size_t known_points_ = 0;
  std::map<std::pair<GlobalRootId, dyadic::Path>, GlobalPointId> midpoints_;
  IdVector<GlobalRootId, Piece> pieces_;
};

/// What a decomposition of the domain alone means for the whole one.
class Translation {
 public:
  Translation(const Decomposition& d, SubdomainId s, const Alone& alone, const Decomposition& cut)
      : d_(d), alone_(alone), cut_(cut) {
    result_.whole = s;
    result_.parts.assign(cut.subdomains.begin(), cut.subdomains.end());
    for (const GlobalPointId v : ids_of(alone.domain().points)) alone_at_[key(alone.domain().points[v])] = v;
  }

  /// None if the cut has broken a root where there is no point for it.
  std::optional<FurtherCut> translate() {
    if (!find_pieces()) return {};
    add_separators();
    for (const GlobalRootId r : ids_of(pieces_)) add_interval(r);
    place_inner_points();
    return std::move(result_);
  }

 private:
  using Key = std::pair<double, double>;
  static Key key(const Point& p) { return {p.x, p.y}; }

  [[nodiscard]] GlobalPointId alone_at(GlobalPointId in_cut) const {
    const auto found = alone_at_.find(key(cut_.points[in_cut]));
    return found == alone_at_.end() ? kNoPoint : found->second;
  }

  bool find_pieces() {
    pieces_.assign(alone_.domain().roots.size(), {});
    std::size_t found = 0;
    for (const Decomposition::Root& root : cut_.roots) {
      if (root.separator) continue;
      const auto r = static_cast<GlobalRootId>(root.marker - 1);
      const Decomposition::Root& piece = alone_.domain().roots[r];
      const GlobalPointId a = alone_at(root.a), b = alone_at(root.b);
      const bool turned = a == piece.b;
      if ((turned ? b : a) != piece.a || (turned ? a : b) != piece.b) return false;
      pieces_[r] = turned ? Sides{root.right, root.left} : Sides{root.left, root.right};
      ++found;
    }
    return found == pieces_.size();
  }

  void add_separators() {
    for (const Decomposition::Root& root : cut_.roots)
      if (root.separator)
        result_.separators.push_back({end_of(root.a), end_of(root.b), to_int(root.left), to_int(root.right),
                                      root.left_region, root.right_region});
  }

  std::int32_t end_of(GlobalPointId in_cut) {
    const auto [place, is_new] = end_at_.try_emplace(key(cut_.points[in_cut]), 0);
    if (!is_new) return place->second;
    const GlobalPointId v = alone_at(in_cut);
    place->second = add_end(v == kNoPoint ? FurtherCut::End{.at = cut_.points[in_cut]} : alone_.end(v));
    return place->second;
  }

  /// With a point on a root come those of the intervals that contain it.
  std::int32_t add_end(const FurtherCut::End& end) {
    if (end.root != kNone) {
      if (const auto there = broken_.find({end.root, end.path}); there != broken_.end()) return there->second;
      if (end.path != dyadic::kWhole) (void)add_end(alone_.end_on(end.root, dyadic::parent(end.path)));
      broken_[{end.root, end.path}] = static_cast<std::int32_t>(result_.ends.size());
    }
    result_.ends.push_back(end);
    return static_cast<std::int32_t>(result_.ends.size() - 1);
  }

  /// The piece's part of the smallest interval that stays one; all pieces of it have the same sides.
  void add_interval(GlobalRootId r) {
    const Alone::Piece& piece = alone_.pieces()[r];
    result_.roots.resize(d_.roots_of(result_.whole).size());
    const GlobalRootId root = d_.roots_of(result_.whole)[piece.root];
    dyadic::Path path = piece.path;
    while (path != dyadic::kWhole && !broken_.contains({root, dyadic::parent(path)})) path = dyadic::parent(path);
    std::vector<FurtherCut::Interval>& intervals = result_.roots[piece.root];
    if (!intervals.empty() && intervals.back().path == path) return;
    const auto part = [](SubdomainId s) { return s == kNoSubdomain ? kNone : to_int(s); };
    intervals.push_back({path, part(pieces_[r].left), part(pieces_[r].right)});
  }

  void place_inner_points() {
    const auto inner = d_.inner_points_of(result_.whole);
    result_.inner_points.assign(inner.size(), kNone);  // where separators end
    for (const SubdomainId part : ids_of(cut_.subdomains))
      for (const GlobalPointId v : cut_.inner_points_of(part)) {
        const GlobalPointId known = alone_.end(alone_at(v)).known;
        const auto place = std::ranges::lower_bound(inner, known) - inner.begin();
        result_.inner_points[static_cast<std::size_t>(place)] = to_int(part);
      }
  }

  struct Sides {
    SubdomainId left = kNoSubdomain, right = kNoSubdomain;
  };
  const Decomposition& d_;
  const Alone& alone_;
  const Decomposition& cut_;
  FurtherCut result_;
  std::map<Key, GlobalPointId> alone_at_;
  std::map<Key, std::int32_t> end_at_;
  IdVector<GlobalRootId, Sides> pieces_;
  std::map<std::pair<GlobalRootId, dyadic::Path>, std::int32_t> broken_;  // which of the ends each is
};

}  // namespace

std::optional<FurtherCut> cut_further(const Decomposition& d, SubdomainId s, const SubdomainMesh& part,
                                      const QualityBounds& bounds, double forecast, std::int32_t parts) {
  const Alone alone(d, s, part);
  const Triangulation mesh = alone.mesh();
  for (; parts >= 2; parts /= 2) {
    const DecomposeOptions options{.subdomains = parts, .bounds = bounds, .forecast = forecast, .whole_segments = true};
    try {
      if (auto cut = Translation(d, s, alone, decompose(mesh, options)).translate()) return cut;
    } catch (const Error&) {  // there is no room for so many
    }
  }
  return {};
}

Bytes to_bytes(const FurtherCut& cut) {
  ByteWriter writer;
  writer.value(cut.whole);
  writer.array(cut.parts);
  writer.array(cut.ends);
  writer.array(cut.separators);
  writer.value(std::uint64_t{cut.roots.size()});
  for (const auto& intervals : cut.roots) writer.array(intervals);
  writer.array(cut.inner_points);
  return writer.take();
}

FurtherCut further_cut_from(ByteReader& reader) {
  FurtherCut cut;
  reader.value(cut.whole);
  reader.array(cut.parts);
  reader.array(cut.ends);
  reader.array(cut.separators);
  cut.roots.resize(static_cast<std::size_t>(reader.value<std::uint64_t>()));
  for (auto& intervals : cut.roots) reader.array(intervals);
  reader.array(cut.inner_points);
  return cut;
}

}  // namespace driftmesh
