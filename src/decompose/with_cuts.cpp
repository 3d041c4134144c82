#include "decompose/with_cuts.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace driftmesh {
namespace {

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
    place_inner_points();
    for (Decomposition* d : {&broken_, &whole_, &divided_}) list_roots(*d);
    return {std::move(broken_), std::move(whole_), std::move(divided_), std::move(renamed_), std::move(whole_of_)};
  }

 private:
  void number_parts() {
    const auto same = ids_of(d_.subdomains);
    whole_of_.assign(same.begin(), same.end());
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
      for (const FurtherCut::End& end : cut.ends) points.push_back(point_of(end));
    }
  }

  /// Cuts on both sides of a root may break it at the same point.
  GlobalPointId point_of(const FurtherCut::End& end) {
    if (end.known != kNoPoint) return end.known;
    if (end.root == kNone) return add_point(end.at);
    const auto [place, is_new] = breaks_[end.root].try_emplace(end.path, kNoPoint);
    if (is_new) place->second = add_point(end.at);
    return place->second;
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
    if (root.a > root.b && root.shell == kNone) root.turn_around();
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

  void place_inner_points() {
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
    list_inner_points(whole_, std::move(in_whole));
    list_inner_points(divided_, std::move(in_parts));
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

CutFurther with_cuts(const Decomposition& decomposition, std::span<const FurtherCut> cuts) {
  return Application(decomposition, cuts).take();
}

}  // namespace driftmesh
