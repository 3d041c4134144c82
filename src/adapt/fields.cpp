#include "adapt/fields.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapt/shared_points.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {

std::string shape_text(const std::vector<std::int64_t>& shape) {
  std::string text;
  for (const std::int64_t n : shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
  return "(" + text + ")";
}

const char* words_of(FieldPlace place) {
  if (place == FieldPlace::kPoints) return "points";
  return place == FieldPlace::kCorners ? "corners of triangles" : "triangles";
}

Field make_field(const Mesh& mesh, const std::string& name, std::vector<double> values, FieldPlace place,
                 Transfer how) {
  const bool at_points = place == FieldPlace::kPoints, at_corners = place == FieldPlace::kCorners;
  const std::size_t places = at_points ? mesh.points.size() : (at_corners ? 3 : 1) * mesh.triangles.size();
  const char* const what = words_of(place);
  const bool fits = places == 0 ? values.empty() : !values.empty() && values.size() % places == 0;
  if (!fits)
    throw Error("attach: field '" + name + "' has " + std::to_string(values.size()) + " values for " +
                std::to_string(places) + " " + what + "; give the same number for each of the present mesh");
  if (!at_points && how != Transfer::kConserve)
    throw Error("attach: field '" + name + "' has values at " + what +
                ", which are not interpolated; let their integrals be conserved");
  const std::size_t components = places == 0 ? 0 : values.size() / places;
  return {place, how, components, std::move(values)};
}

void require_shape(const std::string& name, const std::vector<std::int64_t>& shape, std::size_t components) {
  std::size_t left = components;
  for (const std::int64_t n : shape) {
    const bool divides = n > 0 && left % static_cast<std::size_t>(n) == 0;
    left = divides ? left / static_cast<std::size_t>(n) : 0;
  }
  if (left == 1) return;
  throw Error(formatted("field '{}' has {} values at each place, which have no shape {}; give a shape of so many", name,
                        components, shape_text(shape)));
}

void require_summable(const std::string& name, const Field& field, const DistributedPiece* piece) {
  constexpr double kMost = 1e250;  // sums over areas stay finite
  if (field.how != Transfer::kConserve) return;
  const bool at_points = field.place == FieldPlace::kPoints;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    const std::size_t place = i / values_at(field);
    if (std::abs(field.values[i]) <= kMost) continue;  // not for NaN
    if (at_points && piece != nullptr && piece->owners[place] != piece->rank) continue;
    throw Error(
        formatted("field '{}' is {} at {} {} (counted from 0), so its integral cannot be conserved; give it "
                  "values from -{} to {}",
                  name, field.values[i], at_points ? "point" : "triangle", place, kMost, kMost));
  }
}

void take_from_owners(Fields& fields, const DistributedPiece& piece, Ranks& ranks) {
  const auto visit = [&](std::int32_t point, const auto& value) {
    for (auto& [name, field] : fields)
      if (field.place == FieldPlace::kPoints)
        std::for_each_n(field.values.begin() + to_index(point) * field.components, field.components, value);
  };
  tell_at_shared_points(
      ranks, piece,
      [&](std::int32_t point, ByteWriter& writer) { visit(point, [&](double value) { writer.value(value); }); },
      [&](std::int32_t point, ByteReader& reader, Rank from) {
        const bool counts = piece.owners[to_index(point)] == from;
        visit(point, [&](double& value) {
          const auto theirs = reader.value<double>();
          if (counts) value = theirs;
        });
      });
}

Fields carried(const Fields& fields, const Lineage& lineage, Stayed& stayed) {
  std::vector<const Field*> old;
  for (const auto& [name, field] : fields) old.push_back(&field);
  std::vector<std::vector<double>> values = transferred(lineage, old, &stayed);
  Fields next;
  auto made = values.begin();
  for (const auto& [name, field] : fields) next[name] = {field.place, field.how, field.components, std::move(*made++)};
  return next;
}

}  // namespace driftmesh::adapt
