#pragma once

#include <mpi.h>
#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include "api/mpi/fail_together.hpp"
#include "driftmesh/error.hpp"
#include "python/table.hpp"

namespace driftmesh::python {

namespace py = pybind11;

/// That of an mpi4py communicator. MPI itself is initialized then.
[[nodiscard]] inline MPI_Comm communicator_from(const py::object& given) {
  const py::module_ mpi4py = py::module_::import("mpi4py.MPI");
  if (!py::isinstance(given, mpi4py.attr("Comm")))
    throw py::type_error(std::string("the communicator is one of mpi4py, not ") + Py_TYPE(given.ptr())->tp_name);
  return MPI_Comm_f2c(given.attr("py2f")().cast<MPI_Fint>());
}

/// What `make` returns, for a function that all ranks call. If it fails on one of them, the others raise an Error.
template <class Make>
auto made_together(MPI_Comm communicator, const Make& make) {
  const auto tell_others = [&](const std::exception_ptr& failure) {
    const py::gil_scoped_release unlocked;
    try {
      fail_together(communicator, failure);
    } catch (const std::exception&) {  // the failure of the first rank that has one; this rank raises its own
    }
  };
  try {
    return make();
  } catch (const py::error_already_set& raised) {
    tell_others(std::make_exception_ptr(Error(raised.what())));
    throw;
  } catch (const std::exception&) {
    tell_others(std::current_exception());
    throw;
  }
}

/// An argument that is of one of the package's own classes.
template <class Class>
const Class& object_from(const py::object& given, const char* name, const char* wanted) {
  if (!py::isinstance<Class>(given)) refuse(name, wanted, given);
  return given.cast<const Class&>();
}

}  // namespace driftmesh::python
