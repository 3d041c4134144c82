#pragma once

#include <pybind11/pybind11.h>

namespace driftmesh::python {

// The classes and functions of the module, by their files.
void add_adaptive_class(pybind11::module_& module);
void add_adapt_part(pybind11::module_& module);
void add_mesh_classes(pybind11::module_& module);
void add_report_class(pybind11::module_& module);
void add_load_class(pybind11::module_& module);
void add_size_class(pybind11::module_& module);
void add_decomposition_class(pybind11::module_& module);
void add_plot(pybind11::module_& module);
void add_functions(pybind11::module_& module);
void add_triangle_call(pybind11::module_& module);

}  // namespace driftmesh::python
