#pragma once

#include <pybind11/pybind11.h>

namespace driftmesh::python {

// The classes and functions of the module, by their files.
void add_adaptive_on_ranks(pybind11::module_& module);
void add_distributed(pybind11::module_& module);
void add_simulated(pybind11::module_& module);

}  // namespace driftmesh::python
