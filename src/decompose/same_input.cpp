#include "decompose/same_input.hpp"

#include <algorithm>
#include <bit>
#include <set>
#include <tuple>
#include <vector>

#include "base/mix.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// A digest of a sequence of numbers.
class Condenser {
 public:
  void add(std::uint64_t value) { state_ = mix(state_ + value + kMixStep); }
  void add(const Point& p) {
    add(std::bit_cast<std::uint64_t>(p.x));
    add(std::bit_cast<std::uint64_t>(p.y));
  }
  /// As many bits as an integer in a file has.
  [[nodiscard]] std::int32_t value() const { return static_cast<std::int32_t>(state_ >> 33); }

 private:
  std::uint64_t state_ = 0;
};

/// The input's segments as a decomposition's roots represent them: chains of roots that are not separators, from one
/// point of the input to the next. Each is given by its ends (the smaller first) and its marker.
class Chains {
 public:
  explicit Chains(const Decomposition& d) : d_(d), at_(d.points.size()) {
    for (const GlobalRootId r : ids_of(d.roots))
      if (!d.roots[r].separator)
        for (const GlobalPointId v : {d.roots[r].a, d.roots[r].b}) at_[v].push_back(r);
  }

  template <class Visit>
  void visit(Visit&& visit) const {
    for (const GlobalPointId v : ids_of(at_))
      if (is_input(d_.origin[v]))
        for (const GlobalRootId r : at_[v])
          if (const std::int32_t end = follow(v, r); end != kNone) visit(d_.origin[v], end, d_.roots[r].marker);
  }

 private:
  /// Follows root `r` from point `v` to the next point of the input; kNone if there is none.
  [[nodiscard]] std::int32_t follow(GlobalPointId v, GlobalRootId r) const {
    for (std::size_t steps = 0; steps < d_.roots.size(); ++steps) {
      const Decomposition::Root& root = d_.roots[r];
      v = root.a == v ? root.b : root.a;
      if (is_input(d_.origin[v])) return d_.origin[v];
      if (at_[v].size() != 2) return kNone;
      r = at_[v][0] == r ? at_[v][1] : at_[v][0];
    }
    return kNone;
  }

  const Decomposition& d_;
  IdVector<GlobalPointId, std::vector<GlobalRootId>> at_;  // the roots at each point
};

}  // namespace

std::int32_t input_digest(const Pslg& input) {
  Condenser all;
  all.add(input.points.size());
  for (const Point& p : input.points) all.add(p);
  all.add(input.segments.size());
  for (const Pslg::Segment& s : input.segments)
    for (const std::int32_t part : {s.a, s.b, s.marker}) all.add(static_cast<std::uint32_t>(part));
  all.add(input.holes.size());
  for (const Point& p : input.holes) all.add(p);
  all.add(input.regions.size());
  for (const Pslg::Region& r : input.regions) all.add(r.at);
  for (const Pslg::Polygon& polygon : input.polygons) {
    all.add(polygon.rings.size());
    all.add(static_cast<std::uint32_t>(polygon.region));
    for (const Pslg::Ring& ring : polygon.rings) {
      all.add(ring.size());
      for (const std::int32_t corner : ring) all.add(static_cast<std::uint32_t>(corner));
    }
  }
  return all.value();
}

void refuse_as_another(const std::string& file, const std::string& why) {
  throw InputError({file, 0}, "this decomposition was made from another input" + why,
                   "decompose this input anew with driftmesh decompose");
}

void require_same_input(const Decomposition& d, const Pslg& input, const std::string& file) {
  const auto point = [](std::int32_t i) { return "point " + std::to_string(i); };
  for (const GlobalPointId v : ids_of(d.points)) {
    if (!is_input(d.origin[v])) continue;
    const std::size_t i = to_index(d.origin[v]);
    if (i >= input.points.size() || !(input.points[i] == d.points[v]))
      refuse_as_another(file, ": its point " + to_string(v) + " is not " + point(d.origin[v]) + " of the input");
  }
  for (const Decomposition::Root& r : d.roots)
    if (std::max(r.left_region, r.right_region) > input.regions.size())
      refuse_as_another(file, " with more than " + std::to_string(input.regions.size()) + " regions");
  std::set<std::tuple<std::int32_t, std::int32_t, std::int32_t>> segments;
  for (const Pslg::Segment& s : input.segments) segments.emplace(std::min(s.a, s.b), std::max(s.a, s.b), s.marker);
  Chains(d).visit([&](std::int32_t a, std::int32_t b, std::int32_t marker) {
    if (!segments.contains({std::min(a, b), std::max(a, b), marker}))
      refuse_as_another(file, ", which has a segment from " + point(a) + " to " + point(b) + " with marker " +
                                  std::to_string(marker));
  });
}

}  // namespace driftmesh
