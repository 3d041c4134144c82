#include "adapt/agree.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "decompose/presplit.hpp"
#include "geometry/midpoint.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {
namespace {

/// Lengths along a root, linear between the points that it has.
class LengthsAlong {
 public:
  LengthsAlong(const Triangulation& mesh, RootId root, const Lengths& lengths) {
    const auto& ends = mesh.roots[root].vertex;
    add(0, lengths[ends[0]]);
    add_below(mesh, mesh.roots[root].tree, lengths);
    add(kEnd, lengths[ends[1]]);
  }

  [[nodiscard]] double at(std::uint64_t position) const {
    const auto after = std::ranges::lower_bound(positions_, position);
    const auto i = static_cast<std::size_t>(after - positions_.begin());
    if (*after == position) return lengths_[i];
    const double left = lengths_[i - 1], right = lengths_[i];
    const double t =
        static_cast<double>(position - positions_[i - 1]) / static_cast<double>(positions_[i] - positions_[i - 1]);
    const double length = left + t * (right - left);
    return length >= 0 ? length : std::numeric_limits<double>::infinity();  // not for NaN
  }

  /// The least at points strictly between; infinite if there are none.
  [[nodiscard]] double least_between(std::uint64_t from, std::uint64_t to) const {
    double least = std::numeric_limits<double>::infinity();
    for (auto i = std::ranges::upper_bound(positions_, from); i != positions_.end() && *i < to; ++i)
      least = std::min(least, lengths_[static_cast<std::size_t>(i - positions_.begin())]);
    return least;
  }

  static constexpr std::uint64_t kEnd = std::uint64_t{1} << 62;  // as dyadic::position counts

 private:
  void add(std::uint64_t position, double length) {
    positions_.push_back(position);
    lengths_.push_back(length);
  }
  void add_below(const Triangulation& mesh, SubsegmentId s, const Lengths& lengths) {
    const Subsegment& node = mesh.subsegments[s];
    if (node.is_leaf()) return;
    add_below(mesh, node.child, lengths);
    add(dyadic::position(node.path), lengths[mesh.subsegments[node.child].vertex[1]]);
    add_below(mesh, node.second_child(), lengths);
  }

  std::vector<std::uint64_t> positions_;
  std::vector<double> lengths_;
};

struct Cut {
  const LengthsAlong& lengths;
  double twice_area;
  std::vector<dyadic::Path>& paths;

  /// The largest squared length of a piece where this length is asked for.
  [[nodiscard]] double most(double length) const {
    return kPresplitSpacing * kPresplitSpacing * std::min(twice_area, twice_area_of_edge(length)) / 2;
  }

  /// Lengths deeper within a piece count as those between the corners of a triangle do.
  void operator()(const Point& a, std::uint64_t from, const Point& b, std::uint64_t to, dyadic::Path path) const {
    constexpr int kDeepest = 40;
    const Point m = midpoint(a, b);
    const std::uint64_t middle = dyadic::position(path);
    const double least = std::min({lengths.at(from), lengths.at(middle), lengths.at(to)});
    const double allowed = most(std::min(least, kBetween * lengths.least_between(from, to)));
    if (squared_distance(a, b) <= allowed || dyadic::depth(path) >= kDeepest || m == a || m == b) return;
    paths.push_back(path);
    (*this)(a, from, m, middle, dyadic::first_half(path));
    (*this)(m, middle, b, to, dyadic::second_half(path));
  }
};

void add_points_below(const Triangulation& mesh, SubsegmentId s, std::vector<dyadic::Path>& paths) {
  const Subsegment& node = mesh.subsegments[s];
  if (node.is_leaf()) return;
  paths.push_back(node.path);
  add_points_below(mesh, node.child, paths);
  add_points_below(mesh, node.second_child(), paths);
}

}  // namespace

std::vector<dyadic::Path> points_on(const Triangulation& mesh, RootId root) {
  std::vector<dyadic::Path> paths;
  add_points_below(mesh, mesh.roots[root].tree, paths);
  std::ranges::sort(paths);
  return paths;
}

std::vector<dyadic::Path> points_wanted(const Triangulation& mesh, RootId root, const Lengths& lengths,
                                        double twice_area) {
  std::vector<dyadic::Path> paths;
  const LengthsAlong along(mesh, root, lengths);
  const auto& [a, b] = mesh.roots[root].vertex;
  Cut{along, twice_area, paths}(mesh.points[a], 0, mesh.points[b], LengthsAlong::kEnd, dyadic::kWhole);
  std::ranges::sort(paths);
  return paths;
}

std::vector<dyadic::Path> united(const std::vector<dyadic::Path>& some, const std::vector<dyadic::Path>& others) {
  std::vector<dyadic::Path> all;
  std::ranges::set_union(some, others, std::back_inserter(all));
  return all;
}

std::vector<dyadic::Path> without(const std::vector<dyadic::Path>& some, const std::vector<dyadic::Path>& others) {
  std::vector<dyadic::Path> rest;
  std::ranges::set_difference(some, others, std::back_inserter(rest));
  return rest;
}

}  // namespace driftmesh::adapt
