#include <pybind11/pybind11.h>

#include "classes.hpp"
#include "driftmesh/version.hpp"
#include "errors.hpp"

PYBIND11_MODULE(_native, module) {
  module.doc() = "The compiled part of driftmesh.";
  module.attr("__version__") = DRIFTMESH_VERSION;
  driftmesh::python::translate_errors();
  driftmesh::python::add_mesh_classes(module);
  driftmesh::python::add_report_class(module);
  driftmesh::python::add_functions(module);
  driftmesh::python::add_triangle_call(module);
  driftmesh::python::add_size_class(module);
  driftmesh::python::add_adaptive_class(module);
  driftmesh::python::add_adapt_part(module);
  driftmesh::python::add_decomposition_class(module);
  driftmesh::python::add_plot(module);
  driftmesh::python::add_load_class(module);
}
