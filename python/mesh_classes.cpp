#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "classes.hpp"
#include "distributed/mesh_bytes.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/mesh_order.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/version.hpp"
#include "mesh/mesh_edges.hpp"
#include "table.hpp"

namespace driftmesh::python {
namespace {

/// Adds a read-only property that is a view: array(value, owner).
template <class Class, class Array>
void add_view(py::class_<Class>& to, const char* name, const char* doc, const Array& array) {
  to.def_property_readonly(
      name, [array](const py::object& self) { return array(self.cast<const Class&>(), self); }, doc);
}

template <class Class>
py::array attributes_of(const Class& value, py::handle owner) {
  const auto each = static_cast<py::ssize_t>(value.attributes_per_point);
  return view(value.attributes.data(), {each > 0 ? static_cast<py::ssize_t>(value.points.size()) : 0, each},
              {each * static_cast<py::ssize_t>(sizeof(double)), sizeof(double)}, owner);
}

template <class Class>
void add_point_views(py::class_<Class>& to) {
  add_view(to, "points", "Coordinates, shape (points, 2), in the unit of the input.",
           [](const Class& v, py::handle self) {
             return columns_of(v.points, v.points.empty() ? nullptr : &v.points[0].x, 2, self);
           });
  add_view(to, "point_markers", "Markers of the points, shape (points,), or (0,) if there are none.",
           [](const Class& v, py::handle self) { return view(v.point_markers, self); });
  add_view(to, "attributes", "Values at the points, shape (points, attributes), or (0, 0) if there are none.",
           [](const Class& v, py::handle self) { return attributes_of(v, self); });
}

/// Segments or subsegments, which have members a, b and marker.
template <class Class, class Edges>
void add_edge_views(py::class_<Class>& to, const char* name, const char* doc, const char* markers_name,
                    const char* markers_doc, Edges Class::*edges) {
  add_view(to, name, doc, [edges](const Class& v, py::handle self) {
    return columns_of(v.*edges, (v.*edges).empty() ? nullptr : &(v.*edges)[0].a, 2, self);
  });
  add_view(to, markers_name, markers_doc, [edges](const Class& v, py::handle self) {
    return column_of(v.*edges, (v.*edges).empty() ? nullptr : &(v.*edges)[0].marker, self);
  });
}

/// Names by number: properties that are dictionaries, copied.
template <class Class>
void add_names(py::class_<Class>& to) {
  to.def_property_readonly(
      "marker_names", [](const Class& v) { return v.names.markers; },
      "What markers of segments are called: a dictionary from markers. It is a copy: changing it changes nothing here; "
      "names are given when the object is made.");
  to.def_property_readonly(
      "region_names", [](const Class& v) { return v.names.regions; },
      "What regions are called: a dictionary from attributes of regions. A copy, as marker_names is.");
}

template <class Class>
void take_point_data(Class& value, py::handle markers, py::handle attributes) {
  if (!markers.is_none()) value.point_markers = integers_from(markers, "point_markers");
  require_length(value.point_markers.size(), value.points.size(), "point_markers", "point");
  if (attributes.is_none()) return;
  Numbers table = table_from(attributes, "attributes");
  require_length(table.rows, value.points.size(), "attributes", "point");
  value.attributes = std::move(table.values);
  value.attributes_per_point = value.attributes.empty() ? 0 : static_cast<std::int32_t>(table.columns);
}

/// Pairs of points with a marker each, `standard` if none are given.
template <class Edge>
std::vector<Edge> edges_from(py::handle pairs, py::handle markers, std::int32_t standard, const std::string& name,
                             const std::string& markers_name, std::size_t points) {
  if (pairs.is_none()) return {};
  const std::vector<std::int32_t> ends = integers_from(pairs, name, 2);
  require_indices(ends, points, name);
  const std::vector<std::int32_t> given =
      markers.is_none() ? std::vector<std::int32_t>{} : integers_from(markers, markers_name);
  require_length(given.size(), ends.size() / 2, markers_name, "row of " + name);
  std::vector<Edge> edges(ends.size() / 2);
  for (std::size_t i = 0; i < edges.size(); ++i)
    edges[i] = {ends[2 * i], ends[2 * i + 1], given.empty() ? standard : given[i]};
  return edges;
}

/// Names by number, which number(what, key) makes of a key.
template <class Number>
auto names_from(const py::dict& given, const std::string& what, const Number& number) {
  std::map<decltype(number(what, py::handle())), std::string> names;
  for (const auto& [key, name] : given) {
    if (!py::isinstance<py::str>(name)) refuse(what, "texts", name);
    names[number("a key of " + what, key)] = name.template cast<std::string>();
  }
  return names;
}

Names names_from(const py::dict& markers, const py::dict& regions) {
  return {names_from(markers, "marker_names", short_integer_from), names_from(regions, "region_names", number_from)};
}

// The region and the feature may be left out.
Pslg::Polygon polygon_from(py::handle given, std::size_t points) {
  if (!py::isinstance<py::tuple>(given) || py::len(given) < 1 || py::len(given) > 3)
    throw py::type_error("polygons has an item that is no tuple of rings, a region and a feature");
  const auto parts = py::reinterpret_borrow<py::tuple>(given);
  Pslg::Polygon polygon;
  for (const py::handle ring : parts[0]) {
    polygon.rings.push_back(integers_from(ring, "polygons"));
    require_indices(polygon.rings.back(), points, "polygons");
  }
  const auto number = [&](std::size_t part, std::int32_t standard) {
    if (part >= parts.size()) return standard;
    const std::vector<std::int32_t> numbers = integers_from(py::make_tuple(parts[part]), "polygons");
    return numbers.at(0);
  };
  polygon.region = number(1, -1);
  polygon.feature = number(2, 0);
  return polygon;
}

std::vector<Pslg::Polygon> polygons_from(const py::object& given, std::size_t points) {
  std::vector<Pslg::Polygon> polygons;
  if (given.is_none()) return polygons;
  for (const py::handle item : given) polygons.push_back(polygon_from(item, points));
  return polygons;
}

py::list polygons_of(const Pslg& pslg) {
  py::list polygons;
  for (const Pslg::Polygon& polygon : pslg.polygons) {
    py::list rings;
    for (const Pslg::Ring& ring : polygon.rings)
      rings.append(py::array_t<std::int32_t>(static_cast<py::ssize_t>(ring.size()), ring.data()));
    polygons.append(py::make_tuple(rings, polygon.region, polygon.feature));
  }
  return polygons;
}

Pslg make_pslg(py::handle points, py::handle segments, py::handle segment_markers, py::handle holes, py::handle regions,
               py::handle point_markers, py::handle attributes, const py::dict& marker_names,
               const py::dict& region_names, const py::object& polygons) {
  Pslg pslg;
  pslg.names = names_from(marker_names, region_names);
  pslg.points = points_from(points, "points");
  pslg.segments =
      edges_from<Pslg::Segment>(segments, segment_markers, 1, "segments", "segment_markers", pslg.points.size());
  if (!holes.is_none()) pslg.holes = points_from(holes, "holes");
  if (!regions.is_none()) {
    const Numbers rows = numbers_from(regions, "regions", 4);
    for (std::size_t i = 0; i < rows.rows; ++i) {
      const double* row = &rows.values[4 * i];
      pslg.regions.push_back({{row[0], row[1]}, row[2], row[3]});
    }
  }
  take_point_data(pslg, point_markers, attributes);
  pslg.polygons = polygons_from(polygons, pslg.points.size());
  pslg.first_number = 0;  // as Python counts, in messages too
  return pslg;
}

Mesh make_mesh(py::handle points, py::handle triangles, py::handle edges, py::handle edge_markers,
               py::handle point_markers, py::handle attributes, py::handle regions, const py::dict& marker_names,
               const py::dict& region_names) {
  Mesh mesh;
  mesh.names = names_from(marker_names, region_names);
  mesh.points = points_from(points, "points");
  const std::vector<std::int32_t> corners = integers_from(triangles, "triangles", 3);
  require_indices(corners, mesh.points.size(), "triangles");
  mesh.triangles.resize(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.triangles[i / 3][i % 3] = corners[i];
  mesh.edges = edges_from<Mesh::Edge>(edges, edge_markers, 0, "edges", "edge_markers", mesh.points.size());
  take_point_data(mesh, point_markers, attributes);
  if (!regions.is_none()) mesh.regions = numbers_from(regions, "regions").values;
  require_length(mesh.regions.size(), mesh.triangles.size(), "regions", "triangle");
  return mesh;
}

/// Of the same version alone: what is in it follows the members of a mesh.
Mesh mesh_of_state(const py::tuple& state) {
  if (const auto version = state[0].cast<std::string>(); version != DRIFTMESH_VERSION)
    throw py::value_error("this mesh was pickled by driftmesh " + version +
                          ", and this is " DRIFTMESH_VERSION ": write meshes that are kept to files");
  const auto text = state[1].cast<std::string>();
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return mesh_of({Rank{}, Bytes(begin, begin + text.size())});
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what;
}

void add_pslg(py::module_& module) {
  py::class_<Pslg> pslg(
      module, "Pslg",
      "A planar straight line graph: the points, segments, holes and regions of a domain. Its arrays are read-only.");
  const py::object none = py::none();
  pslg.def(py::init(&make_pslg), py::arg("points"), py::arg("segments") = none, py::kw_only(),
           py::arg("segment_markers") = none, py::arg("holes") = none, py::arg("regions") = none,
           py::arg("point_markers") = none, py::arg("attributes") = none, py::arg("marker_names") = py::dict(),
           py::arg("region_names") = py::dict(), py::arg("polygons") = none, "A domain from arrays, which are copied.");
  add_point_views(pslg);
  add_edge_views(pslg, "segments", "Indices of the two ends of each segment, shape (segments, 2).", "segment_markers",
                 "Markers of the segments, shape (segments,).", &Pslg::segments);
  add_view(pslg, "holes", "A point in each hole, shape (holes, 2).", [](const Pslg& v, py::handle self) {
    return columns_of(v.holes, v.holes.empty() ? nullptr : &v.holes[0].x, 2, self);
  });
  add_view(
      pslg, "regions",
      "Seeds of regions, shape (regions, 4): x, y, attribute, largest area (0: no bound of its own). The place of a "
      "region that polygons name has no meaning.",
      [](const Pslg& v, py::handle self) {
        static_assert(sizeof(Pslg::Region) == 4 * sizeof(double));
        return columns_of(v.regions, v.regions.empty() ? nullptr : &v.regions[0].at.x, 4, self);
      });
  pslg.def_property_readonly(
      "polygons", &polygons_of,
      "Polygons as tuples: the list of their rings (arrays of indices of points, closed, the first one without the "
      "others), the index of their region (-1: none), and the number of their feature (0: none). Without polygons, the "
      "segments bound the domain.");
  add_names(pslg);
  pslg.def(
      "write", [](const Pslg& v, const std::filesystem::path& path) { write_poly(v, path.string()); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(), "Write Triangle's .poly. The file appears only when it is complete.");
  pslg.def("__repr__", [](const Pslg& v) {
    return "<driftmesh.Pslg: " + counted(v.points.size(), "points, ") + counted(v.segments.size(), "segments, ") +
           (v.polygons.empty() ? "" : counted(v.polygons.size(), "polygons, ")) + counted(v.holes.size(), "holes, ") +
           counted(v.regions.size(), "regions>");
  });
}

void add_mesh(py::module_& module) {
  py::class_<Mesh> mesh(module, "Mesh",
                        "A mesh as flat arrays, which are read-only views of its memory and keep it alive.");
  const py::object none = py::none();
  mesh.def(py::init(&make_mesh), py::arg("points"), py::arg("triangles"), py::kw_only(), py::arg("edges") = none,
           py::arg("edge_markers") = none, py::arg("point_markers") = none, py::arg("attributes") = none,
           py::arg("regions") = none, py::arg("marker_names") = py::dict(), py::arg("region_names") = py::dict(),
           "A mesh from arrays, which are copied: to check it, draw it, or write it to a file.");
  add_point_views(mesh);
  add_view(mesh, "triangles", "Indices of the corners, counterclockwise, shape (triangles, 3).",
           [](const Mesh& v, py::handle self) {
             return columns_of(v.triangles, v.triangles.empty() ? nullptr : v.triangles[0].data(), 3, self);
           });
  add_edge_views(mesh, "edges",
                 "Ends of the subsegments, the edges that lie on segments of the input, shape (edges, 2).",
                 "edge_markers", "Markers of the subsegments, shape (edges,).", &Mesh::edges);
  add_view(mesh, "regions",
           "Attribute of each triangle's region, shape (triangles,), or (0,) if the input has no regions.",
           [](const Mesh& v, py::handle self) { return view(v.regions, self); });
  add_view(mesh, "numbers", "Number of each point in the whole mesh, shape (points,), or (0,) if this is no piece.",
           [](const Mesh& v, py::handle self) { return view(v.numbers, self); });
  add_view(mesh, "subdomains", "Subdomain in which each triangle was made, shape (triangles,), or (0,).",
           [](const Mesh& v, py::handle self) { return view(v.subdomains, self); });
  add_view(mesh, "ranks", "Rank that had the subdomain of each triangle, shape (triangles,), or (0,).",
           [](const Mesh& v, py::handle self) { return view(v.ranks, self); });
  add_names(mesh);
  mesh.def_property_readonly(
      "attribute_names", [](const Mesh& v) { return v.attribute_names; },
      "What the attributes are called: a list of texts, one for each, or an empty one.");
  mesh.def_property_readonly(
      "coordinates", [](const Mesh& v) { return v.coordinates; },
      "What the coordinates of a mesh from a file are: the name of a projection, such as 'UTM zone 18N', with\n"
      "' from lonlat' behind it if the domain was given in longitudes and latitudes; '' if that is not known.");
  mesh.def(
      "write",
      [](const Mesh& v, const std::filesystem::path& path) {
        std::vector<std::string> warnings;
        {
          const py::gil_scoped_release others_run;
          write_mesh(v, path.string(), {.warn = [&](const std::string& text) { warnings.push_back(text); }});
        }
        for (const std::string& text : warnings) py::module_::import("driftmesh._errors").attr("warn")(text);
      },
      py::arg("path"),
      "Write the format that the extension names: .vtu, .msh, or Triangle's .node, .ele, ... Files appear only when "
      "complete.");
  mesh.def(py::pickle(
      [](const Mesh& v) {
        const Bytes bytes = mesh_to_bytes(v);
        return py::make_tuple(DRIFTMESH_VERSION, py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
      },
      &mesh_of_state));
  mesh.def_property_readonly(
      "neighbors",
      [](const Mesh& v) {
        const auto neighbors = triangle_neighbors(v);
        return py::array_t<std::int32_t>({static_cast<py::ssize_t>(neighbors.size()), py::ssize_t{3}},
                                         neighbors.empty() ? nullptr : neighbors[0].data());
      },
      "For each triangle those across the edges opposite to its corners, -1 at the boundary, shape (triangles, 3). "
      "Found "
      "anew at each call.");
  mesh.def(
      "ordered", [](const Mesh& v, const std::string& order) { return ordered(v, mesh_order_from(order)); },
      py::arg("order") = "rcm", py::call_guard<py::gil_scoped_release>(),
      "The same mesh with its points and triangles in another order: 'rcm', reverse Cuthill-McKee, for a small "
      "bandwidth "
      "of matrices, 'hilbert', along a Hilbert curve, or 'given'.");
  mesh.def_property_readonly("bandwidth", &bandwidth,
                             "The largest difference between the numbers of two points of one triangle.");
  mesh.def("__repr__", [](const Mesh& v) {
    return "<driftmesh.Mesh: " + counted(v.points.size(), "points, ") + counted(v.triangles.size(), "triangles, ") +
           counted(v.edges.size(), "edges>");
  });
}

void add_progress(py::module_& module) {
  py::class_<Progress>(module, "Progress", "How far the work is.")
      .def_readonly("triangles", &Progress::triangles, "Triangles made so far; on many ranks, by this one.")
      .def_readonly("forecast", &Progress::forecast, "Triangles expected in the end.");
}

}  // namespace

void add_mesh_classes(py::module_& module) {
  add_pslg(module);
  add_mesh(module);
  add_progress(module);
}

}  // namespace driftmesh::python
