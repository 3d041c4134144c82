#include "driftmesh/mesh_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "geometry/hilbert_sort.hpp"
#include "sizing/point_neighbors.hpp"

namespace driftmesh {
namespace {

/// Old numbers by new ones, or the reverse.
using Numbers = std::vector<std::int32_t>;

Numbers inverse(const Numbers& numbers) {
  Numbers result(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) result[to_index(numbers[i])] = static_cast<std::int32_t>(i);
  return result;
}

/// Levels of points around a start. The neighbors that a point meets first follow each other by degree, then by number.
class Levels {
 public:
  explicit Levels(const PointNeighbors& graph) : graph_(graph), seen_in_(to_index(graph.points()), 0) {}

  /// Appends all points that are connected with `start` to `order`; the number of levels.
  std::int32_t grow(std::int32_t start, Numbers& order) {
    ++search_;
    std::size_t begin = order.size();
    order.push_back(start);
    seen_in_[to_index(start)] = search_;
    std::int32_t levels = 0;
    for (; begin < order.size(); ++levels) {
      last_level_ = begin;
      for (const std::size_t end = order.size(); begin < end; ++begin) {
        const auto met = static_cast<std::ptrdiff_t>(order.size());
        for (const std::int32_t v : graph_.of(order[begin]))
          if (std::exchange(seen_in_[to_index(v)], search_) != search_) order.push_back(v);
        std::sort(order.begin() + met, order.end(), [&](std::int32_t a, std::int32_t b) {
          return std::pair(graph_.of(a).size(), a) < std::pair(graph_.of(b).size(), b);
        });
      }
    }
    return levels;
  }

  /// Where the last level of the last search begins.
  [[nodiscard]] std::size_t last_level() const { return last_level_; }
  [[nodiscard]] bool is_seen(std::int32_t v) const { return seen_in_[to_index(v)] != 0; }

 private:
  const PointNeighbors& graph_;
  std::vector<std::int32_t> seen_in_;  // the last search that has met each point
  std::int32_t search_ = 0;
  std::size_t last_level_ = 0;
};

/// Each connected part from a point that is far from another one: the point of least degree in the last level around
/// the last such point, as long as levels become more.
Numbers reverse_cuthill_mckee(const Mesh& mesh) {
  const PointNeighbors graph(mesh.points.size(), mesh.triangles);
  Levels levels(graph);
  Numbers order;
  order.reserve(mesh.points.size());
  for (std::int32_t v = 0; v < graph.points(); ++v) {
    if (levels.is_seen(v)) continue;
    const std::size_t begin = order.size();
    std::int32_t start = v;
    for (std::int32_t most = 0;;) {
      const std::int32_t count = levels.grow(start, order);
      if (count <= most) break;
      most = count;
      start =
          *std::min_element(order.begin() + static_cast<std::ptrdiff_t>(levels.last_level()), order.end(),
                            [&](std::int32_t a, std::int32_t b) { return graph.of(a).size() < graph.of(b).size(); });
      order.resize(begin);
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

Numbers along_hilbert_curve(const Mesh& mesh) {
  Numbers order;
  order.reserve(mesh.points.size());
  for (const std::size_t v : in_hilbert_order(mesh.points)) order.push_back(static_cast<std::int32_t>(v));
  return order;
}

/// Triangles by their lowest points, those of one point as they were.
Numbers by_lowest_point(const Mesh& mesh) {
  std::vector<std::int32_t> next(mesh.points.size() + 1, 0);
  const auto lowest = [](const auto& triangle) { return to_index(*std::ranges::min_element(triangle)); };
  for (const auto& triangle : mesh.triangles) ++next[lowest(triangle) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  Numbers order(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    order[to_index(next[lowest(mesh.triangles[t])]++)] = static_cast<std::int32_t>(t);
  return order;
}

/// Values with `each` numbers for one thing. An empty array stays empty.
template <class T>
void permute(std::vector<T>& values, const Numbers& old_of_new, std::size_t each = 1) {
  if (values.empty()) return;
  std::vector<T> moved;
  moved.reserve(values.size());
  for (const std::int32_t old : old_of_new)
    moved.insert(moved.end(), values.begin() + static_cast<std::ptrdiff_t>(to_index(old) * each),
                 values.begin() + static_cast<std::ptrdiff_t>((to_index(old) + 1) * each));
  values.swap(moved);
}

void order_points(Mesh& mesh, const Numbers& old_of_new) {
  permute(mesh.points, old_of_new);
  permute(mesh.point_markers, old_of_new);
  permute(mesh.numbers, old_of_new);
  permute(mesh.attributes, old_of_new, to_index(mesh.attributes_per_point));
  const Numbers new_of_old = inverse(old_of_new);
  const auto rename = [&](std::int32_t& v) { v = new_of_old[to_index(v)]; };
  for (auto& triangle : mesh.triangles) std::ranges::for_each(triangle, rename);
  for (Mesh::Edge& edge : mesh.edges) rename(edge.a), rename(edge.b);
  for (Mesh::Weir& weir : mesh.weirs) {
    std::ranges::for_each(weir.points, rename);
    std::ranges::for_each(weir.across, rename);
  }
}

void order_triangles(Mesh& mesh) {
  const Numbers old_of_new = by_lowest_point(mesh);
  permute(mesh.triangles, old_of_new);
  permute(mesh.regions, old_of_new);
  permute(mesh.subdomains, old_of_new);
  permute(mesh.ranks, old_of_new);
}

}  // namespace

MeshOrder mesh_order_from(const std::string& word) {
  for (const auto& [order, name] : kMeshOrders)
    if (word == name) return order;
  throw InputError({"order", 0}, "is '" + word + "'", "it must be given, hilbert or rcm");
}

Mesh ordered(Mesh mesh, MeshOrder order) {
  if (order == MeshOrder::kGiven) return mesh;
  order_points(mesh, order == MeshOrder::kRcm ? reverse_cuthill_mckee(mesh) : along_hilbert_curve(mesh));
  order_triangles(mesh);
  return mesh;
}

std::int64_t bandwidth(const Mesh& mesh) {
  std::int64_t widest = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto [low, high] = std::ranges::minmax(triangle);
    widest = std::max<std::int64_t>(widest, high - low);
  }
  return widest;
}

}  // namespace driftmesh
