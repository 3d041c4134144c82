#pragma once

#include <memory>

#include "driftmesh/decomposition.hpp"

namespace driftmesh::python {

/// A decomposition as an object of Python.
struct CutDomain {
  std::shared_ptr<const Decomposition> decomposition;
};

}  // namespace driftmesh::python
