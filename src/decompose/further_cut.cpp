#include "decompose/further_cut.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// Roots are not broken into smaller intervals than these: there are ends enough, and depths of points add up.
constexpr int kMostHalvings = 4;

/// The intervals into which points on a root, given by the intervals that they halve, break it.
template <class IsBroken>
void visit_intervals(dyadic::Path interval, const IsBroken& is_broken, const auto& visit) {
  if (!is_broken(interval)) {
    visit(interval);
    return;
  }
  visit_intervals(dyadic::first_half(interval), is_broken, visit);
  visit_intervals(dyadic::second_half(interval), is_broken, visit);
}

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
    domain_.point_begin = {0, 0};
    for (const GlobalPointId v : d.inner_points_of(s)) {
      domain_.point_list.push_back(local(v));
      ++domain_.point_begin[1];
    }
    list_roots(domain_);
  }

  [[nodiscard]] Triangulation mesh() const { return subdomain_triangulation(domain_, SubdomainId{0}).mesh; }
  [[nodiscard]] const Decomposition& domain() const { return domain_; }
  /// What each root of the domain is.
  [[nodiscard]] const IdVector<GlobalRootId, Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const FurtherCut::End& end(GlobalPointId v) const { return ends_[v]; }
  [[nodiscard]] GlobalPointId local(GlobalPointId known) const {
    const auto known_end = ends_.begin() + static_cast<std::ptrdiff_t>(known_points_);
    const auto found = std::lower_bound(ends_.begin(), known_end, known,
                                        [](const FurtherCut::End& e, GlobalPointId v) { return e.known < v; });
    return static_cast<GlobalPointId>(found - ends_.begin());
  }

 private:
  void list_points() {
    std::set<GlobalPointId> known(d_.inner_points_of(s_).begin(), d_.inner_points_of(s_).end());
    for (const GlobalRootId r : d_.roots_of(s_)) known.insert({d_.roots[r].a, d_.roots[r].b});
    for (const GlobalPointId v : known) add_point({.known = v, .at = d_.points[v]}, d_.origin[v]);
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
      const GlobalPointId m = add_point({.root = d_.roots_of(s_)[i], .path = node.path, .at = at}, kNone);
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

  /// Above a point on a root are those that halve what contains it.
  std::int32_t add_end(const FurtherCut::End& end) {
    if (end.root != kNone)
      for (const GlobalPointId v : ids_of(alone_.domain().points)) {
        const FurtherCut::End& other = alone_.end(v);
        if (other.root == end.root && other.path != end.path && dyadic::is_ancestor(other.path, end.path))
          if (broken_.insert({other.root, other.path}).second) result_.ends.push_back(other);
      }
    if (end.root != kNone && !broken_.insert({end.root, end.path}).second) {
      const auto there = std::ranges::find_if(
          result_.ends, [&](const FurtherCut::End& e) { return e.root == end.root && e.path == end.path; });
      return static_cast<std::int32_t>(there - result_.ends.begin());
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
  std::set<std::pair<GlobalRootId, dyadic::Path>> broken_;
};

/// Applies cuts to a decomposition.
class Application {
 public:
  Application(const Decomposition& d, std::span<const FurtherCut> cuts) : d_(d), cuts_(cuts), whole_(d), divided_(d) {
    number_parts();
    add_points();
    break_roots();
    broken_ = whole_;
    add_separators();
  }

  CutFurther take() {
    list_inner_points();
    for (Decomposition* d : {&broken_, &whole_, &divided_}) list_roots(*d);
    return {std::move(broken_), std::move(whole_), std::move(divided_), std::move(renamed_), std::move(whole_of_)};
  }

 private:
  void number_parts() {
    for (const SubdomainId s : ids_of(d_.subdomains)) whole_of_.push_back(s);
    for (const FurtherCut& cut : cuts_) {
      std::vector<SubdomainId>& numbers = numbers_[cut.whole];
      for (const Decomposition::Subdomain& part : cut.parts) {
        numbers.push_back(numbers.empty() ? cut.whole : divided_.subdomains.next_id());
        if (numbers.size() == 1) {
          divided_.subdomains[cut.whole] = part;
        } else {
          divided_.subdomains.push_back(part);
          whole_of_.push_back(cut.whole);
        }
      }
      cut_of_[cut.whole] = &cut;
    }
  }

  void add_points() {
    for (const FurtherCut& cut : cuts_) {
      std::vector<GlobalPointId>& points = points_of_.emplace_back();
      for (const FurtherCut::End& end : cut.ends)
        points.push_back(end.known != kNoPoint ? end.known
                         : end.root == kNone   ? add_point(end.at)
                         : breaks(end)         ? breaks_[end.root].at(end.path)
                                               : (breaks_[end.root][end.path] = add_point(end.at)));
    }
  }

  [[nodiscard]] bool breaks(const FurtherCut::End& end) const {
    const auto found = breaks_.find(end.root);
    return found != breaks_.end() && found->second.contains(end.path);
  }

  GlobalPointId add_point(const Point& at) {
    for (Decomposition* d : {&whole_, &divided_}) {
      d->points.push_back(at);
      d->origin.push_back(kNone);
    }
    return static_cast<GlobalPointId>(whole_.points.size() - 1);
  }

  void break_roots() {
    std::set<GlobalRootId> concerned;
    for (const FurtherCut& cut : cuts_)
      for (const GlobalRootId r : d_.roots_of(cut.whole)) concerned.insert(r);
    for (const GlobalRootId r : concerned) {
      const auto found = breaks_.find(r);
      if (found != breaks_.end())
        break_root(r, found->second);
      else
        set_sides(r, r, dyadic::kWhole);
    }
  }

  void break_root(GlobalRootId r, const std::map<dyadic::Path, GlobalPointId>& points) {
    GlobalPointId start = d_.roots[r].a;
    visit_intervals(
        dyadic::kWhole, [&](dyadic::Path p) { return points.contains(p); },
        [&](dyadic::Path interval) {
          Decomposition::Root piece = d_.roots[r];
          piece.a = start;
          const dyadic::Path before_end = ending_of(interval);
          piece.b = before_end == 0 ? d_.roots[r].b : points.at(before_end);
          start = piece.b;
          const GlobalRootId number = interval == first_interval(points) ? r : whole_.roots.next_id();
          for (Decomposition* d : {&whole_, &divided_}) {
            if (number == r)
              d->roots[r] = piece;
            else
              d->roots.push_back(piece);
          }
          renamed_[r].push_back({interval, number});
          set_sides(number, r, interval);
          for (Decomposition* d : {&whole_, &divided_}) direct(d->roots[number]);
        });
  }

  static dyadic::Path first_interval(const std::map<dyadic::Path, GlobalPointId>& points) {
    dyadic::Path interval = dyadic::kWhole;
    while (points.contains(interval)) interval = dyadic::first_half(interval);
    return interval;
  }

  /// The interval whose midpoint is where this one ends; 0: the root ends there.
  static dyadic::Path ending_of(dyadic::Path interval) {
    while (interval != dyadic::kWhole && dyadic::is_second_half(interval)) interval = dyadic::parent(interval);
    return interval == dyadic::kWhole ? 0 : dyadic::parent(interval);
  }

  /// The parts at an interval of what was root r.
  void set_sides(GlobalRootId number, GlobalRootId r, dyadic::Path interval) {
    const Decomposition::Root& was = d_.roots[r];
    Decomposition::Root& root = divided_.roots[number];
    const auto part = [&](SubdomainId s, bool left) {
      const auto cut = s == kNoSubdomain ? cut_of_.end() : cut_of_.find(s);
      if (cut == cut_of_.end()) return s;
      const auto roots = d_.roots_of(s);
      const auto place = std::ranges::lower_bound(roots, r) - roots.begin();
      const auto& intervals = cut->second->roots[static_cast<std::size_t>(place)];
      const auto around = std::ranges::find_if(
          intervals, [&](const FurtherCut::Interval& i) { return dyadic::is_ancestor(i.path, interval); });
      return numbers_.at(s)[to_index(left ? around->left : around->right)];
    };
    root.left = part(was.left, true);
    root.right = part(was.right, false);
  }

  static void direct(Decomposition::Root& root) {
    if (root.a < root.b || root.shell != kNone) return;
    std::swap(root.a, root.b);
    std::swap(root.left, root.right);
    std::swap(root.left_region, root.right_region);
  }

  void add_separators() {
    for (std::size_t i = 0; i < cuts_.size(); ++i)
      for (const FurtherCut::Separator& s : cuts_[i].separators) {
        const FurtherCut& cut = cuts_[i];
        Decomposition::Root root{.a = points_of_[i][to_index(s.a)],
                                 .b = points_of_[i][to_index(s.b)],
                                 .left = cut.whole,
                                 .right = cut.whole,
                                 .left_region = s.left_region,
                                 .right_region = s.right_region,
                                 .separator = true};
        whole_.roots.push_back(root);
        root.left = numbers_.at(cut.whole)[to_index(s.left)];
        root.right = numbers_.at(cut.whole)[to_index(s.right)];
        divided_.roots.push_back(root);
        for (Decomposition* d : {&whole_, &divided_}) direct(d->roots.back());
      }
  }

  void list_inner_points() {
    std::vector<std::pair<SubdomainId, GlobalPointId>> in_whole, in_parts;
    for (const SubdomainId s : ids_of(d_.subdomains)) {
      const auto points = d_.inner_points_of(s);
      const auto cut = cut_of_.find(s);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::int32_t part = cut == cut_of_.end() ? 0 : cut->second->inner_points[i];
        if (part == kNone) continue;
        in_whole.emplace_back(s, points[i]);
        in_parts.emplace_back(cut == cut_of_.end() ? s : numbers_.at(s)[to_index(part)], points[i]);
      }
    }
    set_inner_points(whole_, in_whole);
    set_inner_points(divided_, in_parts);
  }

  static void set_inner_points(Decomposition& d, std::vector<std::pair<SubdomainId, GlobalPointId>>& inner) {
    std::ranges::sort(inner);
    d.point_list.clear();
    d.point_begin.assign(d.size() + 1, 0);
    for (const auto& [s, point] : inner) {
      ++d.point_begin[to_index(s) + 1];
      d.point_list.push_back(point);
    }
    for (std::size_t i = 0; i < d.size(); ++i) d.point_begin[i + 1] += d.point_begin[i];
  }

  const Decomposition& d_;
  std::span<const FurtherCut> cuts_;
  Decomposition broken_, whole_, divided_;
  RenamedRoots renamed_;
  IdVector<SubdomainId, SubdomainId> whole_of_;
  std::map<SubdomainId, std::vector<SubdomainId>> numbers_;  // those of the parts, for each that is divided
  std::map<SubdomainId, const FurtherCut*> cut_of_;
  std::vector<std::vector<GlobalPointId>> points_of_;  // the ends of each cut
  std::map<GlobalRootId, std::map<dyadic::Path, GlobalPointId>> breaks_;
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

CutFurther with_cuts(const Decomposition& decomposition, std::span<const FurtherCut> cuts) {
  return Application(decomposition, cuts).take();
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
