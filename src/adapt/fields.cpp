#include "adapt/fields.hpp"

#include <utility>

#include "adapt/conserve.hpp"
#include "adapt/interpolate.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {

Field make_field(const Mesh& mesh, const std::string& name, std::vector<double> values, FieldPlace place,
                 Transfer how) {
  const bool at_points = place == FieldPlace::kPoints, at_corners = place == FieldPlace::kCorners;
  const std::size_t places = at_points ? mesh.points.size() : (at_corners ? 3 : 1) * mesh.triangles.size();
  const char* const what = at_points ? "points" : at_corners ? "corners of triangles" : "triangles";
  if (values.empty() || values.size() % places != 0)
    throw Error("attach: field '" + name + "' has " + std::to_string(values.size()) + " values for " +
                std::to_string(places) + " " + what + "; give the same number for each of the present mesh");
  if (!at_points && how != Transfer::kConserve)
    throw Error("attach: field '" + name + "' has values at " + what +
                ", which are not interpolated; let their integrals be conserved");
  const std::size_t components = values.size() / places;
  return {place, how, components, std::move(values)};
}

Fields carried(const Fields& fields, const Lineage& lineage) {
  Fields next;
  for (const auto& [name, field] : fields) {
    const bool at_points = field.place == FieldPlace::kPoints;
    const auto transfer = !at_points
                              ? (field.place == FieldPlace::kCorners ? conserved_at_corners : conserved_at_triangles)
                          : field.how == Transfer::kConserve ? conserved_at_points
                                                             : interpolated_at_points;
    next[name] = {field.place, field.how, field.components, transfer(lineage, field.values, field.components)};
  }
  return next;
}

}  // namespace driftmesh::adapt
