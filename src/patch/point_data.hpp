#pragma once

#include <string>
#include <vector>

#include "adapt/fields.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::patch {

/// Point data of a mesh, by their name: "attribute", or "attribute0" and so on, for those that have none.
struct NamedField {
  std::string name;
  adapt::Field field;
};

/// Takes all point data out of a mesh, as fields of their own that are interpolated. The mesh keeps their names. Throws
/// Error if values or names are too many or too few.
[[nodiscard]] std::vector<NamedField> take_point_data(Mesh& mesh);

/// From now on the integral of the field stays. Throws Error, with its name, if it cannot: in another domain, or where
/// values cannot be summed up.
void conserve(NamedField& named, bool in_another_domain);

/// Puts as many fields back, in their order.
void give_point_data(Mesh& mesh, const std::vector<adapt::Field>& fields);

}  // namespace driftmesh::patch
