#include "patch/splice.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace driftmesh::patch {
namespace {

constexpr std::int32_t kNew = -1;

using Ends = std::pair<std::int32_t, std::int32_t>;

Ends ends_of(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

class Maker {
 public:
  Maker(const Mesh& made, const Domain& domain, const Part& part, const Extent& extent, const OldPlaces& old)
      : made_(made), domain_(domain), part_(part), extent_(extent), old_(old) {}

  NewPart run() {
    reserve();
    look_at_domain();
    for (std::size_t v = 0; v < made_.points.size(); ++v) add_made_point(v);
    for (std::size_t t = 0; t < made_.triangles.size(); ++t) add_made(t);
    new_.triangles_made = new_.mesh.triangles.size();
    new_.mesh.subdomains = made_.subdomains;
    for (const Mesh::Edge& edge : made_.edges) add_edge(edge);
    add_beyond();
    return std::move(new_);
  }

 private:
  [[nodiscard]] bool has_markers() const { return !part_.mesh.point_markers.empty(); }
  [[nodiscard]] bool has_regions() const { return !part_.mesh.regions.empty(); }

  void reserve() {
    const std::size_t points = made_.points.size(), triangles = made_.triangles.size();
    new_.mesh.points.reserve(points);
    new_.old_point.reserve(points);
    if (has_markers()) new_.mesh.point_markers.reserve(points);
    new_.mesh.triangles.reserve(triangles);
    new_.old_triangle.reserve(triangles);
    if (has_regions()) new_.mesh.regions.reserve(triangles);
  }

  void look_at_domain() {
    for (std::size_t i = 0; i < domain_.fixed.size(); ++i)
      if (domain_.fixed[i]) {
        const Pslg::Segment& s = domain_.pslg.segments[i];
        fixed_.push_back(ends_of(old_.point_at(domain_.pslg.points[to_index(s.a)]),
                                 old_.point_at(domain_.pslg.points[to_index(s.b)])));
      }
    std::ranges::sort(fixed_);
    for (std::size_t i = 0; i < domain_.pslg.points.size(); ++i)
      if (const std::int32_t marker = domain_.pslg.point_markers[i]; marker != 0)
        end_markers_[{domain_.pslg.points[i].x, domain_.pslg.points[i].y}] = marker;
  }

  void add_point(const Point& p, std::int32_t old, std::int32_t marker) {
    new_.mesh.points.push_back(p);
    new_.old_point.push_back(old);
    if (has_markers()) new_.mesh.point_markers.push_back(marker);
  }

  void add_made_point(std::size_t v) {
    const Point& p = made_.points[v];
    const std::int32_t old = old_.point_at(p);
    std::int32_t marker = old >= 0 && has_markers() ? part_.mesh.point_markers[to_index(old)] : 0;
    if (marker == 0 && !end_markers_.empty())
      if (const auto end = end_markers_.find({p.x, p.y}); end != end_markers_.end()) marker = end->second;
    add_point(old < 0 ? p : part_.mesh.points[to_index(old)], old, marker);
  }

  /// A triangle that stays, in the same region, begins with the corner that it began with.
  void add_made(std::size_t t) {
    std::array<std::int32_t, 3> corners = made_.triangles[t], old{};
    for (std::size_t i = 0; i < 3; ++i) old[i] = new_.old_point[to_index(corners[i])];
    const bool known = std::ranges::all_of(old, [](std::int32_t v) { return v >= 0; });
    std::int32_t same = known ? old_.triangle_of(old) : kNew;
    const double region = made_.regions.empty() ? 0 : made_.regions[t];
    if (same >= 0 && has_regions() && part_.mesh.regions[to_index(same)] != region) same = kNew;
    if (same >= 0)
      while (old[0] != part_.mesh.triangles[to_index(same)][0]) {
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        std::rotate(old.begin(), old.begin() + 1, old.end());
      }
    new_.mesh.triangles.push_back(corners);
    new_.old_triangle.push_back(same);
    if (has_regions()) new_.mesh.regions.push_back(region);
  }

  /// Of the edges between what is made and what stays only those that were listed.
  void add_edge(const Mesh::Edge& edge) {
    const std::array<std::int32_t, 2> old{new_.old_point[to_index(edge.a)], new_.old_point[to_index(edge.b)]};
    if (!std::ranges::binary_search(fixed_, ends_of(old[0], old[1])) || index_.find(old[0], old[1]) >= 0)
      new_.mesh.edges.push_back(edge);
    if (!has_markers()) return;
    for (const std::int32_t v : {edge.a, edge.b})
      if (new_.old_point[to_index(v)] < 0 && new_.mesh.point_markers[to_index(v)] == 0)
        new_.mesh.point_markers[to_index(v)] = edge.marker;
  }

  /// The triangles of the part that were not taken.
  void add_beyond() {
    std::vector<std::int32_t> at(part_.mesh.points.size(), kNone);
    for (std::size_t v = 0; v < new_.old_point.size(); ++v)
      if (new_.old_point[v] >= 0) at[to_index(new_.old_point[v])] = static_cast<std::int32_t>(v);
    for (std::size_t t = 0; t < part_.mesh.triangles.size(); ++t) {
      if (extent_.taken[t]) continue;
      std::array<std::int32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t v = part_.mesh.triangles[t][i];
        if (at[to_index(v)] == kNone) {
          at[to_index(v)] = static_cast<std::int32_t>(new_.mesh.points.size());
          add_point(part_.mesh.points[to_index(v)], v, has_markers() ? part_.mesh.point_markers[to_index(v)] : 0);
        }
        corners[i] = at[to_index(v)];
      }
      new_.mesh.triangles.push_back(corners);
      new_.old_triangle.push_back(static_cast<std::int32_t>(t));
      if (!part_.mesh.regions.empty()) new_.mesh.regions.push_back(part_.mesh.regions[t]);
    }
  }

  const Mesh& made_;
  const Domain& domain_;
  const Part& part_;
  const Extent& extent_;
  const OldPlaces& old_;
  ConstrainedEdgeIndex index_{part_.mesh};
  std::vector<Ends> fixed_;                                        // segments that nothing has split, by old points
  std::map<std::pair<double, double>, std::int32_t> end_markers_;  // where points of the domain have one
  NewPart new_;
};

/// Gives numbers: free ones first, then new ones, and moves the last ones to those that are left.
class Numbering {
 public:
  explicit Numbering(std::size_t count) : old_(count) { std::iota(old_.begin(), old_.end(), 0); }

  /// In ascending order.
  void free(std::int32_t number) {
    free_.push_back(number);
    old_[to_index(number)] = kFreed;
  }
  std::int32_t take() {
    if (next_ < free_.size()) {
      old_[to_index(free_[next_])] = kNew;
      return free_[next_++];
    }
    old_.push_back(kNew);
    return static_cast<std::int32_t>(old_.size() - 1);
  }
  /// Calls move(from, to) for what moves. Afterwards all numbers are in use.
  template <class Move>
  void close(const Move& move) {
    for (; next_ < free_.size(); ++next_) {
      while (!old_.empty() && old_.back() == kFreed) old_.pop_back();
      if (to_index(free_[next_]) >= old_.size()) break;
      move(static_cast<std::int32_t>(old_.size() - 1), free_[next_]);
      old_[to_index(free_[next_])] = old_.back();
      old_.pop_back();
    }
  }
  [[nodiscard]] std::size_t size() const { return old_.size(); }
  [[nodiscard]] std::vector<std::int32_t> take_old() { return std::move(old_); }

 private:
  static constexpr std::int32_t kFreed = -2;
  std::vector<std::int32_t> old_;
  std::vector<std::int32_t> free_;
  std::size_t next_ = 0;
};

template <class T>
void put(std::vector<T>& all, std::int32_t at, const T& value) {
  if (to_index(at) >= all.size()) all.resize(to_index(at) + 1);
  all[to_index(at)] = value;
}

class Splicing {
 public:
  Splicing(Mesh& mesh, const Part& part, const Extent& extent, const NewPart& made)
      : mesh_(mesh), part_(part), extent_(extent), made_(made) {}

  Numbers run() {
    number_points();
    begin_subdomains();
    number_triangles();
    put_edges();
    move_the_last();
    mesh_.numbers.clear();
    return std::move(numbers_);
  }

 private:
  void number_points() {
    gone_points_.assign(part_.point.size(), false);
    for (std::size_t t = 0; t < part_.mesh.triangles.size(); ++t)
      if (extent_.taken[t])
        for (const std::int32_t v : part_.mesh.triangles[t]) gone_points_[to_index(v)] = true;
    for (const std::int32_t old : made_.old_point)
      if (old >= 0) gone_points_[to_index(old)] = false;
    for (std::size_t v = 0; v < gone_points_.size(); ++v)
      if (gone_points_[v]) points_.free(part_.point[v]);
    for (std::size_t v = 0; v < made_.old_point.size(); ++v) {
      const std::int32_t old = made_.old_point[v];
      const std::int32_t number = old >= 0 ? part_.point[to_index(old)] : points_.take();
      numbers_.points.push_back(number);
      if (!mesh_.point_markers.empty()) put(mesh_.point_markers, number, made_.mesh.point_markers[v]);
      if (old < 0) put(mesh_.points, number, made_.mesh.points[v]);
    }
  }

  /// Edges between subdomains need not be Delaunay. What is made anew is one of its own, or several.
  void begin_subdomains() {
    const bool all = part_.triangle.size() == mesh_.triangles.size() &&
                     std::ranges::find(extent_.taken, false) == extent_.taken.end();
    if (all) mesh_.subdomains.clear();
    if (mesh_.subdomains.empty() && !made_.mesh.subdomains.empty()) mesh_.subdomains.resize(mesh_.triangles.size());
    if (!all && !mesh_.subdomains.empty()) own_subdomain_ = 1 + *std::ranges::max_element(mesh_.subdomains);
  }

  void number_triangles() {
    std::vector<bool> gone = extent_.taken;
    for (const std::int32_t old : made_.old_triangle)
      if (old >= 0) gone[to_index(old)] = false;
    for (std::size_t t = 0; t < gone.size(); ++t)
      if (gone[t]) triangles_.free(part_.triangle[t]);
    for (std::size_t t = 0; t < made_.triangles_made; ++t) {
      const std::int32_t old = made_.old_triangle[t];
      const std::int32_t number = old >= 0 ? part_.triangle[to_index(old)] : triangles_.take();
      numbers_.triangles.push_back(number);
      const auto& [a, b, c] = made_.mesh.triangles[t];
      put(mesh_.triangles, number, {point(a), point(b), point(c)});
      if (!mesh_.regions.empty()) put(mesh_.regions, number, made_.mesh.regions[t]);
      if (old >= 0) continue;
      if (!mesh_.subdomains.empty())
        put(mesh_.subdomains, number, own_subdomain_ + (made_.mesh.subdomains.empty() ? 0 : made_.mesh.subdomains[t]));
      if (!mesh_.ranks.empty()) put(mesh_.ranks, number, 0);
    }
  }

  [[nodiscard]] std::int32_t point(std::int32_t v) const { return numbers_.points[to_index(v)]; }

  /// The places of edges that are gone go to new ones, then others follow behind.
  void put_edges() {
    std::map<Ends, const Mesh::Edge*> open;  // those that were made, by their ends
    for (const Mesh::Edge& edge : made_.mesh.edges) {
      open.emplace(ends_of(point(edge.a), point(edge.b)), &edge);
    }
    std::vector<bool> taken(part_.edge.size(), false);
    for (std::size_t t = 0; t < part_.mesh.triangles.size(); ++t)
      if (extent_.taken[t])
        for (std::size_t i = 0; i < 3; ++i)
          if (const std::int32_t e =
                  index_.find(part_.mesh.triangles[t][(i + 1) % 3], part_.mesh.triangles[t][(i + 2) % 3]);
              e >= 0)
            taken[to_index(e)] = true;
    std::vector<std::int32_t> gone;
    for (std::size_t e = 0; e < taken.size(); ++e) {
      if (!taken[e]) continue;
      Mesh::Edge& edge = mesh_.edges[to_index(part_.edge[e])];
      const Mesh::Edge& own = part_.mesh.edges[e];
      const auto found = open.find(ends_of(edge.a, edge.b));
      // Other points may have the numbers of those that are gone.
      if (found == open.end() || gone_points_[to_index(own.a)] || gone_points_[to_index(own.b)]) {
        gone.push_back(part_.edge[e]);
      } else {
        edge.marker = found->second->marker;
        open.erase(found);
      }
    }
    std::size_t used = 0;
    for (const Mesh::Edge& edge : made_.mesh.edges) {
      const std::int32_t a = point(edge.a), b = point(edge.b);
      if (!open.contains(ends_of(a, b))) continue;
      const Mesh::Edge made{a, b, edge.marker};
      if (used < gone.size())
        mesh_.edges[to_index(gone[used++])] = made;
      else
        mesh_.edges.push_back(made);
    }
    for (std::size_t k = gone.size(); k > used; --k) mesh_.edges.erase(mesh_.edges.begin() + gone[k - 1]);
  }

  /// Calls visit for each array that has a value for each triangle.
  template <class Visit>
  void for_each_label(const Visit& visit) {
    if (!mesh_.regions.empty()) visit(mesh_.regions);
    if (!mesh_.subdomains.empty()) visit(mesh_.subdomains);
    if (!mesh_.ranks.empty()) visit(mesh_.ranks);
  }

  void move_the_last() {
    triangles_.close([&](std::int32_t from, std::int32_t to) {
      mesh_.triangles[to_index(to)] = mesh_.triangles[to_index(from)];
      for_each_label([&](auto& labels) { labels[to_index(to)] = labels[to_index(from)]; });
      moved_triangles_[from] = to;
    });
    mesh_.triangles.resize(triangles_.size());
    for_each_label([&](auto& labels) { labels.resize(triangles_.size()); });
    points_.close([&](std::int32_t from, std::int32_t to) {
      mesh_.points[to_index(to)] = mesh_.points[to_index(from)];
      if (!mesh_.point_markers.empty()) mesh_.point_markers[to_index(to)] = mesh_.point_markers[to_index(from)];
      moved_points_[from] = to;
    });
    mesh_.points.resize(points_.size());
    if (!mesh_.point_markers.empty()) mesh_.point_markers.resize(points_.size());
    follow(numbers_.triangles, moved_triangles_);
    follow(numbers_.points, moved_points_);
    if (!moved_points_.empty()) {
      const auto least = moved_points_.begin()->first;
      const auto renumber = [&](std::int32_t& v) {
        if (v >= least)
          if (const auto found = moved_points_.find(v); found != moved_points_.end()) v = found->second;
      };
      for (auto& corners : mesh_.triangles)
        for (std::int32_t& v : corners) renumber(v);
      for (Mesh::Edge& edge : mesh_.edges) renumber(edge.a), renumber(edge.b);
      for (Mesh::Weir& weir : mesh_.weirs) {
        for (std::int32_t& v : weir.points) renumber(v);
        for (std::int32_t& v : weir.across) renumber(v);
      }
    }
    numbers_.old_points = points_.take_old();
    numbers_.old_triangles = triangles_.take_old();
  }

  static void follow(std::vector<std::int32_t>& numbers, const std::map<std::int32_t, std::int32_t>& moved) {
    for (std::int32_t& number : numbers)
      if (const auto found = moved.find(number); found != moved.end()) number = found->second;
  }

  Mesh& mesh_;
  const Part& part_;
  const Extent& extent_;
  const NewPart& made_;
  ConstrainedEdgeIndex index_{part_.mesh};
  Numbering points_{mesh_.points.size()}, triangles_{mesh_.triangles.size()};
  std::int32_t own_subdomain_ = 0;  // the first of those that are made anew
  std::vector<bool> gone_points_;   // those of the part
  std::map<std::int32_t, std::int32_t> moved_points_, moved_triangles_;
  Numbers numbers_;
};

}  // namespace

NewPart new_part(const Mesh& made, const Domain& domain, const Part& part, const Extent& extent, const OldPlaces& old) {
  return Maker(made, domain, part, extent, old).run();
}

Numbers splice(Mesh& mesh, const Part& part, const Extent& extent, const NewPart& made) {
  return Splicing(mesh, part, extent, made).run();
}

}  // namespace driftmesh::patch
