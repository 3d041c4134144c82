#pragma once

#include <memory>

#include "driftmesh/size_field.hpp"

namespace driftmesh::python {

/// A size field of the library as an object of Python. The library asks it without Python's help.
struct FieldObject {
  std::shared_ptr<const SizeField> field;
};

}  // namespace driftmesh::python
