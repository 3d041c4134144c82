#include "patch/point_data.hpp"

#include <algorithm>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::patch {

std::vector<NamedField> take_point_data(Mesh& mesh) {
  std::vector<NamedField> fields;
  const auto width = static_cast<std::size_t>(std::max(0, mesh.attributes_per_point));
  if (mesh.attributes.size() != width * mesh.points.size())
    throw Error(formatted("there are {} values of attributes for {} points; {} are expected", mesh.attributes.size(),
                          mesh.points.size(), width * mesh.points.size()));
  if (!mesh.attribute_names.empty() && mesh.attribute_names.size() != width)
    throw Error(
        formatted("there are {} names of attributes for {} values at each point", mesh.attribute_names.size(), width));
  for (std::size_t k = 0; k < width; ++k) {
    NamedField named{
        mesh.attribute_names.empty() ? "attribute" + (width > 1 ? std::to_string(k) : "") : mesh.attribute_names[k],
        {}};
    for (std::size_t v = 0; v < mesh.points.size(); ++v) named.field.values.push_back(mesh.attributes[v * width + k]);
    fields.push_back(std::move(named));
  }
  mesh.attributes.clear();
  return fields;
}

void conserve(NamedField& named, bool in_another_domain) {
  if (in_another_domain)
    throw Error(
        formatted("the integral of '{}' cannot stay where the domain becomes another one; interpolate it", named.name));
  named.field.how = Transfer::kConserve;
  adapt::require_summable(named.name, named.field);
}

void give_point_data(Mesh& mesh, const std::vector<adapt::Field>& fields) {
  mesh.attributes.resize(mesh.points.size() * fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k)
    for (std::size_t v = 0; v < mesh.points.size(); ++v) mesh.attributes[v * fields.size() + k] = fields[k].values[v];
}

}  // namespace driftmesh::patch
