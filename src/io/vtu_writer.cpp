#include <algorithm>
#include <map>
#include <utility>

#include "base/xml_text.hpp"
#include "io/file_sink.hpp"
#include "io/vtu_format.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

// The header lists all arrays with their offsets; the arrays follow in the same order.
class VtuFile {
 public:
  explicit VtuFile(FileSink& sink) : sink_(sink) {}

  void header(std::string_view line) { sink_.text(line); }

  template <class T>
  void declare(const std::string& name, std::size_t values, std::int32_t components = 1) {
    sink_.text(std::string("        <DataArray type=\"") + vtk_type_name<T>() + "\" Name=\"" + name + '"');
    if (components != 1) sink_.text(" NumberOfComponents=\"" + std::to_string(components) + '"');
    sink_.text(" format=\"appended\" offset=\"" + std::to_string(declared_) + "\"/>\n");
    declared_ += sizeof(std::uint64_t) + values * sizeof(T);
  }

  template <class T>
  void begin_array(std::size_t values) {
    sink_.raw(std::uint64_t{values * sizeof(T)});
  }
  template <class T>
  void array(const std::vector<T>& values) {
    begin_array<T>(values.size());
    sink_.raw_array(std::span<const T>(values));
  }
  FileSink& sink() { return sink_; }

 private:
  FileSink& sink_;
  std::uint64_t declared_ = 0;
};

struct Counts {
  explicit Counts(const Mesh& mesh)
      : points(mesh.points.size()),
        triangles(mesh.triangles.size()),
        lines(mesh.edges.size()),
        cells(triangles + lines),
        connectivity(3 * triangles + 2 * lines) {}
  std::size_t points, triangles, lines, cells, connectivity;
};

void declare_point_data(VtuFile& file, const VtuArrays& arrays, const Counts& counts) {
  file.header(arrays.numbers ? "      <PointData GlobalIds=\"global_number\">\n" : "      <PointData>\n");
  for_each_point_array(arrays, [&]<class T>(const T*, const std::string& name, std::int32_t components) {
    file.declare<T>(escaped(name), counts.points * components, components);
  });
  file.header("      </PointData>\n");
}

void declare_cell_data(VtuFile& file, const VtuArrays& arrays, const TriangleData& data, const Counts& counts) {
  file.header("      <CellData>\n");
  for_each_cell_array(arrays, [&]<class T>(const T*, const char* name) { file.declare<T>(name, counts.cells); });
  for (const auto& [name, values] : data) file.declare<double>(escaped(name), counts.cells);
  file.header("      </CellData>\n");
}

template <class Offset>
void declare_grid(VtuFile& file, const Counts& counts) {
  file.header("      <Points>\n");
  file.declare<double>("Points", 3 * counts.points, 3);
  file.header("      </Points>\n      <Cells>\n");
  file.declare<std::int32_t>("connectivity", counts.connectivity);
  file.declare<Offset>("offsets", counts.cells);
  file.declare<std::uint8_t>("types", counts.cells);
  file.header("      </Cells>\n");
}

/// Names as numbers in arrays that are called so, since not all readers know arrays of text.
template <class Value>
void declare_names(VtuFile& file, const std::map<Value, std::string>& names, const char* what, int dimension) {
  for (const auto& [value, name] : names) {
    file.header("      <DataArray type=\"");
    file.header(vtk_type_name<Value>());
    file.header("\" Name=\"");
    file.header(escaped(name));
    file.header("\" NumberOfComponents=\"2\" ComponentName0=\"");
    file.header(what);
    file.header("\" ComponentName1=\"dimension\" NumberOfTuples=\"1\" format=\"ascii\">");
    file.sink().number(value);
    file.sink().character(' ');
    file.sink().number(dimension);
    file.header("</DataArray>\n");
  }
}

void declare_field_data(VtuFile& file, const Mesh& mesh) {
  using Numbered = std::map<std::int32_t, std::string>;
  if (mesh.names.empty() && mesh.attribute_names.empty() && mesh.coordinates.empty()) return;
  Numbered attributes;
  for (const std::string& name : mesh.attribute_names) attributes.emplace(attributes.size(), name);
  file.header("    <FieldData>\n");
  declare_names(file, mesh.names.markers, kMarkerOfName, 1);
  declare_names(file, mesh.names.regions, kRegionOfName, 2);
  declare_names(file, attributes, kAttributeOfName, 0);
  if (!mesh.coordinates.empty()) declare_names(file, Numbered{{0, mesh.coordinates}}, kCoordinatesOfName, 0);
  file.header("    </FieldData>\n");
}

template <class Offset>
void write_header(VtuFile& file, const VtuArrays& arrays, const TriangleData& data, const Counts& counts,
                  const Mesh& mesh) {
  file.header(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n");
  declare_field_data(file, mesh);
  file.header("    <Piece NumberOfPoints=\"" + std::to_string(counts.points) + "\" NumberOfCells=\"" +
              std::to_string(counts.cells) + "\">\n");
  declare_point_data(file, arrays, counts);
  declare_cell_data(file, arrays, data, counts);
  declare_grid<Offset>(file, counts);
  file.header("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _");
}

void write_point_data(VtuFile& file, const Mesh& mesh, const VtuArrays& arrays, const VtuGhosts& ghosts) {
  if (arrays.point_markers) file.array(mesh.point_markers);
  if (arrays.attributes > 0 && arrays.attribute_names.empty()) file.array(mesh.attributes);
  for (std::size_t k = 0; k < arrays.attribute_names.size(); ++k) {
    file.begin_array<double>(mesh.points.size());
    file.sink().raw_values(mesh.points.size(),
                           [&](std::size_t v) { return mesh.attributes[v * arrays.attribute_names.size() + k]; });
  }
  if (arrays.numbers) file.array(mesh.numbers);
  if (arrays.ghosts) file.array(ghosts.points);
}

// A line has the value of an adjacent triangle, so that coloring by region does not show the lines in a color of their
// own.
class LineValues {
 public:
  explicit LineValues(const Mesh& mesh) : at_edges_(triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh))) {}

  template <class T>
  void append(FileSink& sink, const std::vector<T>& of_triangles) const {
    for (const auto& [left, right] : at_edges_) {
      const std::int32_t triangle = left >= 0 ? left : right;
      sink.raw(triangle >= 0 ? of_triangles[triangle] : T{0});
    }
  }

  /// Whether they are ghosts, which depends on both triangles.
  void append_ghosts(FileSink& sink, const std::vector<std::int32_t>& ranks, std::int32_t own) const {
    for (const auto& [left, right] : at_edges_) {
      std::int32_t first = own;
      for (const std::int32_t triangle : {left, right})
        if (triangle >= 0) first = std::min(first, ranks[triangle]);
      const bool is_own = (left >= 0 && ranks[left] == own) || (right >= 0 && ranks[right] == own);
      sink.raw(is_own && first == own ? std::uint8_t{0} : kDuplicate);
    }
  }

 private:
  std::vector<std::array<std::int32_t, 2>> at_edges_;
};

void write_cell_data(VtuFile& file, const Mesh& mesh, const VtuArrays& arrays, const VtuGhosts& ghosts,
                     const TriangleData& data, const Counts& counts) {
  FileSink& sink = file.sink();
  if (arrays.cell_markers) {
    file.begin_array<std::int32_t>(counts.cells);
    sink.raw_values(counts.triangles, [](std::size_t) { return std::int32_t{0}; });
    sink.raw_values(counts.lines, [&](std::size_t e) { return mesh.edges[e].marker; });
  }
  if (!arrays.regions && !arrays.subdomains && !arrays.ranks && data.empty()) return;
  const LineValues lines(mesh);
  const auto write = [&]<class T>(const std::vector<T>& of_triangles) {
    file.begin_array<T>(counts.cells);
    sink.raw_array(std::span<const T>(of_triangles));
    lines.append(sink, of_triangles);
  };
  if (arrays.regions) write(mesh.regions);
  if (arrays.subdomains) write(mesh.subdomains);
  if (arrays.ranks) write(mesh.ranks);
  if (arrays.ghost_cells) {
    file.begin_array<std::uint8_t>(counts.cells);
    sink.raw_values(counts.triangles,
                    [&](std::size_t t) { return mesh.ranks[t] == ghosts.rank ? std::uint8_t{0} : kDuplicate; });
    lines.append_ghosts(sink, mesh.ranks, ghosts.rank);
  }
  for (const auto& named : data) write(named.second);
}

template <class Offset>
void write_grid(VtuFile& file, const Mesh& mesh, const Counts& counts) {
  FileSink& sink = file.sink();
  file.begin_array<double>(3 * counts.points);
  sink.raw_values(counts.points, [&](std::size_t v) {
    return std::array<double, 3>{mesh.points[v].x, mesh.points[v].y, 0.0};
  });
  file.begin_array<std::int32_t>(counts.connectivity);
  sink.raw_array(std::span<const std::array<std::int32_t, 3>>(mesh.triangles));
  for (const Mesh::Edge& edge : mesh.edges) sink.raw(std::array<std::int32_t, 2>{edge.a, edge.b});
  file.begin_array<Offset>(counts.cells);
  sink.raw_values(counts.triangles, [](std::size_t t) { return static_cast<Offset>(3 * (t + 1)); });
  sink.raw_values(counts.lines, [&](std::size_t e) { return static_cast<Offset>(3 * counts.triangles + 2 * (e + 1)); });
  file.begin_array<std::uint8_t>(counts.cells);
  sink.raw_values(counts.triangles, [](std::size_t) { return kVtkTriangle; });
  sink.raw_values(counts.lines, [](std::size_t) { return kVtkLine; });
}

template <class Offset>
void write_all(VtuFile& file, const Mesh& mesh, const VtuArrays& arrays, const VtuGhosts& ghosts,
               const TriangleData& data, const Counts& counts) {
  write_header<Offset>(file, arrays, data, counts, mesh);
  write_point_data(file, mesh, arrays, ghosts);
  write_cell_data(file, mesh, arrays, ghosts, data, counts);
  write_grid<Offset>(file, mesh, counts);
  file.header("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace

VtuArrays arrays_of(const Mesh& mesh) {
  return {!mesh.point_markers.empty(),
          mesh.attributes_per_point,
          !mesh.numbers.empty(),
          !mesh.edges.empty(),
          !mesh.regions.empty(),
          !mesh.subdomains.empty(),
          !mesh.ranks.empty(),
          false,
          false,
          mesh.attribute_names};
}

std::unique_ptr<FileSink> prepare_vtu(const Mesh& mesh, const VtuArrays& arrays, const std::string& path,
                                      const VtuGhosts& ghosts, const TriangleData& data) {
  auto sink = std::make_unique<FileSink>(path);
  VtuFile file(*sink);
  const Counts counts(mesh);
  if (std::in_range<std::int32_t>(counts.connectivity))
    write_all<std::int32_t>(file, mesh, arrays, ghosts, data, counts);
  else
    write_all<std::int64_t>(file, mesh, arrays, ghosts, data, counts);
  return sink;
}

void write_vtu(const Mesh& mesh, const std::string& path) {
  prepare_vtu(mesh, arrays_of(mesh), path)->commit();
}

void write_vtu_with_data(const Mesh& mesh, const TriangleData& data, const std::string& path) {
  prepare_vtu(mesh, arrays_of(mesh), path, {}, data)->commit();
}

}  // namespace driftmesh
