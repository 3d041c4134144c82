#include "size_class.hpp"

#include "arrays.hpp"
#include "classes.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

FieldObject make_size_on_mesh(const Mesh& mesh, py::handle lengths, py::handle gradation) {
  std::vector<double> values = numbers_from(lengths, "lengths").values;
  const double growth = number_from("gradation", gradation);
  const py::gil_scoped_release unlocked;
  return {size_on_mesh(mesh, std::move(values), growth)};
}

}  // namespace

void add_size_class(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  py::class_<FieldObject>(module, "SizeField", "Target edge lengths that the library knows by itself, for `size`.")
      .def(
          "__call__",
          [](const FieldObject& self, py::handle x, py::handle y) {
            return self.field->edge_length({number_from("x", x), number_from("y", y)});
          },
          py::arg("x"), py::arg("y"), "The length at a point.");
  module.def(
      "size_on_mesh", &make_size_on_mesh, py::arg("mesh"), py::arg("lengths"), py::kw_only(),
      py::arg("gradation") = 0.0,
      "size_on_mesh(mesh, lengths, *, gradation=0) -> SizeField\n\n"
      "Target edge lengths at the points of a mesh, shape (points,), linear on its triangles; outside of it, that at\n"
      "the nearest point of its boundary. For adaptive refinement, and for functions of arrays: no Python is called\n"
      "while the library works, on any number of threads.\n\n"
      "    gradation: by how much lengths may grow per unit of distance, which lowers some; 0: no limit\n\n"
      "Raises Error unless all lengths are positive (or infinite).");
}

}  // namespace driftmesh::python
