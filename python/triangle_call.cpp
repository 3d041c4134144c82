#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "callbacks.hpp"
#include "classes.hpp"
#include "driftmesh/error.hpp"
#include "triangle/triangulate.hpp"

namespace driftmesh::python {
namespace {

using triangle::Tables;

/// The table with this name as numbers of type T, row by row; empty if there is none. Shapes are right:
/// driftmesh.triangle sees to that.
template <class T>
std::vector<T> values_of(const py::dict& tables, const char* name) {
  if (!tables.contains(name)) return {};
  const auto array = tables[name].cast<py::array_t<T, py::array::c_style | py::array::forcecast>>();
  return {array.data(), array.data() + array.size()};
}

std::int32_t columns_of(const py::dict& tables, const char* name) {
  return tables.contains(name) ? static_cast<std::int32_t>(tables[name].cast<py::array>().shape(1)) : 0;
}

std::vector<Point> points_of(const py::dict& tables, const char* name) {
  const auto values = values_of<double>(tables, name);
  std::vector<Point> points(values.size() / 2);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values[2 * i], values[2 * i + 1]};
  return points;
}

Tables tables_from(const py::dict& given) {
  Tables tables;
  tables.points = points_of(given, "vertices");
  tables.point_attributes = values_of<double>(given, "vertex_attributes");
  tables.attributes_per_point = columns_of(given, "vertex_attributes");
  tables.point_markers = values_of<std::int32_t>(given, "vertex_markers");
  tables.triangles = values_of<std::int32_t>(given, "triangles");
  if (given.contains("triangles")) tables.corners = columns_of(given, "triangles");
  tables.triangle_attributes = values_of<double>(given, "triangle_attributes");
  tables.attributes_per_triangle = columns_of(given, "triangle_attributes");
  tables.triangle_areas = values_of<double>(given, "triangle_max_area");
  const auto segments = values_of<std::int32_t>(given, "segments");
  for (std::size_t i = 0; i < segments.size(); i += 2) tables.segments.push_back({segments[i], segments[i + 1]});
  tables.segment_markers = values_of<std::int32_t>(given, "segment_markers");
  tables.holes = points_of(given, "holes");
  const auto regions = values_of<double>(given, "regions");
  for (std::size_t i = 0; i < regions.size(); i += 4)
    tables.regions.push_back({{regions[i], regions[i + 1]}, regions[i + 2], regions[i + 3]});
  return tables;
}

/// A copy, since what is returned belongs to the caller.
template <class T, class Value>
py::array_t<T> table_of(const std::vector<Value>& values, std::size_t columns) {
  const std::size_t numbers = std::span<const Value>(values).size_bytes() / sizeof(T);
  py::array_t<T> array({columns == 0 ? 0 : numbers / columns, columns});
  std::copy_n(reinterpret_cast<const T*>(values.data()), numbers, array.mutable_data());
  return array;
}

py::dict dict_of(const triangle::Voronoi& voronoi, std::int32_t attributes) {
  std::vector<triangle::Pair> edges;
  std::vector<std::int32_t> origins;
  std::vector<Point> directions;
  for (std::size_t e = 0; e < voronoi.edges.size(); ++e) {
    if (voronoi.edges[e][1] >= 0) {
      edges.push_back(voronoi.edges[e]);
    } else {
      origins.push_back(voronoi.edges[e][0]);
      directions.push_back(voronoi.directions[e]);
    }
  }
  py::dict dict;
  dict["vertices"] = table_of<double>(voronoi.points, 2);
  if (attributes > 0) dict["vertex_attributes"] = table_of<double>(voronoi.point_attributes, attributes);
  dict["edges"] = table_of<std::int32_t>(edges, 2);
  dict["ray_origins"] = table_of<std::int32_t>(origins, 1).reshape({-1});
  dict["ray_directions"] = table_of<double>(directions, 2);
  return dict;
}

py::dict dict_of(const triangle::Result& result, const triangle::Switches& switches) {
  const Tables& mesh = result.mesh;
  py::dict dict;
  if (!switches.no_points) {
    dict["vertices"] = table_of<double>(mesh.points, 2);
    if (mesh.attributes_per_point > 0)
      dict["vertex_attributes"] = table_of<double>(mesh.point_attributes, mesh.attributes_per_point);
    if (!switches.no_markers) dict["vertex_markers"] = table_of<std::int32_t>(mesh.point_markers, 1);
  }
  if (!switches.no_triangles) {
    dict["triangles"] = table_of<std::int32_t>(mesh.triangles, mesh.corners);
    if (mesh.attributes_per_triangle > 0)
      dict["triangle_attributes"] = table_of<double>(mesh.triangle_attributes, mesh.attributes_per_triangle);
  }
  if (switches.neighbors) dict["neighbors"] = table_of<std::int32_t>(mesh.neighbors, 3);
  if (!mesh.segments.empty()) {
    dict["segments"] = table_of<std::int32_t>(mesh.segments, 2);
    if (!switches.no_markers) dict["segment_markers"] = table_of<std::int32_t>(mesh.segment_markers, 1);
  }
  if (!mesh.holes.empty()) dict["holes"] = table_of<double>(mesh.holes, 2);
  if (!mesh.regions.empty()) dict["regions"] = table_of<double>(mesh.regions, 4);
  if (switches.edges) {
    dict["edges"] = table_of<std::int32_t>(mesh.edges, 2);
    if (!switches.no_markers) dict["edge_markers"] = table_of<std::int32_t>(mesh.edge_markers, 1);
  }
  if (switches.voronoi) dict["voronoi"] = dict_of(result.voronoi, mesh.attributes_per_point);
  return dict;
}
static_assert(sizeof(Pslg::Region) == 4 * sizeof(double), "regions are tables of four columns");

py::dict call(const py::dict& given, const std::string& text, const py::object& unsuitable) {
  const triangle::Switches switches = triangle::parse_switches(text);
  const Tables input = tables_from(given);
  Callbacks callbacks;
  triangle::Caller caller;
  caller.goes_on = [&] { return callbacks.goes_on(py::none(), {}); };
  if (!unsuitable.is_none())
    caller.unsuitable = [&](const Point& a, const Point& b, const Point& c, double area) {
      return callbacks.ask([&] {
        const auto pair = [](const Point& p) { return py::make_tuple(p.x, p.y); };
        return static_cast<bool>(py::bool_(unsuitable(py::make_tuple(pair(a), pair(b), pair(c)), area)));
      });
    };
  triangle::Result result;
  try {
    const py::gil_scoped_release unlocked;
    result = triangle::triangulate(input, switches, caller);
  } catch (const Error&) {
    callbacks.raise_first();
    throw;
  }
  if (switches.verbose && !switches.quiet) py::print(triangle::statistics(input, result.mesh), py::arg("end") = "");
  return dict_of(result, switches);
}

}  // namespace

void add_triangle_call(py::module_& module) {
  module.def("triangulate_tables", &call, py::arg("tables"), py::arg("switches"), py::arg("unsuitable") = py::none(),
             "What driftmesh.triangle.triangulate calls, once it has made arrays of the right types and shapes.");
}

}  // namespace driftmesh::python
