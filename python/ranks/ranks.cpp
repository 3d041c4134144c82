#include "python/ranks/ranks.hpp"

#include <pybind11/pybind11.h>

#include "python/errors.hpp"

PYBIND11_MODULE(_ranks, module) {
  module.doc() = "The compiled part of driftmesh that needs MPI.";
  pybind11::module_::import("driftmesh._native");  // has the classes of arguments and results
  driftmesh::python::translate_errors();
  driftmesh::python::add_distributed(module);
  driftmesh::python::add_adaptive_on_ranks(module);
  driftmesh::python::add_simulated(module);
}
