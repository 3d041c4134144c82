#include "decomposition_class.hpp"

#include <pybind11/stl/filesystem.h>

#include <filesystem>

#include "classes.hpp"
#include "options.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

CutDomain cut(const Pslg& input, py::handle for_ranks, const py::kwargs& options) {
  const std::int32_t ranks = short_integer_from("for_ranks", for_ranks);
  return {with_options(options, [&](const MeshOptions& values) { return cut_domain(input, values, ranks); })};
}

}  // namespace

void add_decomposition_class(py::module_& module) {
  using Path = std::filesystem::path;
  using Unlocked = py::call_guard<py::gil_scoped_release>;
  py::options options;
  options.disable_function_signatures();
  py::class_<CutDomain>(module, "Decomposition", "A domain cut into subdomains, for subdomains={\"given\": ...}.")
      .def("__len__", [](const CutDomain& self) { return subdomains_of(*self.decomposition); })
      .def(
          "write",
          [](const CutDomain& self, const Pslg& input, const Path& path) {
            save_decomposition(*self.decomposition, input, path.string());
          },
          py::arg("input"), py::arg("path"), Unlocked(), "Write a file; `input` is the domain that was cut.");
  module.def("cut_domain", &cut, py::arg("input"), py::arg("for_ranks") = 1, py::pos_only(),
             "cut_domain(input, for_ranks=1, /, **options) -> Decomposition\n\n"
             "Cut a domain for a mesh with these options on so many ranks. Takes the options of mesh().");
  module.def(
      "read_decomposition",
      [](const Path& path, const Pslg& input) { return CutDomain{load_decomposition(path.string(), input)}; },
      py::arg("path"), py::arg("input"), Unlocked(),
      "read_decomposition(path, input) -> Decomposition\n\n"
      "Read a file of Decomposition.write or driftmesh decompose; `input` is the domain that was cut.");
}

}  // namespace driftmesh::python
