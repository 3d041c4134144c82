#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "geometry/midpoint.hpp"
#include "mesh/cdt.hpp"
#include "mesh/to_piece.hpp"
#include "oracles/mesh_oracle.hpp"
#include "oracles/meshing.hpp"
#include "oracles/random_pslg.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

// The verification against an independent mesher: CGAL's triangulations and meshes are accepted, the brute-force
// oracles agree with that, and random damage to them is found.

using namespace driftmesh;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
using Mesher = CGAL::Delaunay_mesher_2<Cdt, CGAL::Delaunay_mesh_size_criteria_2<Cdt>>;

Kernel::Point_2 cgal_point(const Point& p) {
  return {p.x, p.y};
}

Cdt cgal_triangulation(const Pslg& input) {
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> vertices;
  for (const Point& p : input.points) vertices.push_back(cdt.insert(cgal_point(p)));
  for (const auto& s : input.segments)
    cdt.insert_constraint(vertices[static_cast<std::size_t>(s.a)], vertices[static_cast<std::size_t>(s.b)]);
  return cdt;
}

/// Marks everything reachable from a seed without crossing a constraint as outside.
void carve(Cdt& cdt, const Pslg& input) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->set_in_domain(true);
  std::deque<Cdt::Face_handle> queue{cdt.infinite_face()};
  for (const Point& hole : input.holes) queue.push_back(cdt.locate(cgal_point(hole)));
  while (!queue.empty()) {
    const Cdt::Face_handle f = queue.front();
    queue.pop_front();
    if (!f->is_in_domain()) continue;
    f->set_in_domain(false);
    for (int i = 0; i < 3; ++i)
      if (!cdt.is_constrained({f, i})) queue.push_back(f->neighbor(i));
  }
}

/// The input segment whose line the midpoint of an edge is closest to, among those that span it.
std::int32_t marker_of(const Pslg& input, const Point& a, const Point& b) {
  std::int32_t marker = -1;
  double best = HUGE_VAL;
  for (const auto& s : input.segments) {
    const Point &p = input.points[static_cast<std::size_t>(s.a)], &q = input.points[static_cast<std::size_t>(s.b)];
    const double dx = q.x - p.x, dy = q.y - p.y, length2 = dx * dx + dy * dy;
    const auto off = [&](const Point& v) {
      const double t = std::clamp(((v.x - p.x) * dx + (v.y - p.y) * dy) / length2, 0.0, 1.0);
      return std::hypot(p.x + t * dx - v.x, p.y + t * dy - v.y);
    };
    if (const double d = off(a) + off(b) + off(midpoint(a, b)); d < best) {
      best = d;
      marker = s.marker;
    }
  }
  return marker;
}

Mesh to_mesh(const Cdt& cdt, const Pslg& input) {
  Mesh mesh;
  std::map<Cdt::Vertex_handle, std::int32_t> number;
  const auto take = [&](Cdt::Vertex_handle v) {
    const auto [entry, added] = number.try_emplace(v, static_cast<std::int32_t>(mesh.points.size()));
    if (added) mesh.points.push_back({v->point().x(), v->point().y()});
    return entry->second;
  };
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f)
    if (f->is_in_domain()) mesh.triangles.push_back({take(f->vertex(0)), take(f->vertex(1)), take(f->vertex(2))});
  for (auto e = cdt.finite_edges_begin(); e != cdt.finite_edges_end(); ++e) {
    const auto& [f, i] = *e;
    if (!cdt.is_constrained(*e) || !(f->is_in_domain() || f->neighbor(i)->is_in_domain())) continue;
    const std::int32_t a = take(f->vertex(cdt.ccw(i))), b = take(f->vertex(cdt.cw(i)));
    mesh.edges.push_back(
        {a, b, marker_of(input, mesh.points[static_cast<std::size_t>(a)], mesh.points[static_cast<std::size_t>(b)])});
  }
  return mesh;
}

bool accepted(const Mesh& mesh, const Pslg& input) {
  const VerifyReport report = verify(mesh, input, {});
  if (!report.accepted()) MESSAGE(report_text(report, {}));
  return report.accepted();
}

std::vector<bool> no_segment_outside(const Pslg& input) {
  return std::vector<bool>(input.segments.size(), false);
}

using Places = std::pair<std::pair<double, double>, std::pair<double, double>>;

/// The edges of a mesh by the coordinates of their ends.
std::set<Places> edges_by_place(const Mesh& mesh) {
  std::set<Places> edges;
  const auto place = [&](std::int32_t v) {
    const Point& p = mesh.points[static_cast<std::size_t>(v)];
    return std::pair(p.x, p.y);
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax({place(t[k]), place(t[(k + 1) % 3])}));
  return edges;
}

/// Whether some edge could be flipped equally well: the corners of its two triangles are cocircular.
bool has_choice(const Mesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> opposite;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) opposite[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
  for (const auto& edge : mesh.edges) opposite.erase({edge.a, edge.b});
  const auto at = [&](std::int32_t v) { return cgal_point(mesh.points[static_cast<std::size_t>(v)]); };
  return std::any_of(opposite.begin(), opposite.end(), [&](const auto& entry) {
    const auto& [ends, apex] = entry;
    const auto other = opposite.find({ends.second, ends.first});
    return other != opposite.end() && CGAL::side_of_oriented_circle(at(ends.first), at(ends.second), at(apex),
                                                                    at(other->second)) == CGAL::ON_ORIENTED_BOUNDARY;
  });
}

/// Applies a kind of damage to a mesh; false if it found no place for it.
bool flip_edge(Mesh& mesh, std::mt19937_64& random) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::size_t, std::size_t>> side;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) side[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = {t, k};
  for (const auto& edge : mesh.edges) {
    side.erase({edge.a, edge.b});
    side.erase({edge.b, edge.a});
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> inner;
  for (const auto& [ends, place] : side)
    if (side.count({ends.second, ends.first})) inner.push_back(ends);
  if (inner.empty()) return false;
  const auto [a, b] = inner[random() % inner.size()];
  const auto [t, k] = side[{a, b}];
  const auto [u, m] = side[{b, a}];
  const std::int32_t c = mesh.triangles[t][(k + 2) % 3], d = mesh.triangles[u][(m + 2) % 3];
  mesh.triangles[t] = {a, d, c};
  mesh.triangles[u] = {d, b, c};
  return true;
}

bool invert(Mesh& mesh, std::mt19937_64& random) {
  auto& t = mesh.triangles[random() % mesh.triangles.size()];
  std::swap(t[0], t[1]);
  return true;
}

bool drop_triangle(Mesh& mesh, std::mt19937_64& random) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(random() % mesh.triangles.size()));
  return true;
}

bool drop_subsegment(Mesh& mesh, std::mt19937_64& random) {
  mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(random() % mesh.edges.size()));
  return true;
}

bool change_marker(Mesh& mesh, std::mt19937_64& random) {
  mesh.edges[random() % mesh.edges.size()].marker += 1000;
  return true;
}

bool move_point(Mesh& mesh, std::mt19937_64& random) {
  const auto v = random() % mesh.points.size();
  const auto& other = mesh.points[(v + 1) % mesh.points.size()];
  mesh.points[v] = {(mesh.points[v].x + other.x) / 2, (mesh.points[v].y + other.y) / 2};
  return true;
}

bool redirect_corner(Mesh& mesh, std::mt19937_64& random) {
  auto& corner = mesh.triangles[random() % mesh.triangles.size()][random() % 3];
  const auto other = static_cast<std::int32_t>(random() % mesh.points.size());
  if (corner == other) return false;
  corner = other;
  return true;
}

}  // namespace

TEST_CASE("CGAL's constrained Delaunay triangulations are accepted, and the oracles agree") {
  int with_holes = 0, with_inner = 0, with_points = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    CAPTURE(seed);
    const auto random = oracles::make_random_pslg(seed, oracles::make_random_shape(seed));
    Cdt cdt = cgal_triangulation(random.input);
    carve(cdt, random.input);
    const Mesh mesh = to_mesh(cdt, random.input);
    REQUIRE(!mesh.triangles.empty());
    CHECK(accepted(mesh, random.input));
    CHECK(oracles::check_constrained_delaunay(mesh) == std::vector<std::string>{});
    const auto boundary = oracles::find_boundary(mesh);
    CHECK(boundary.size() == random.boundary_segments.size());
    CHECK(oracles::check_area(mesh, boundary) == std::vector<std::string>{});
    CHECK(oracles::check_coverage(mesh, random.input, 0, no_segment_outside(random.input)) ==
          std::vector<std::string>{});
    with_holes += !random.input.holes.empty();
    with_inner += random.input.segments.size() > random.boundary_segments.size();
    with_points += mesh.points.size() > random.boundary_segments.size();
  }
  CHECK(with_holes > 10);  // the generator is tested too
  CHECK(with_inner > 10);
  CHECK(with_points > 10);
}

TEST_CASE("our constrained Delaunay triangulation has CGAL's edges") {
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
    if (seed % 3 == 0) {  // too large for the brute-force oracles
      shape.outer_points = 60;
      shape.inner_points = 300;
      shape.inner_segments = 40;
      shape.holes = 6;
    }
    const auto random = oracles::make_random_pslg(seed, shape);
    CAPTURE(oracles::poly_text(random.input));
    Cdt cdt = cgal_triangulation(random.input);
    carve(cdt, random.input);
    const Mesh theirs = to_mesh(cdt, random.input);
    const Mesh ours = to_piece(driftmesh::triangulate(random.input), random.input);
    REQUIRE(accepted(ours, random.input));
    if (has_choice(theirs)) continue;
    ++compared;
    CHECK(edges_by_place(ours) == edges_by_place(theirs));
  }
  CHECK(compared > 50);
}

TEST_CASE("where four points are cocircular both triangulations are valid") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Pslg input;
    std::mt19937_64 random(seed);
    input.points = {{-1, -1}, {9, -1}, {9, 9}, {-1, 9}};
    input.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
    for (int i = 0; i < 40; ++i) {
      const Point p{static_cast<double>(random() % 9), static_cast<double>(random() % 9)};
      if (std::find(input.points.begin(), input.points.end(), p) == input.points.end()) input.points.push_back(p);
    }
    Cdt cdt = cgal_triangulation(input);
    carve(cdt, input);
    const Mesh theirs = to_mesh(cdt, input);
    CHECK(has_choice(theirs));
    CHECK(accepted(theirs, input));
    const Mesh ours = to_piece(driftmesh::triangulate(input), input);
    CHECK(accepted(ours, input));
    CHECK(ours.triangles.size() == theirs.triangles.size());
  }
}

TEST_CASE("random damage to CGAL's triangulations is found") {
  using Damage = bool (*)(Mesh&, std::mt19937_64&);
  const std::vector<std::pair<const char*, Damage>> damages = {
      {"flip an edge", flip_edge},           {"invert a triangle", invert},
      {"drop a triangle", drop_triangle},    {"drop a subsegment", drop_subsegment},
      {"change a marker", change_marker},    {"move a point", move_point},
      {"redirect a corner", redirect_corner}};
  for (const auto& [kind, damage] : damages) {
    const std::string name = kind;
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      CAPTURE(name);
      CAPTURE(seed);
      const auto random_input = oracles::make_random_pslg(seed, oracles::make_random_shape(seed));
      Cdt cdt = cgal_triangulation(random_input.input);
      carve(cdt, random_input.input);
      Mesh mesh = to_mesh(cdt, random_input.input);
      std::mt19937_64 random(seed);
      if (!damage(mesh, random)) continue;
      CHECK(!verify(mesh, random_input.input, {}).accepted());
      ++found;
    }
    CHECK(found > 12);
  }
}

TEST_CASE("CGAL's refined meshes are accepted with the angle bound that they were made for") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
    shape.spikiness = 0.1;
    shape.scale = 1;
    shape.dangling_segments = shape.inner_segments = 0;  // no small angles
    const auto random = oracles::make_random_pslg(seed, shape);
    Cdt cdt = cgal_triangulation(random.input);
    Mesher mesher(cdt, CGAL::Delaunay_mesh_size_criteria_2<Cdt>(0.125, 0.1));  // sin^2 of 20.7 degrees, edges of 0.1
    std::vector<Kernel::Point_2> holes;
    for (const Point& hole : random.input.holes) holes.push_back(cgal_point(hole));
    mesher.set_seeds(holes.begin(), holes.end(), false);
    mesher.refine_mesh();
    const Mesh mesh = to_mesh(cdt, random.input);
    REQUIRE(mesh.triangles.size() > 100);
    VerifyOptions options;
    options.plain.region_areas = false;
    VerifyReport report = verify(mesh, random.input, options);
    if (!report.accepted()) MESSAGE(report_text(report, options));
    CHECK(report.accepted());
    CHECK(report.quality.smallest_angle > 1);
    options.min_angle = report.quality.smallest_angle * 1.0001;
    CHECK(verify(mesh, random.input, options).findings.count(Flaw::kSmallAngle) +
              verify(mesh, random.input, options).quality.exception_count() >=
          1);
    options.min_angle = report.quality.smallest_angle * 0.9999;
    CHECK(verify(mesh, random.input, options).accepted());
  }
}
