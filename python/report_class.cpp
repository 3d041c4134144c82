#include <pybind11/stl.h>

#include "arrays.hpp"
#include "classes.hpp"
#include "driftmesh/check.hpp"

namespace driftmesh::python {

void add_report_class(py::module_& module) {
  py::class_<CheckReport> report(module, "CheckReport", "What a check found. True if the mesh was accepted.");
  py::class_<CheckReport::Finding>(report, "Finding", "One kind of flaw.")
      .def_readonly("kind", &CheckReport::Finding::kind, "In words: \"not Delaunay\".")
      .def_readonly("count", &CheckReport::Finding::count, "Number of all flaws of this kind.")
      .def_readonly("examples", &CheckReport::Finding::examples, "The first few, in words.");
  report.def_readonly("accepted", &CheckReport::accepted, "Whether there are no findings.")
      .def_readonly("findings", &CheckReport::findings, "The kinds of flaws that were found.")
      .def_readonly("text", &CheckReport::text, "The report in lines, as driftmesh check prints it.")
      .def_readonly("verdict", &CheckReport::verdict, "One line: accepted or rejected, and why.")
      .def_readonly("points", &CheckReport::points, "Number of points.")
      .def_readonly("triangles", &CheckReport::triangles, "Number of triangles.")
      .def_readonly("subsegments", &CheckReport::subsegments, "Number of edges that are parts of segments.")
      .def_readonly("area", &CheckReport::area, "Of all triangles, in squared units of the coordinates.")
      .def_readonly("smallest_area", &CheckReport::smallest_area, "Of a triangle, in squared units of the coordinates.")
      .def_readonly("largest_area", &CheckReport::largest_area, "Of a triangle, in squared units of the coordinates.")
      .def_readonly("smallest_angle", &CheckReport::smallest_angle, "In degrees.")
      .def_readonly("largest_angle", &CheckReport::largest_angle, "In degrees.")
      .def_readonly("exceptions", &CheckReport::exceptions, "Triangles that miss a bound for an accepted reason.")
      .def_readonly("courant", &CheckReport::courant, "The greatest Courant number, if a time step is asked for.")
      .def_readonly("triangles_above", &CheckReport::triangles_above,
                    "Triangles with a greater Courant number than asked for.")
      .def_property_readonly(
          "angles",
          [](const py::object& self) {
            const auto& angles = self.cast<const CheckReport&>().angles;
            return view(angles.data(), {static_cast<py::ssize_t>(angles.size())}, {sizeof(angles[0])}, self);
          },
          "Entry d is the number of angles from d up to d + 1 degrees, shape (180,).")
      .def("__bool__", [](const CheckReport& r) { return r.accepted; })
      .def("__str__", [](const CheckReport& r) { return r.text + r.verdict; })
      .def("__repr__", [](const CheckReport& r) { return "<driftmesh.CheckReport: " + r.verdict + ">"; });
}

}  // namespace driftmesh::python
