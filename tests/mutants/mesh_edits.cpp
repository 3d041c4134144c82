#include "mutants/mesh_edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <utility>

namespace driftmesh::mutants {
namespace {

class MeshEditor {
  std::uint64_t below(std::uint64_t end) { return random_() % end; }
  double part() { return static_cast<double>(below(1U << 20)) / (1U << 20); }
  template <class Items>
  auto& one_of(Items& items) {
    return *std::next(std::begin(items), static_cast<std::ptrdiff_t>(below(std::size(items))));
  }

 public:
  MeshEditor(Mesh mesh, std::uint64_t seed) : random_(seed * 0x9e3779b97f4a7c15U + 1), mesh_(std::move(mesh)) {}

  struct Kind {
    const char* name;
    std::string (MeshEditor::*edit)();
  };
  static constexpr std::size_t kKinds = 30;
  static const std::array<Kind, kKinds>& kinds();

  MeshMutant run() {
    std::vector<std::string> edits;
    for (std::uint64_t left = 1 + below(8) / 6 + below(8) / 7; left > 0; --left) {
      if (broken_arrays_ || mesh_.triangles.empty()) break;
      const Kind& kind = one_of(kinds());
      edits.push_back(std::string(kind.name) + ": " + (this->*kind.edit)());
    }
    return {std::move(mesh_), std::move(edits)};
  }

 private:
  std::size_t triangle() { return below(mesh_.triangles.size()); }
  std::int32_t corner() { return mesh_.triangles[triangle()][below(3)]; }
  std::int32_t point() { return static_cast<std::int32_t>(below(mesh_.points.size())); }
  Point& at(std::int32_t v) { return mesh_.points[static_cast<std::size_t>(v)]; }
  static std::string words(const Point& p) { return fmt::format("({:.17g}, {:.17g})", p.x, p.y); }

  std::string move(std::int32_t v, const Point& to) {
    std::string text = fmt::format("point {} from {} to {}", v, words(at(v)), words(to));
    at(v) = to;
    return text;
  }

  // ---- Points ----

  std::string onto_point() { return move(point(), at(point())); }
  std::string onto_neighbor() {
    const auto& triangle = mesh_.triangles[this->triangle()];
    const std::uint64_t k = below(3);
    return move(triangle[k], at(triangle[(k + 1) % 3]));
  }
  std::string onto_end_of_subsegment() {
    if (mesh_.edges.empty()) return onto_neighbor();
    const Mesh::Edge& edge = one_of(mesh_.edges);
    return below(2) == 0 ? move(edge.a, at(edge.b)) : move(edge.b, at(edge.a));
  }
  Point between(const Point& a, const Point& b) {
    const double t = below(2) == 0 ? 0.5 : part();
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
  }
  /// Opposite, or any.
  std::string onto_edge() {
    const auto& t = mesh_.triangles[triangle()];
    const std::uint64_t k = below(3);
    const Point place = between(at(t[(k + 1) % 3]), at(t[(k + 2) % 3]));
    return move(below(4) == 0 ? point() : t[k], place);
  }
  std::string onto_subsegment() {
    if (mesh_.edges.empty()) return onto_edge();
    const Mesh::Edge& edge = one_of(mesh_.edges);
    return move(point(), between(at(edge.a), at(edge.b)));
  }
  /// A point where two subsegments meet, toward the next one: along a straight line it stays on it.
  std::string along_subsegments() {
    if (mesh_.edges.empty()) return onto_edge();
    const Mesh::Edge edge = one_of(mesh_.edges);
    const Point a = at(edge.a), b = at(edge.b);
    const double t = 0.25 * part();
    return move(edge.a, {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
  }
  std::string to_single_precision() {
    const bool all = below(2) == 0;
    const std::int32_t chosen = point();
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh_.points.size()); ++v)
      if (all || v == chosen) at(v) = {static_cast<float>(at(v).x), static_cast<float>(at(v).y)};
    return all ? "all points" : fmt::format("point {}", chosen);
  }
  std::string a_little() {
    const std::int32_t v = corner();
    Point to = at(v);
    for (std::uint64_t left = 1 + below(100); left > 0; --left) to.x = std::nextafter(to.x, 1e30);
    return move(v, to);
  }
  std::string into_its_triangle() {
    const auto& [a, b, c] = mesh_.triangles[triangle()];
    const double share = 0.2 * part();
    const Point center{at(a).x / 3 + at(b).x / 3 + at(c).x / 3, at(a).y / 3 + at(b).y / 3 + at(c).y / 3};
    return move(a, {at(a).x + share * (center.x - at(a).x), at(a).y + share * (center.y - at(a).y)});
  }
  std::string far() {
    constexpr std::array kPlaces{1e-300,
                                 1e300,
                                 1e60,
                                 -1e12,
                                 1e5,
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
    const std::int32_t v = point();
    Point to = at(v);
    (below(2) == 0 ? to.x : to.y) = one_of(kPlaces);
    return move(v, to);
  }
  std::string negative_zeros() {
    for (Point& p : mesh_.points) {
      if (p.x == 0) p.x = -p.x;
      if (p.y == 0) p.y = -p.y;
    }
    return "every 0 becomes -0";
  }

  // ---- Triangles ----

  void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, std::size_t like) {
    mesh_.triangles.push_back({a, b, c});
    if (!mesh_.regions.empty()) mesh_.regions.push_back(double{mesh_.regions[like]});
    if (!mesh_.subdomains.empty()) mesh_.subdomains.push_back(std::int32_t{mesh_.subdomains[like]});
    if (!mesh_.ranks.empty()) mesh_.ranks.push_back(std::int32_t{mesh_.ranks[like]});
  }
  void drop_triangle(std::size_t t) {
    const auto drop = [t](auto& array) {
      if (!array.empty()) array.erase(array.begin() + static_cast<std::ptrdiff_t>(t));
    };
    drop(mesh_.triangles);
    drop(mesh_.regions);
    drop(mesh_.subdomains);
    drop(mesh_.ranks);
  }
  void add_point(const Point& p, std::int32_t like) {
    const auto width = static_cast<std::size_t>(std::max(0, mesh_.attributes_per_point));
    mesh_.points.push_back(p);
    if (!mesh_.point_markers.empty())
      mesh_.point_markers.push_back(std::int32_t{mesh_.point_markers[static_cast<std::size_t>(like)]});
    for (std::size_t i = 0; i < width; ++i)
      mesh_.attributes.push_back(double{mesh_.attributes[static_cast<std::size_t>(like) * width + i]});
  }

  std::string double_triangle() {
    const std::size_t t = triangle();
    const auto [a, b, c] = mesh_.triangles[t];
    if (below(2) == 0)
      add_triangle(a, b, c, t);
    else
      add_triangle(b, c, a, t);
    return fmt::format("triangle {}", t);
  }
  std::string turn_triangle() {
    if (below(8) == 0) {
      for (auto& [a, b, c] : mesh_.triangles) std::swap(b, c);
      return "all triangles";
    }
    const std::size_t t = triangle();
    std::swap(mesh_.triangles[t][0], mesh_.triangles[t][1]);
    return fmt::format("triangle {}", t);
  }
  std::string remove_triangle() {
    const std::size_t t = triangle();
    drop_triangle(t);
    return fmt::format("triangle {}", t);
  }
  std::string remove_around_point() {
    const std::int32_t v = corner();
    for (std::size_t t = mesh_.triangles.size(); t-- > 0;)
      if (std::ranges::find(mesh_.triangles[t], v) != mesh_.triangles[t].end()) drop_triangle(t);
    return fmt::format("point {}", v);
  }
  std::string exchange_corner() {
    const std::size_t t = triangle();
    std::int32_t& exchanged = mesh_.triangles[t][below(3)];
    const std::int32_t other = corner();
    if (std::ranges::find(mesh_.triangles[t], other) != mesh_.triangles[t].end()) return "none";
    return fmt::format("of triangle {}: {} becomes {}", t, std::exchange(exchanged, other), other);
  }
  /// As in a hole, or beyond the border.
  std::string add_any_triangle() {
    const std::int32_t a = corner(), b = corner(), c = corner();
    if (a == b || b == c || c == a) return "none";
    const bool left = (at(b).x - at(a).x) * (at(c).y - at(a).y) - (at(b).y - at(a).y) * (at(c).x - at(a).x) > 0;
    add_triangle(a, left ? b : c, left ? c : b, 0);
    return fmt::format("{} {} {}", a, b, c);
  }
  /// The triangle on the other side of the edge behind corner k of a triangle.
  std::size_t across(std::size_t t, std::size_t k) {
    const std::int32_t a = mesh_.triangles[t][(k + 1) % 3], b = mesh_.triangles[t][(k + 2) % 3];
    for (std::size_t s = 0; s < mesh_.triangles.size(); ++s)
      for (std::size_t i = 0; i < 3; ++i)
        if (mesh_.triangles[s][i] == b && mesh_.triangles[s][(i + 1) % 3] == a) return s;
    return t;
  }
  std::int32_t apex(std::size_t t, std::int32_t a, std::int32_t b) {
    for (const std::int32_t v : mesh_.triangles[t])
      if (v != a && v != b) return v;
    return a;
  }
  std::string flip_edge() {
    const std::size_t t = triangle(), k = below(3), s = across(t, k);
    if (s == t) return "none";
    const std::int32_t p = mesh_.triangles[t][k], a = mesh_.triangles[t][(k + 1) % 3],
                       b = mesh_.triangles[t][(k + 2) % 3];
    const std::int32_t q = apex(s, a, b);
    if (p == q) return "none";
    mesh_.triangles[t] = {p, a, q};
    mesh_.triangles[s] = {p, q, b};
    return fmt::format("{} {}", a, b);
  }
  std::string split_triangle() {
    const std::size_t t = triangle();
    const auto [a, b, c] = mesh_.triangles[t];
    const auto v = static_cast<std::int32_t>(mesh_.points.size());
    add_point({at(a).x / 3 + at(b).x / 3 + at(c).x / 3, at(a).y / 3 + at(b).y / 3 + at(c).y / 3}, a);
    mesh_.triangles[t] = {a, b, v};
    add_triangle(b, c, v, t);
    add_triangle(c, a, v, t);
    return fmt::format("triangle {}", t);
  }
  /// On one side, which leaves a vertex on an edge of the other triangle, or on both.
  std::string split_edge() {
    const std::size_t t = triangle(), k = below(3);
    const std::size_t s = below(2) == 0 ? across(t, k) : t;
    const std::int32_t p = mesh_.triangles[t][k], a = mesh_.triangles[t][(k + 1) % 3],
                       b = mesh_.triangles[t][(k + 2) % 3];
    const auto v = static_cast<std::int32_t>(mesh_.points.size());
    add_point({at(a).x / 2 + at(b).x / 2, at(a).y / 2 + at(b).y / 2}, a);
    mesh_.triangles[t] = {p, a, v};
    add_triangle(p, v, b, t);
    if (s != t) {
      const std::int32_t q = apex(s, a, b);
      mesh_.triangles[s] = {q, v, a};
      add_triangle(q, b, v, s);
    }
    if (below(2) == 0) split_subsegment(a, b, v);
    return fmt::format("{} {}{}", a, b, s == t ? ", on one side" : "");
  }
  void split_subsegment(std::int32_t a, std::int32_t b, std::int32_t v) {
    for (std::size_t i = 0; i < mesh_.edges.size(); ++i) {
      Mesh::Edge& edge = mesh_.edges[i];
      if (std::minmax(edge.a, edge.b) != std::minmax(a, b)) continue;
      const Mesh::Edge rest{v, edge.b, edge.marker};
      edge.b = v;
      mesh_.edges.push_back(rest);
      return;
    }
  }

  // ---- Seams ----

  /// The points of some edges in a row are doubled, and the triangles on one side get the twins; the edges may be
  /// listed on both sides.
  std::string open_seam() {
    std::vector<std::int32_t> way = walk(2 + below(3));
    if (way.size() < 2) return "none";
    std::map<std::int32_t, std::int32_t> twin;
    const bool ends_too = below(2) == 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      if (!ends_too && (i == 0 || i + 1 == way.size())) continue;
      twin[way[i]] = static_cast<std::int32_t>(mesh_.points.size());
      add_point(Point(at(way[i])), way[i]);
    }
    const Point a = at(way.front()), b = at(way.back());
    for (auto& triangle : mesh_.triangles) {
      double side = 0;
      for (const std::int32_t v : triangle) side += (b.x - a.x) * (at(v).y - a.y) - (b.y - a.y) * (at(v).x - a.x);
      if (side <= 0) continue;
      for (std::int32_t& v : triangle)
        if (const auto other = twin.find(v); other != twin.end()) v = other->second;
    }
    if (below(2) == 0)
      for (std::size_t i = 1; i < way.size(); ++i) {
        const auto beyond = [&](std::int32_t v) { return twin.contains(v) ? twin[v] : v; };
        mesh_.edges.push_back({way[i - 1], way[i], 1});
        mesh_.edges.push_back({beyond(way[i - 1]), beyond(way[i]), 1});
      }
    return fmt::format("of {} points from {}{}", way.size(), way.front(), ends_too ? ", with its ends" : "");
  }
  std::vector<std::int32_t> walk(std::size_t length) {
    std::vector<std::int32_t> way{corner()};
    for (const auto& triangle : mesh_.triangles) {
      const auto here = std::ranges::find(triangle, way.back());
      if (here == triangle.end() || way.size() == length) continue;
      const std::int32_t next = triangle[static_cast<std::size_t>(here - triangle.begin() + 1) % 3];
      if (std::ranges::find(way, next) == way.end()) way.push_back(next);
    }
    return way;
  }

  // ---- Subsegments, and what things carry ----

  std::string drop_subsegment() {
    if (mesh_.edges.empty()) return "none";
    if (below(6) == 0) return mesh_.edges.clear(), "all";
    const auto s = static_cast<std::ptrdiff_t>(below(mesh_.edges.size()));
    mesh_.edges.erase(mesh_.edges.begin() + s);
    return fmt::format("subsegment {}", s);
  }
  std::string double_subsegment() {
    if (mesh_.edges.empty()) return "none";
    const Mesh::Edge edge = one_of(mesh_.edges);
    mesh_.edges.push_back(below(2) == 0 ? edge : Mesh::Edge{edge.b, edge.a, edge.marker});
    return fmt::format("{} {}", edge.a, edge.b);
  }
  std::string turn_subsegment() {
    if (mesh_.edges.empty()) return "none";
    Mesh::Edge& edge = one_of(mesh_.edges);
    std::swap(edge.a, edge.b);
    return fmt::format("{} {}", edge.a, edge.b);
  }
  std::string add_subsegment() {
    const auto& triangle = mesh_.triangles[this->triangle()];
    const std::uint64_t k = below(3);
    const Mesh::Edge edge{triangle[k], below(4) == 0 ? corner() : triangle[(k + 1) % 3], 1};
    if (edge.a == edge.b) return "none";
    mesh_.edges.push_back(edge);
    return fmt::format("{} {}", edge.a, edge.b);
  }
  std::string change_marker() {
    if (mesh_.edges.empty()) return "none";
    Mesh::Edge& edge = one_of(mesh_.edges);
    const std::int32_t other = one_of(mesh_.edges).marker;
    return fmt::format("of subsegment {} {} from {} to {}", edge.a, edge.b, std::exchange(edge.marker, other), other);
  }
  std::string change_carried() {
    constexpr std::array kChanges{&MeshEditor::change_point_marker, &MeshEditor::change_region,
                                  &MeshEditor::change_attribute, &MeshEditor::change_subdomain};
    return (this->*one_of(kChanges))();
  }
  std::string change_point_marker() {
    if (mesh_.point_markers.empty()) return "none";
    const std::uint64_t v = below(mesh_.point_markers.size());
    const std::int32_t other = one_of(mesh_.point_markers);
    return fmt::format("of point {} from {} to {}", v, std::exchange(mesh_.point_markers[v], other), other);
  }
  std::string change_region() {
    if (mesh_.regions.empty()) return "none";
    if (below(8) == 0) return mesh_.regions.clear(), "none are listed";
    const std::size_t t = triangle();
    const double other = below(2) == 0 ? double{one_of(mesh_.regions)} : 99;
    return fmt::format("of triangle {} from {} to {}", t, std::exchange(mesh_.regions[t], other), other);
  }
  std::string change_attribute() {
    if (mesh_.attributes.empty()) return "none";
    one_of(mesh_.attributes) += 1;
    return "of a point";
  }
  std::string change_subdomain() {
    if (mesh_.subdomains.empty()) mesh_.subdomains.assign(mesh_.triangles.size(), 0);
    const std::size_t t = triangle();
    ++mesh_.subdomains[t];
    return fmt::format("of triangle {}", t);
  }

  // ---- Arrays ----

  std::string break_arrays() {
    broken_arrays_ = true;
    const auto count = static_cast<std::int32_t>(mesh_.points.size());
    constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();
    const std::array<std::int32_t, 4> kIndices{-1, count, kLargest, -kLargest - 1};
    switch (below(8)) {
      case 0:
        mesh_.triangles[triangle()][below(3)] = one_of(kIndices);
        return "a corner of a triangle";
      case 1:
        mesh_.edges.push_back({one_of(kIndices), one_of(kIndices), 1});
        return "an end of a subsegment";
      case 2:
        mesh_.regions.assign(mesh_.triangles.size() + 1, 0);
        return "regions";
      case 3:
        mesh_.point_markers.assign(mesh_.points.size() + 1, 0);
        return "point markers";
      case 4:
        mesh_.attributes_per_point = one_of(kIndices);
        return "attributes per point";
      case 5:
        mesh_.attributes.push_back(0);
        return "attributes";
      case 6:
        mesh_.subdomains.assign(mesh_.triangles.size() + 1, 0);
        return "subdomains";
      default:
        mesh_.points.pop_back();
        return "points";
    }
  }
  std::string add_unused_point() {
    add_point(Point(at(corner())), corner());
    return "in the place of another";
  }
  std::string permute() {
    std::vector<std::int32_t> place(mesh_.points.size());
    std::iota(place.begin(), place.end(), 0);
    std::shuffle(place.begin(), place.end(), random_);
    Mesh other = mesh_;
    const auto width = static_cast<std::size_t>(mesh_.attributes_per_point);
    for (std::size_t v = 0; v < place.size(); ++v) {
      const auto to = static_cast<std::size_t>(place[v]);
      other.points[to] = mesh_.points[v];
      if (!mesh_.point_markers.empty()) other.point_markers[to] = mesh_.point_markers[v];
      for (std::size_t i = 0; i < width; ++i) other.attributes[to * width + i] = mesh_.attributes[v * width + i];
    }
    for (auto& [a, b, marker] : other.edges) {
      a = place[static_cast<std::size_t>(a)];
      b = place[static_cast<std::size_t>(b)];
    }
    std::shuffle(other.edges.begin(), other.edges.end(), random_);
    std::vector<std::size_t> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random_);
    for (std::size_t t = 0; t < order.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k)
        other.triangles[t][(k + t) % 3] = place[static_cast<std::size_t>(mesh_.triangles[order[t]][k])];
      if (!mesh_.regions.empty()) other.regions[t] = mesh_.regions[order[t]];
      if (!mesh_.subdomains.empty()) other.subdomains[t] = mesh_.subdomains[order[t]];
      if (!mesh_.ranks.empty()) other.ranks[t] = mesh_.ranks[order[t]];
    }
    mesh_ = std::move(other);
    return "points, triangles, their corners, subsegments";
  }

  std::mt19937_64 random_;
  Mesh mesh_;
  bool broken_arrays_ = false;
};

const std::array<MeshEditor::Kind, MeshEditor::kKinds>& MeshEditor::kinds() {
  static constexpr std::array<Kind, kKinds> kAll{{
      {"onto a point", &MeshEditor::onto_point},
      {"onto a neighbor", &MeshEditor::onto_neighbor},
      {"onto the end of a subsegment", &MeshEditor::onto_end_of_subsegment},
      {"onto an edge", &MeshEditor::onto_edge},
      {"onto a subsegment", &MeshEditor::onto_subsegment},
      {"along subsegments", &MeshEditor::along_subsegments},
      {"to single precision", &MeshEditor::to_single_precision},
      {"a little", &MeshEditor::a_little},
      {"into a triangle", &MeshEditor::into_its_triangle},
      {"far", &MeshEditor::far},
      {"negative zeros", &MeshEditor::negative_zeros},
      {"double a triangle", &MeshEditor::double_triangle},
      {"turn a triangle", &MeshEditor::turn_triangle},
      {"remove a triangle", &MeshEditor::remove_triangle},
      {"remove triangles around a point", &MeshEditor::remove_around_point},
      {"exchange a corner", &MeshEditor::exchange_corner},
      {"add a triangle", &MeshEditor::add_any_triangle},
      {"flip an edge", &MeshEditor::flip_edge},
      {"split a triangle", &MeshEditor::split_triangle},
      {"split an edge", &MeshEditor::split_edge},
      {"open a seam", &MeshEditor::open_seam},
      {"drop subsegments", &MeshEditor::drop_subsegment},
      {"double a subsegment", &MeshEditor::double_subsegment},
      {"turn a subsegment", &MeshEditor::turn_subsegment},
      {"add a subsegment", &MeshEditor::add_subsegment},
      {"change a marker", &MeshEditor::change_marker},
      {"change what a point or triangle carries", &MeshEditor::change_carried},
      {"break arrays", &MeshEditor::break_arrays},
      {"add an unused point", &MeshEditor::add_unused_point},
      {"permute", &MeshEditor::permute},
  }};
  return kAll;
}

}  // namespace

MeshMutant mutant_of(const std::vector<MeshSample>& samples, std::uint64_t seed) {
  return MeshEditor(sample_of(samples, seed).mesh, seed).run();
}

std::vector<std::string> mesh_edit_kinds() {
  std::vector<std::string> names;
  for (const MeshEditor::Kind& kind : MeshEditor::kinds()) names.emplace_back(kind.name);
  return names;
}

}  // namespace driftmesh::mutants
