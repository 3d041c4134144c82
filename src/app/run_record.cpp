#include "app/run_record.hpp"

#include <algorithm>
#include <array>

#include "geometry/triangle_geometry.hpp"
#include "mesh/digest.hpp"

namespace driftmesh::app {
namespace {

constexpr std::array kCauses{ExceptionCause::kInputAngle, ExceptionCause::kShell, ExceptionCause::kPrecision,
                             ExceptionCause::kUnexplained};

const char* cause_words(ExceptionCause cause, bool complete) {
  switch (cause) {
    case ExceptionCause::kInputAngle:
      return "small angle of the input";
    case ExceptionCause::kShell:
      return "wedge between input segments";
    case ExceptionCause::kPrecision:
    case ExceptionCause::kUnexplained:
      break;
  }
  return complete ? "no room between coordinates" : "not reached";
}

Point centroid(const Triangulation& mesh, TriangleId t) {
  const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
}

/// The corner with the smallest angle: the one opposite to the shortest edge.
const Point& sharpest_corner(const Triangulation& mesh, TriangleId t) {
  std::array<double, 3> opposite{};
  for (int i = 0; i < 3; ++i)
    opposite[static_cast<std::size_t>(i)] = squared_distance(mesh.corner(t, next(i)), mesh.corner(t, previous(i)));
  return mesh.corner(t, static_cast<int>(std::min_element(opposite.begin(), opposite.end()) - opposite.begin()));
}

/// Notes the place unless it is there already, or enough are.
void add_place(RunRecord::ExceptionGroup& group, const Point& place) {
  if (group.places.size() < RunRecord::ExceptionGroup::kMaxPlaces &&
      std::find(group.places.begin(), group.places.end(), place) == group.places.end())
    group.places.push_back(place);
}

void add_skinny(RunRecord& run, const Triangulation& mesh, std::vector<Exceptions::Item> skinny) {
  std::stable_sort(skinny.begin(), skinny.end(),
                   [](const auto& a, const auto& b) { return a.smallest_angle < b.smallest_angle; });
  for (const ExceptionCause cause : kCauses) {
    RunRecord::ExceptionGroup group{cause_words(cause, run.complete), 0, 180, {}};
    for (const Exceptions::Item& item : skinny) {
      if (item.cause != cause) continue;
      ++group.count;
      group.worst_angle = std::min(group.worst_angle, item.smallest_angle);
      add_place(group, sharpest_corner(mesh, item.triangle));
    }
    if (group.count > 0) run.exceptions.push_back(std::move(group));
  }
}

void add_large(RunRecord& run, const Triangulation& mesh, const std::vector<TriangleId>& large) {
  if (large.empty()) return;
  RunRecord::ExceptionGroup group{"area or size bound missed", static_cast<std::int64_t>(large.size()), 180, {}};
  for (std::size_t i = 0; i < std::min(large.size(), group.kMaxPlaces); ++i) add_place(group, centroid(mesh, large[i]));
  run.exceptions.push_back(std::move(group));
}

}  // namespace

void record_mesh(RunRecord& run, const MeshResult& result) {
  const Triangulation& mesh = result.mesh;
  run.complete = result.complete;
  run.triangles = static_cast<std::int64_t>(mesh.live_triangles());
  run.vertices = static_cast<std::int64_t>(mesh.live_vertices());
  run.subsegments =
      std::count_if(mesh.subsegments.begin(), mesh.subsegments.end(), [](const auto& s) { return s.is_leaf(); });
  run.acute_corners = result.acute_corners;
  run.counters = result.counters;
  run.shape = summarize_angles(mesh);
  run.digest = mesh_digest(mesh);
  Exceptions found = find_exceptions(mesh, result.bounds);
  add_skinny(run, mesh, std::move(found.skinny));
  add_large(run, mesh, found.large);
}

}  // namespace driftmesh::app
