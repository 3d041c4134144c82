#include "size_class.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "driftmesh/size_on_mesh.hpp"
#include "driftmesh/size_rule.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

FieldObject make_size_on_mesh(const Mesh& mesh, py::handle lengths, py::handle gradation) {
  std::vector<double> values = numbers_from(lengths, "lengths").values;
  const double growth = number_from("gradation", gradation);
  const py::gil_scoped_release unlocked;
  return {size_on_mesh(mesh, std::move(values), growth)};
}

/// A rule, or a number.
SizeRule rule_from(py::handle given) {
  if (py::isinstance<SizeRule>(given)) return given.cast<const SizeRule&>();
  return {number_from("a length", given)};
}

SizeRule expression(const std::string& formula, const py::dict& named) {
  SizeRule::Named rules;
  for (const auto& [name, rule] : named) rules.emplace_back(name.cast<std::string>(), rule_from(rule));
  return SizeRule::expression(formula, rules);
}

SizeRule distance_to(py::handle ends) {
  const std::vector<double> numbers = numbers_from(ends, "to", 4).values;
  std::vector<std::array<Point, 2>> segments;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4)
    segments.push_back({Point{numbers[i], numbers[i + 1]}, Point{numbers[i + 2], numbers[i + 3]}});
  return SizeRule::distance_to(segments);
}

SizeRule rule_on_mesh(const Mesh& mesh, py::handle lengths, py::handle gradation) {
  std::vector<double> values = numbers_from(lengths, "lengths").values;
  const double growth = number_from("gradation", gradation);
  const py::gil_scoped_release unlocked;
  return SizeRule::on_mesh(mesh, std::move(values), growth);
}

SizeRule raster_rule(const py::array_t<float, py::array::c_style | py::array::forcecast>& values, py::handle x0,
                     py::handle y0, py::handle dx, py::handle dy, bool slope) {
  GridValues grid{.values = std::vector<float>(values.data(), values.data() + values.size()),
                  .columns = values.ndim() == 2 ? static_cast<std::int64_t>(values.shape(1)) : 0,
                  .x0 = number_from("x0", x0),
                  .y0 = number_from("y0", y0),
                  .dx = number_from("dx", dx),
                  .dy = number_from("dy", dy)};
  const py::gil_scoped_release unlocked;
  return slope ? SizeRule::slope(grid) : SizeRule::raster(grid);
}

SizeRule limited(const SizeRule& rule, py::handle gradation, py::handle shortest, py::handle longest) {
  return rule.limited({.gradation = number_from("gradation", gradation),
                       .shortest = number_from("shortest", shortest),
                       .longest = number_from("longest", longest)});
}

void add_rule_class(py::module_& module) {
  py::class_<SizeRule> rule(module, "SizeRule",
                            "A rule for target edge lengths that the library evaluates by itself, for `size`: see "
                            "driftmesh.sizes. Rules and numbers are joined by +, -, * and /.");
  rule.def(py::init(&rule_from), py::arg("length"))
      .def_static("expression", &expression)
      .def_static("distance", &SizeRule::distance)
      .def_static("distance_to", &distance_to)
      .def_static("width", &SizeRule::width)
      .def_static("curvature", &SizeRule::curvature)
      .def_static("on_mesh", &rule_on_mesh)
      .def("__add__", [](const SizeRule& a, py::handle b) { return a + rule_from(b); })
      .def("__radd__", [](const SizeRule& a, py::handle b) { return rule_from(b) + a; })
      .def("__sub__", [](const SizeRule& a, py::handle b) { return a - rule_from(b); })
      .def("__rsub__", [](const SizeRule& a, py::handle b) { return rule_from(b) - a; })
      .def("__mul__", [](const SizeRule& a, py::handle b) { return a * rule_from(b); })
      .def("__rmul__", [](const SizeRule& a, py::handle b) { return rule_from(b) * a; })
      .def("__truediv__", [](const SizeRule& a, py::handle b) { return a / rule_from(b); })
      .def("__rtruediv__", [](const SizeRule& a, py::handle b) { return rule_from(b) / a; })
      .def("_least", [](const SizeRule& a, const SizeRule& b) { return min(a, b); })
      .def("_greatest", [](const SizeRule& a, const SizeRule& b) { return max(a, b); })
      .def("limited", &limited, py::kw_only(), py::arg("gradation") = 0.0, py::arg("shortest") = 0.0,
           py::arg("longest") = std::numeric_limits<double>::infinity(),
           "limited(*, gradation=0, shortest=0, longest=inf) -> SizeRule\n\n"
           "The rule with limits, which come last: by how much lengths may grow per unit of distance (0: no limit), "
           "and\n"
           "the shortest and the longest length.")
      .def_property_readonly("formula", &SizeRule::formula, "The formula, with made names for what has none.")
      .def(
          "__call__",
          [](const SizeRule& self, py::handle x, py::handle y) {
            return self(Point{number_from("x", x), number_from("y", y)});
          },
          py::arg("x"), py::arg("y"), "The value at a point, if it depends on no domain.")
      .def("__repr__", [](const SizeRule& self) { return "<driftmesh.SizeRule: " + self.formula() + ">"; });
  rule.attr("__array_ufunc__") = py::none();  // numbers of numpy leave operators to it
  module.def("_raster_rule", &raster_rule);
}

}  // namespace

void add_size_class(py::module_& module) {
  py::options options;
  options.disable_function_signatures();
  add_rule_class(module);
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
