#include "bench/cgal_mesher.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "bench/child_process.hpp"
#include "bench/shape.hpp"

namespace driftmesh::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Delaunay_mesh_vertex_base_2<Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Storage = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Storage>;
using CgalPoint = Triangulation::Point;

Point to_point(const CgalPoint& p) {
  return {p.x(), p.y()};
}

Shape face_shape(const Triangulation::Face_handle& face) {
  return shape_of(to_point(face->vertex(0)->point()), to_point(face->vertex(1)->point()),
                  to_point(face->vertex(2)->point()));
}

/// CGAL's meshing criteria with a bound on the area. The one that CGAL provides is not documented and takes the angle
/// bound in different units than its counterpart for edge lengths.
class AreaAndAngle {
 public:
  /// Orders the queue of bad triangles: oversize ones first, largest first, then the sharpest.
  struct Quality {
    double oversize = 0;  // area over bound
    double squared_sine = 0;
    bool operator<(const Quality& other) const {
      if (oversize > 1 || other.oversize > 1) return oversize > other.oversize;
      return squared_sine < other.squared_sine;
    }
  };

  class Is_bad {
   public:
    Is_bad(double area, double squared_sine) : area_(area), squared_sine_(squared_sine) {}
    CGAL::Mesh_2::Face_badness operator()(const Quality& quality) const {
      if (quality.oversize > 1) return CGAL::Mesh_2::IMPERATIVELY_BAD;
      return quality.squared_sine < squared_sine_ ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }
    CGAL::Mesh_2::Face_badness operator()(const Triangulation::Face_handle& face, Quality& quality) const {
      const Shape shape = face_shape(face);
      quality = {shape.area / area_, shape.squared_sine};
      return (*this)(quality);
    }

   private:
    double area_;
    double squared_sine_;
  };

  explicit AreaAndAngle(const Bounds& bounds)
      : area_(bounds.area), squared_sine_(std::pow(std::sin(bounds.degrees * std::numbers::pi / 180), 2)) {}
  [[nodiscard]] Is_bad is_bad_object() const { return {area_, squared_sine_}; }

 private:
  double area_;
  double squared_sine_;
};

std::vector<CgalPoint> to_cgal(const std::vector<Point>& points) {
  std::vector<CgalPoint> converted;
  converted.reserve(points.size());
  for (const Point& p : points) converted.emplace_back(p.x, p.y);
  return converted;
}

void insert(Triangulation& triangulation, const Pslg& pslg) {
  const std::vector<CgalPoint> points = to_cgal(pslg.points);
  std::vector<std::pair<std::size_t, std::size_t>> segments;
  segments.reserve(pslg.segments.size());
  for (const Pslg::Segment& s : pslg.segments) segments.emplace_back(s.a, s.b);
  triangulation.insert_constraints(points.begin(), points.end(), segments.begin(), segments.end());
}

/// Counts and extremes of the part of the triangulation that is marked as inside the domain.
void measure(const Triangulation& triangulation, MeshRun& run) {
  run.vertices = static_cast<std::int64_t>(triangulation.number_of_vertices());
  ShapeCensus census;
  for (const auto& face : triangulation.finite_face_handles())
    if (face->is_in_domain()) census.add(face_shape(face));
  census.store(run);
}

using Refiner = CGAL::Delaunay_mesher_2<Triangulation, AreaAndAngle>;

void mark_domain(Triangulation& triangulation, const Pslg& pslg) {
  const std::vector<CgalPoint> holes = to_cgal(pslg.holes);
  Refiner::mark_facets(triangulation, holes.begin(), holes.end());
}

MeshRun triangulate(const Pslg& pslg) {
  MeshRun run;
  Triangulation triangulation;
  const Stopwatch watch;
  insert(triangulation, pslg);
  run.seconds_cdt = watch.seconds();
  run.peak_bytes = peak_memory();
  mark_domain(triangulation, pslg);
  measure(triangulation, run);
  return run;
}

MeshRun refine(const Pslg& pslg, const Bounds& bounds) {
  MeshRun run;
  Triangulation triangulation;
  const Stopwatch cdt_watch;
  insert(triangulation, pslg);
  run.seconds_cdt = cdt_watch.seconds();

  const std::vector<CgalPoint> holes = to_cgal(pslg.holes);
  Refiner refiner(triangulation, AreaAndAngle(bounds));
  refiner.set_seeds(holes.begin(), holes.end());
  const Stopwatch refine_watch;
  refiner.refine_mesh();
  run.seconds_refine = refine_watch.seconds();
  run.peak_bytes = peak_memory();
  measure(triangulation, run);
  return run;
}

}  // namespace

const Mesher kCgal{"CGAL", triangulate, refine};

double domain_area(const Pslg& pslg) {
  Triangulation triangulation;
  insert(triangulation, pslg);
  mark_domain(triangulation, pslg);
  double area = 0;
  for (const auto& face : triangulation.finite_face_handles())
    if (face->is_in_domain()) area += face_shape(face).area;
  return area;
}

}  // namespace driftmesh::bench
