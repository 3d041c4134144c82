#include "driftmesh/adapt_part.hpp"

#include <pybind11/stl.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"

namespace driftmesh::python {
namespace {

PartOptions part_options(const py::object& lengths, double shortest, double longest, double gradation,
                         double most_triangles, double min_angle, std::int32_t threads) {
  PartOptions options{
      .sizes = {.shortest = shortest, .longest = longest, .gradation = gradation, .most_triangles = most_triangles},
      .min_angle = min_angle,
      .threads = threads};
  if (!lengths.is_none()) options.lengths = numbers_from(lengths, "lengths").values;
  return options;
}

AdaptedMesh part_of_mesh(const Mesh& mesh, const py::object& triangles, const py::object& lengths, double shortest,
                         double longest, double gradation, double most_triangles, double min_angle,
                         std::vector<std::string> conserve, std::int32_t threads) {
  const std::vector<std::int32_t> numbers = integers_from(triangles, "triangles");
  PartOptions options = part_options(lengths, shortest, longest, gradation, most_triangles, min_angle, threads);
  options.conserve = std::move(conserve);
  const py::gil_scoped_release unlocked;
  return adapt_part(mesh, numbers, options);
}

AdaptedMesh mesh_of_outline(const Mesh& mesh, const Pslg& domain, const py::object& lengths, double shortest,
                            double longest, double gradation, double most_triangles, double min_angle, double tolerance,
                            std::int32_t threads) {
  PartOptions options = part_options(lengths, shortest, longest, gradation, most_triangles, min_angle, threads);
  options.tolerance = tolerance;
  const py::gil_scoped_release unlocked;
  return adapt_outline(mesh, domain, options);
}

constexpr const char* kPartDoc =
    "adapt_part(mesh, triangles, /, *, lengths=None, shortest=0, longest=inf, gradation=0.2, most_triangles=0,\n"
    "           min_angle=20, conserve=(), threads=0) -> AdaptedMesh\n\n"
    "Make these triangles of a mesh anew, given by their numbers, and as many around them as the bound on angles\n"
    "takes. All else stays bit for bit: points, triangles, edges, markers, data of points, and numbers.\n\n"
    "    lengths: of edges, one for each point of the mesh; None: those of the triangles that there are\n"
    "    shortest, longest: lengths are raised, or lowered, to these\n"
    "    gradation: by how much lengths may grow per unit of distance; 0: no limit\n"
    "    most_triangles: LimitError if what is made anew would have more; 0: no limit\n"
    "    min_angle: of new triangles, in degrees\n"
    "    conserve: names of point data whose integrals stay; all others are interpolated\n"
    "    threads: the most that work at once, on which nothing depends but time; 0: one for each core";
constexpr const char* kOutlineDoc =
    "adapt_outline(mesh, domain, /, *, lengths=None, shortest=0, longest=inf, gradation=0.2, most_triangles=0,\n"
    "              min_angle=20, tolerance=0, threads=0) -> AdaptedMesh\n\n"
    "Give a mesh a new domain, a Pslg: what touches a line that is on one of both outlines alone is made anew, and as\n"
    "much around it as the bound on angles takes; all else stays, as with adapt_part. Where the domain is beyond the\n"
    "old mesh, lengths and data are those at its nearest place.\n\n"
    "    tolerance: lines of both outlines that are so near to each other are the same; 0: as near as rounding";

}  // namespace

void add_adapt_part(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  const PartOptions standard;
  const auto view_of = [](std::vector<std::int32_t> AdaptedMesh::*numbers) {
    return [numbers](const py::object& self) { return view(self.cast<const AdaptedMesh&>().*numbers, self); };
  };
  py::class_<AdaptedMesh>(module, "AdaptedMesh", "A mesh of which parts are new, by adapt_part or adapt_outline.")
      .def_readonly("mesh", &AdaptedMesh::mesh, "The Mesh.")
      .def_property_readonly("old_points", view_of(&AdaptedMesh::old_points),
                             "For each point its number in the old mesh, -1 for those that are new, shape (points,).")
      .def_property_readonly(
          "old_triangles", view_of(&AdaptedMesh::old_triangles),
          "For each triangle its number in the old mesh, -1 for those that are new, shape (triangles,).")
      .def_readonly("margin", &AdaptedMesh::margin, "Triangles that are gone because of the angle bound alone.")
      .def_readonly("margin_width", &AdaptedMesh::margin_width,
                    "No corner of these is farther from what had to be made anew.")
      .def_readonly("beyond", &AdaptedMesh::beyond, "New points where the old mesh was not.");
  module.def("adapt_part", &part_of_mesh, py::arg("mesh"), py::arg("triangles"), py::pos_only(), py::kw_only(),
             py::arg("lengths") = py::none(), py::arg("shortest") = standard.sizes.shortest,
             py::arg("longest") = standard.sizes.longest, py::arg("gradation") = standard.sizes.gradation,
             py::arg("most_triangles") = standard.sizes.most_triangles, py::arg("min_angle") = standard.min_angle,
             py::arg("conserve") = std::vector<std::string>(), py::arg("threads") = standard.threads, kPartDoc);
  module.def("adapt_outline", &mesh_of_outline, py::arg("mesh"), py::arg("domain"), py::pos_only(), py::kw_only(),
             py::arg("lengths") = py::none(), py::arg("shortest") = standard.sizes.shortest,
             py::arg("longest") = standard.sizes.longest, py::arg("gradation") = standard.sizes.gradation,
             py::arg("most_triangles") = standard.sizes.most_triangles, py::arg("min_angle") = standard.min_angle,
             py::arg("tolerance") = standard.tolerance, py::arg("threads") = standard.threads, kOutlineDoc);
}

}  // namespace driftmesh::python
