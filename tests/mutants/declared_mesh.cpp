#include "mutants/declared_mesh.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace driftmesh::mutants {
namespace {

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same(const Point& a, const Point& b) {
  return same(a.x, b.x) && same(a.y, b.y);
}
template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}

template <class T>
std::string difference_in(const char* what, const std::vector<T>& read, const std::vector<T>& declared) {
  if (read.size() != declared.size())
    return std::to_string(read.size()) + " " + what + " instead of " + std::to_string(declared.size());
  for (std::size_t i = 0; i < read.size(); ++i)
    if (!same(read[i], declared[i])) return "other " + std::string(what) + " at " + std::to_string(i);
  return "";
}

}  // namespace

void turn_if_seen_from_below(Mesh& mesh) {
  double twice_area = 0;
  for (const auto& t : mesh.triangles) {
    const Point &a = mesh.points[static_cast<std::size_t>(t[0])], &b = mesh.points[static_cast<std::size_t>(t[1])],
                &c = mesh.points[static_cast<std::size_t>(t[2])];
    twice_area += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  if (twice_area < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

std::string difference(const Mesh& read, const Mesh& declared) {
  for (const std::string& found : {
           difference_in("points", read.points, declared.points),
           difference_in("triangles", read.triangles, declared.triangles),
           difference_in("edges", read.edges, declared.edges),
           difference_in("point markers", read.point_markers, declared.point_markers),
           difference_in("attributes", read.attributes, declared.attributes),
           difference_in("regions", read.regions, declared.regions),
           difference_in("point numbers", read.numbers, declared.numbers),
           difference_in("subdomains", read.subdomains, declared.subdomains),
           difference_in("ranks", read.ranks, declared.ranks),
       })
    if (!found.empty()) return found;
  return read.attributes_per_point == declared.attributes_per_point ? "" : "another number of attributes";
}

}  // namespace driftmesh::mutants
