#include "patch/carry.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>

#include "adapt/interpolate.hpp"
#include "adapt/lineage.hpp"
#include "adapt/locator.hpp"
#include "adapt/transfer.hpp"
#include "base/in_parts.hpp"
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

/// The old values in the order of new numbers, where nothing changed; the others are 0.
std::vector<double> in_new_order(const std::vector<double>& old, std::size_t each,
                                 const std::vector<std::int32_t>& from) {
  std::vector<double> values(from.size() * each);
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t k = 0; from[i] >= 0 && k < each; ++k) values[i * each + k] = old[to_index(from[i]) * each + k];
  return values;
}

/// Puts values of the first ones of a part where they are in the whole.
void put(const std::vector<double>& made, std::size_t each, const std::vector<std::int32_t>& places,
         std::vector<double>& values) {
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < each; ++k) values[to_index(places[i]) * each + k] = made[i * each + k];
}

/// What is interpolated.
class Interpolation {
 public:
  Interpolation(const Part& part, const NewPart& made, const Triangulation& before, const Numbers& numbers,
                std::int32_t threads)
      : part_(part), made_(made), before_(before), numbers_(numbers), threads_(to_index(threads)) {}

  /// Adds a field whose old and new values outlive the object.
  void add(FieldPlace place, std::size_t each, const std::vector<double>& old, std::vector<double>& values) {
    (place == FieldPlace::kPoints ? at_points_ : at_triangles_).push_back({each, old, values});
  }

  void run() {
    if (!at_points_.empty())
      for_each(made_.old_point.size(), [&](const adapt::Locator& locator, std::size_t v) {
        if (made_.old_point[v] < 0) take_point(locator.locate(made_.mesh.points[v]), to_index(numbers_.points[v]));
      });
    if (!at_triangles_.empty())
      for_each(made_.triangles_made, [&](const adapt::Locator& locator, std::size_t t) {
        if (made_.old_triangle[t] < 0)
          take_triangle(locator.locate(center(t)).triangle, to_index(numbers_.triangles[t]));
      });
  }

 private:
  struct Carried {
    std::size_t each;
    const std::vector<double>& old;
    std::vector<double>& values;
  };

  template <class Take>
  void for_each(std::size_t count, const Take& take) const {
    in_parts(count, threads_, [&](std::size_t, std::size_t begin, std::size_t end) {
      const adapt::Locator locator(before_);
      for (std::size_t i = begin; i < end; ++i) take(locator, i);
    });
  }

  [[nodiscard]] Point center(std::size_t t) const {
    Point center;
    for (const std::int32_t v : made_.mesh.triangles[t]) {
      center.x += made_.mesh.points[to_index(v)].x / 3;
      center.y += made_.mesh.points[to_index(v)].y / 3;
    }
    return center;
  }

  void take_point(const adapt::Locator::Place& place, std::size_t number) const {
    std::array<std::size_t, 3> from{};
    for (int i = 0; i < 3; ++i)
      from[i] = to_index(
          part_.point[to_index(before_.triangles[place.triangle].vertex[place.is_vertex() ? place.corner : i])]);
    for (const Carried& field : at_points_)
      for (std::size_t k = 0; k < field.each; ++k) {
        const auto at = [&](std::size_t i) { return field.old[from[i] * field.each + k]; };
        double& value = field.values[number * field.each + k];
        value = place.is_vertex() ? at(0) : adapt::interpolated(place.weight, {at(0), at(1), at(2)});
      }
  }

  void take_triangle(TriangleId old, std::size_t number) const {
    const std::size_t from = to_index(part_.triangle[to_index(old)]);
    for (const Carried& field : at_triangles_)
      for (std::size_t k = 0; k < field.each; ++k)
        field.values[number * field.each + k] = field.old[from * field.each + k];
  }

  const Part& part_;
  const NewPart& made_;
  const Triangulation& before_;
  const Numbers& numbers_;
  std::size_t threads_;
  std::vector<Carried> at_points_, at_triangles_;
};

}  // namespace

void carry(std::vector<adapt::Field>& fields, const Part& part, const NewPart& made, Triangulation before,
           const Numbers& numbers, std::int32_t threads) {
  std::vector<std::vector<double>> old;
  for (adapt::Field& field : fields) old.push_back(std::move(field.values));
  Interpolation interpolation(part, made, before, numbers, threads);
  std::vector<adapt::Field> of_part;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    adapt::Field& field = fields[i];
    const bool at_points = field.place == FieldPlace::kPoints;
    field.values = in_new_order(old[i], values_at(field), at_points ? numbers.old_points : numbers.old_triangles);
    if (field.how == Transfer::kConserve)
      of_part.push_back({field.place, field.how, field.components,
                         taken_from(old[i], values_at(field), at_points ? part.point : part.triangle)});
    else
      interpolation.add(field.place, values_at(field), old[i], field.values);
  }
  interpolation.run();
  if (of_part.empty()) return;
  const adapt::Generation old_part = generation_of(part.mesh, std::move(before));
  const adapt::Generation next_part =
      generation_of(made.mesh, triangulation_of(made.mesh, triangle_neighbors(made.mesh)));
  OneRank alone;
  const adapt::Lineage lineage(old_part, next_part, 1, alone);
  std::vector<const adapt::Field*> conserving;
  for (const adapt::Field& field : of_part) conserving.push_back(&field);
  std::vector<adapt::Field*> conserved;
  for (adapt::Field& field : fields)
    if (field.how == Transfer::kConserve) conserved.push_back(&field);
  const std::vector<std::vector<double>> values = adapt::transferred(lineage, conserving);
  for (std::size_t i = 0; i < conserved.size(); ++i)
    put(values[i], values_at(*conserved[i]),
        conserved[i]->place == FieldPlace::kPoints ? numbers.points : numbers.triangles, conserved[i]->values);
}

}  // namespace driftmesh::patch
