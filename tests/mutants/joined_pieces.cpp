#include "mutants/joined_pieces.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "mutants/declared_mesh.hpp"
#include "mutants/fields.hpp"

namespace driftmesh::mutants {
namespace {

class Whole {
 public:
  explicit Whole(std::vector<Mesh> pieces) : pieces_(std::move(pieces)) {}

  Mesh merged() {
    for (const Mesh& piece : pieces_)
      if (piece.numbers.size() != piece.points.size()) throw Undeclared("points without numbers");
    has_markers_ = all([](const Mesh& p) { return p.point_markers.size() == p.points.size(); });
    for (const Mesh& piece : pieces_)
      whole_.attributes_per_point = std::max(whole_.attributes_per_point, piece.attributes_per_point);
    if (!all([&](const Mesh& p) { return p.points.empty() || p.attributes_per_point == whole_.attributes_per_point; }))
      throw Undeclared("other attributes in other pieces");
    merge_points();
    merge_triangles();
    merge_edges();
    return std::move(whole_);
  }

 private:
  struct SharedPoint {
    Point at;
    std::int32_t marker = 0;
    std::vector<double> attributes;

    [[nodiscard]] bool same_as(const SharedPoint& other) const {
      Mesh one, two;
      one.points = {at}, two.points = {other.at};
      one.attributes = attributes, two.attributes = other.attributes;
      return difference(one, two).empty() && marker == other.marker;
    }
  };

  template <class Tells>
  bool all(Tells tells) const {
    return std::ranges::all_of(pieces_, tells);
  }

  SharedPoint shared_point(const Mesh& piece, std::size_t v) const {
    const auto width = static_cast<std::ptrdiff_t>(whole_.attributes_per_point);
    const auto begin = piece.attributes.begin() + static_cast<std::ptrdiff_t>(v) * width;
    return {piece.points[v], has_markers_ ? piece.point_markers[v] : 0, {begin, begin + width}};
  }

  void merge_points() {
    std::map<std::int64_t, SharedPoint> points;
    for (const Mesh& piece : pieces_) {
      if (std::set(piece.numbers.begin(), piece.numbers.end()).size() != piece.numbers.size())
        throw Undeclared("a number twice in a piece");
      for (std::size_t v = 0; v < piece.points.size(); ++v) {
        const SharedPoint point = shared_point(piece, v);
        if (!points.emplace(piece.numbers[v], point).first->second.same_as(point))
          throw Undeclared("pieces that contradict each other");
      }
    }
    std::int64_t next = 0;
    for (const auto& [number, point] : points) {
      if (number != next++) throw Undeclared("a number is missing");
      whole_.points.push_back(point.at);
      if (has_markers_) whole_.point_markers.push_back(point.marker);
      whole_.attributes.insert(whole_.attributes.end(), point.attributes.begin(), point.attributes.end());
    }
  }

  void merge_triangles() {
    const bool has_regions = all([](const Mesh& p) { return p.regions.size() == p.triangles.size(); });
    const bool has_subdomains = all([](const Mesh& p) { return p.subdomains.size() == p.triangles.size(); });
    const bool has_ranks = all([](const Mesh& p) { return p.ranks.size() == p.triangles.size(); });
    std::vector<std::tuple<std::int32_t, std::size_t, std::size_t>> order;  // subdomain, piece, triangle
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      for (std::size_t t = 0; t < pieces_[k].triangles.size(); ++t)
        order.emplace_back(has_subdomains ? pieces_[k].subdomains[t] : 0, k, t);
    std::sort(order.begin(), order.end());
    for (const auto& [subdomain, k, t] : order) {
      const Mesh& piece = pieces_[k];
      auto& triangle = whole_.triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = number(piece, piece.triangles[t][i]);
      if (has_regions) whole_.regions.push_back(piece.regions[t]);
      if (has_subdomains) whole_.subdomains.push_back(piece.subdomains[t]);
      if (has_ranks) whole_.ranks.push_back(piece.ranks[t]);
    }
  }

  static std::int32_t number(const Mesh& piece, std::int32_t v) {
    return static_cast<std::int32_t>(piece.numbers[static_cast<std::size_t>(v)]);
  }

  /// By their ends; what several pieces have, once.
  void merge_edges() {
    using Key = std::tuple<std::int32_t, std::int32_t, std::int32_t>;
    std::map<Key, std::vector<std::pair<std::size_t, Mesh::Edge>>> edges;
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      for (const Mesh::Edge& edge : pieces_[k].edges) {
        const Mesh::Edge e{number(pieces_[k], edge.a), number(pieces_[k], edge.b), edge.marker};
        edges[{std::min(e.a, e.b), std::max(e.a, e.b), e.marker}].emplace_back(k, e);
      }
    for (const auto& [key, copies] : edges)
      for (std::size_t i = 0; i < copies.size(); ++i)
        if (i == 0 || copies[i].first == copies[i - 1].first) whole_.edges.push_back(copies[i].second);
  }

  std::vector<Mesh> pieces_;
  bool has_markers_ = false;
  Mesh whole_;
};

}  // namespace

Mesh joined(std::vector<Mesh> pieces) {
  return Whole(std::move(pieces)).merged();
}

}  // namespace driftmesh::mutants
