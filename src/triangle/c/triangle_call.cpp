#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/triangle.h"
#include "triangle/triangulate.hpp"

namespace driftmesh::triangle {
namespace {

using Unsuitable = int (*)(REAL*, REAL*, REAL*, REAL);

thread_local std::string last_error;
thread_local Unsuitable unsuitable_function = nullptr;

template <class T>
std::vector<T> copied(const T* list, std::size_t count) {
  return list == nullptr ? std::vector<T>() : std::vector<T>(list, list + count);
}

std::vector<Point> points_of(const REAL* list, int count) {
  std::vector<Point> points;
  for (int i = 0; list != nullptr && i < count; ++i) points.push_back({list[2 * i], list[2 * i + 1]});
  return points;
}

std::size_t product(int a, int b) {
  return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

Tables tables_from(const triangulateio& in, const Switches& switches, int first) {
  Tables tables;
  tables.points = points_of(in.pointlist, in.numberofpoints);
  tables.attributes_per_point = in.pointattributelist == nullptr ? 0 : in.numberofpointattributes;
  tables.point_attributes = copied(in.pointattributelist, product(in.numberofpoints, in.numberofpointattributes));
  tables.point_markers = copied(in.pointmarkerlist, in.numberofpoints);
  if (switches.refine) {
    tables.corners = std::max(3, in.numberofcorners);
    tables.triangles = copied(in.trianglelist, product(in.numberoftriangles, tables.corners));
    tables.attributes_per_triangle = in.triangleattributelist == nullptr ? 0 : in.numberoftriangleattributes;
    tables.triangle_attributes =
        copied(in.triangleattributelist, product(in.numberoftriangles, in.numberoftriangleattributes));
    if (switches.given_areas) tables.triangle_areas = copied(in.trianglearealist, in.numberoftriangles);
  }
  for (int& v : tables.triangles) v -= first;
  if (!switches.pslg) return tables;
  for (int s = 0; in.segmentlist != nullptr && s < in.numberofsegments; ++s)
    tables.segments.push_back({in.segmentlist[2 * s] - first, in.segmentlist[2 * s + 1] - first});
  tables.segment_markers = copied(in.segmentmarkerlist, in.numberofsegments);
  if (switches.refine) return tables;
  tables.holes = points_of(in.holelist, in.numberofholes);
  const std::vector<double> regions = copied(in.regionlist, product(in.numberofregions, 4));
  for (std::size_t r = 0; r < regions.size(); r += 4)
    tables.regions.push_back({{regions[r], regions[r + 1]}, regions[r + 2], regions[r + 3]});
  return tables;
}

/// Lists that are allocated for an output, until all are complete.
class Outputs {
 public:
  Outputs() = default;
  ~Outputs() {
    for (const auto& [list, memory] : allocated_) std::free(memory);
  }
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// Makes room for a list; the caller's if there is some.
  template <class T>
  void add(T*& list, std::size_t count) {
    if (list != nullptr) return;
    void* const memory = std::malloc(std::max<std::size_t>(1, count) * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    allocated_.emplace_back(reinterpret_cast<void**>(&list), memory);
  }
  void hand_over() {
    for (const auto& [list, memory] : allocated_) *list = memory;
    allocated_.clear();
  }

 private:
  std::vector<std::pair<void**, void*>> allocated_;
};

template <class T>
void write(const std::vector<T>& values, T* list) {
  std::copy(values.begin(), values.end(), list);
}
void write(const std::vector<Point>& points, REAL* list) {
  for (const auto& [x, y] : points) *list++ = x, *list++ = y;
}
/// Numbers other than -1 count from `first`.
template <std::size_t N>
void write(const std::vector<std::array<std::int32_t, N>>& rows, int first, int* list) {
  for (const auto& row : rows)
    for (const std::int32_t number : row) *list++ = number < 0 ? number : number + first;
}

/// Which lists the switches ask for.
struct OutputLists {
  bool points, markers, attributes, triangles, triangle_attributes, neighbors, segments, edges;
};

OutputLists lists_of(const Switches& s, const Tables& mesh) {
  return {.points = !s.no_points,
          .markers = !s.no_points && !s.no_markers,
          .attributes = !s.no_points && mesh.attributes_per_point > 0,
          .triangles = !s.no_triangles,
          .triangle_attributes = !s.no_triangles && mesh.attributes_per_triangle > 0,
          .neighbors = s.neighbors,
          .segments = (s.pslg || (s.hull && !s.refine)) && !s.no_segments,
          .edges = s.edges};
}

void allocate(const OutputLists& has, const Switches& switches, const Tables& mesh, triangulateio& out,
              Outputs& lists) {
  if (has.points) lists.add(out.pointlist, 2 * mesh.points.size());
  if (has.markers) lists.add(out.pointmarkerlist, mesh.points.size());
  if (has.attributes) lists.add(out.pointattributelist, mesh.point_attributes.size());
  if (has.triangles) lists.add(out.trianglelist, mesh.triangles.size());
  if (has.triangle_attributes) lists.add(out.triangleattributelist, mesh.triangle_attributes.size());
  if (has.neighbors) lists.add(out.neighborlist, 3 * mesh.neighbors.size());
  if (has.segments) lists.add(out.segmentlist, 2 * mesh.segments.size());
  if (has.segments && !switches.no_markers) lists.add(out.segmentmarkerlist, mesh.segments.size());
  if (has.edges) lists.add(out.edgelist, 2 * mesh.edges.size());
  if (has.edges && !switches.no_markers) lists.add(out.edgemarkerlist, mesh.edges.size());
}

void fill(const OutputLists& has, const Switches& switches, const Tables& mesh, int first, triangulateio& out) {
  if (has.points) write(mesh.points, out.pointlist);
  if (has.markers) write(mesh.point_markers, out.pointmarkerlist);
  if (has.attributes) write(mesh.point_attributes, out.pointattributelist);
  if (has.triangles)
    std::ranges::transform(mesh.triangles, out.trianglelist, [first](std::int32_t v) { return v + first; });
  if (has.triangle_attributes) write(mesh.triangle_attributes, out.triangleattributelist);
  if (has.neighbors) write(mesh.neighbors, first, out.neighborlist);
  if (has.segments) write(mesh.segments, first, out.segmentlist);
  if (has.segments && !switches.no_markers) write(mesh.segment_markers, out.segmentmarkerlist);
  if (has.edges) write(mesh.edges, first, out.edgelist);
  if (has.edges && !switches.no_markers) write(mesh.edge_markers, out.edgemarkerlist);
  out.numberofpoints = static_cast<int>(mesh.points.size());
  out.numberofpointattributes = mesh.attributes_per_point;
  out.numberoftriangles = static_cast<int>(mesh.triangle_count());
  out.numberofcorners = mesh.corners;
  out.numberoftriangleattributes = mesh.attributes_per_triangle;
  out.numberofsegments = has.segments ? static_cast<int>(mesh.segments.size()) : 0;
  out.numberofedges = has.edges ? static_cast<int>(mesh.edges.size()) : 0;
}

void allocate(const Voronoi& voronoi, triangulateio& out, Outputs& lists) {
  lists.add(out.pointlist, 2 * voronoi.points.size());
  if (!voronoi.point_attributes.empty()) lists.add(out.pointattributelist, voronoi.point_attributes.size());
  lists.add(out.edgelist, 2 * voronoi.edges.size());
  lists.add(out.normlist, 2 * voronoi.directions.size());
}

void fill(const Voronoi& voronoi, int first, int attributes, triangulateio& out) {
  write(voronoi.points, out.pointlist);
  if (!voronoi.point_attributes.empty()) write(voronoi.point_attributes, out.pointattributelist);
  write(voronoi.edges, first, out.edgelist);
  write(voronoi.directions, out.normlist);
  out.numberofpoints = static_cast<int>(voronoi.points.size());
  out.numberofpointattributes = attributes;
  out.numberofedges = static_cast<int>(voronoi.edges.size());
}

void call(const char* text, const triangulateio& in, triangulateio& out, triangulateio* vorout) {
  const Switches switches = parse_switches(text);
  if (switches.voronoi && vorout == nullptr)
    throw Error("switch v asks for a Voronoi diagram, but vorout is NULL; give a structure for it");
  Switches all = switches;  // counts are of all there is
  all.no_points = all.no_triangles = false;
  const int first = switches.from_zero ? 0 : 1;
  Caller caller;
  if (const Unsuitable function = unsuitable_function; function != nullptr)
    caller.unsuitable = [function](Point a, Point b, Point c, double area) {
      REAL corners[3][2] = {{a.x, a.y}, {b.x, b.y}, {c.x, c.y}};
      return function(corners[0], corners[1], corners[2], area) != 0;
    };
  const Tables input = tables_from(in, switches, first);
  const Result result = triangulate(input, all, caller);
  if (switches.verbose && !switches.quiet) std::fputs(statistics(input, result.mesh).c_str(), stdout);
  Outputs lists;
  const OutputLists has = lists_of(switches, result.mesh);
  allocate(has, switches, result.mesh, out, lists);
  if (switches.voronoi) allocate(result.voronoi, *vorout, lists);
  lists.hand_over();
  fill(has, switches, result.mesh, first, out);
  if (switches.voronoi) fill(result.voronoi, first, result.mesh.attributes_per_point, *vorout);
  if (!switches.pslg) return;
  out.holelist = in.holelist;
  out.numberofholes = in.numberofholes;
  out.regionlist = in.regionlist;
  out.numberofregions = in.numberofregions;
}

}  // namespace
}  // namespace driftmesh::triangle

extern "C" {

int driftmesh_triangulate(const char* switches, const triangulateio* in, triangulateio* out, triangulateio* vorout) {
  using driftmesh::triangle::last_error;
  last_error.clear();
  try {
    driftmesh::triangle::call(switches, *in, *out, vorout);
    return 0;
  } catch (const std::bad_alloc&) {
    last_error = "there is not enough memory; ask for fewer triangles";
  } catch (const std::exception& error) {
    last_error = error.what();
  }
  return 1;
}

const char* driftmesh_triangle_error() {
  return driftmesh::triangle::last_error.c_str();
}

void driftmesh_set_triunsuitable(int (*unsuitable)(REAL*, REAL*, REAL*, REAL)) {
  driftmesh::triangle::unsuitable_function = unsuitable;
}

void triangulate(char* switches, triangulateio* in, triangulateio* out, triangulateio* vorout) {
  if (driftmesh_triangulate(switches, in, out, vorout) == 0) return;
  std::fprintf(stderr, "triangulate: %s\n", driftmesh_triangle_error());
  std::exit(1);
}

void trifree(void* list) {
  std::free(list);
}

}  // extern "C"
