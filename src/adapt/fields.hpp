#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "adapt/lineage.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::adapt {

/// Values that go from one generation to the next.
struct Field {
  FieldPlace place = FieldPlace::kPoints;
  Transfer how = Transfer::kInterpolate;
  std::size_t components = 1;  ///< values at each place
  std::vector<double> values;
};
using Fields = std::map<std::string, Field>;

/// Throws Error if the number of values does not suit the mesh, or what is asked for is not possible.
[[nodiscard]] Field make_field(const Mesh& mesh, const std::string& name, std::vector<double> values, FieldPlace place,
                               Transfer how);

/// The fields on the new mesh.
[[nodiscard]] Fields carried(const Fields& fields, const Lineage& lineage);

}  // namespace driftmesh::adapt
