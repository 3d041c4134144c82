#include "patch/carry.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>

#include "adapt/conserve.hpp"
#include "adapt/interpolate.hpp"
#include "adapt/lineage.hpp"
#include "adapt/locator.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh::patch {
namespace {

/// What a transfer of fields sees of a part.
adapt::Generation generation_of(const Mesh& mesh, Triangulation triangulation) {
  adapt::Generation generation;
  auto whole = std::make_shared<SubdomainMesh>();
  whole->mesh = std::move(triangulation);
  generation.parts.push_back({std::move(whole)});
  IdVector<VertexId, std::int32_t> places(mesh.points.size());
  std::iota(places.begin(), places.end(), 0);
  generation.here.push_back(SubdomainId{0});
  generation.holders.push_back(Rank{0});
  generation.places.push_back(std::move(places));
  generation.first_triangle.push_back(0);
  generation.piece.mesh.points = mesh.points;
  generation.piece.mesh.triangles = mesh.triangles;
  return generation;
}

/// Values of some places, in their order.
std::vector<double> taken_from(const std::vector<double>& values, std::size_t each,
                               const std::vector<std::int32_t>& places) {
  std::vector<double> taken;
  taken.reserve(places.size() * each);
  for (const std::int32_t place : places)
    for (std::size_t k = 0; k < each; ++k) taken.push_back(values[to_index(place) * each + k]);
  return taken;
}

/// Values where nothing changed, and in the others' places those of the part: the first ones of `made`.
std::vector<double> put_together(const std::vector<double>& old, std::size_t each,
                                 const std::vector<std::int32_t>& from, const std::vector<double>& made,
                                 const std::vector<std::int32_t>& places) {
  std::vector<double> values(from.size() * each);
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t k = 0; from[i] >= 0 && k < each; ++k) values[i * each + k] = old[to_index(from[i]) * each + k];
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < each; ++k) values[to_index(places[i]) * each + k] = made[i * each + k];
  return values;
}

/// For each triangle that was made, the old one in which its center lies.
std::vector<std::int32_t> triangles_at_centers(const Triangulation& before, const NewPart& made) {
  const adapt::Locator locator(before);
  std::vector<std::int32_t> triangles;
  for (std::size_t t = 0; t < made.triangles_made; ++t) {
    Point center;
    for (const std::int32_t v : made.mesh.triangles[t]) {
      center.x += made.mesh.points[to_index(v)].x / 3;
      center.y += made.mesh.points[to_index(v)].y / 3;
    }
    triangles.push_back(static_cast<std::int32_t>(to_index(locator.locate(center).triangle)));
  }
  return triangles;
}

std::size_t values_at(const adapt::Field& field) {
  return field.components * (field.place == FieldPlace::kCorners ? 3 : 1);
}

}  // namespace

void carry(std::vector<adapt::Field>& fields, const Part& part, const NewPart& made, Triangulation before,
           const Numbers& numbers) {
  if (fields.empty()) return;
  const adapt::Generation old_part = generation_of(part.mesh, std::move(before));
  const adapt::Generation next_part =
      generation_of(made.mesh, triangulation_of(made.mesh, triangle_neighbors(made.mesh)));
  OneRank alone;
  const adapt::Lineage lineage(old_part, next_part, 1, alone);
  std::vector<std::vector<double>> old;
  for (const adapt::Field& field : fields)
    old.push_back(
        taken_from(field.values, values_at(field), field.place == FieldPlace::kPoints ? part.point : part.triangle));
  std::vector<adapt::ConservedField> conserving;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].how == Transfer::kConserve) conserving.push_back({fields[i].place, fields[i].components, old[i]});
  std::vector<std::vector<double>> conserved = adapt::conserved(lineage, conserving);
  const bool taken_at_centers = std::ranges::any_of(fields, [](const adapt::Field& field) {
    return field.place != FieldPlace::kPoints && field.how == Transfer::kInterpolate;
  });
  const std::vector<std::int32_t> at_centers =
      taken_at_centers ? triangles_at_centers(old_part.parts[SubdomainId{0}].mesh->mesh, made)
                       : std::vector<std::int32_t>();
  std::size_t taken = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    adapt::Field& field = fields[i];
    const bool at_points = field.place == FieldPlace::kPoints;
    const std::vector<double> values = field.how == Transfer::kConserve ? std::move(conserved[taken++])
                                       : at_points ? adapt::interpolated_at_points(lineage, old[i], field.components)
                                                   : taken_from(old[i], field.components, at_centers);
    field.values = put_together(field.values, values_at(field), at_points ? numbers.old_points : numbers.old_triangles,
                                values, at_points ? numbers.points : numbers.triangles);
  }
}

}  // namespace driftmesh::patch
