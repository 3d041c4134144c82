#include <utility>

#include "output/file_sink.hpp"
#include "output/mesh_edges.hpp"
#include "output/vtu_format.hpp"

namespace driftmesh {
namespace {

constexpr std::uint8_t kLineCell = 3;
constexpr std::uint8_t kTriangleCell = 5;

template <class T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<std::uint8_t> = "UInt8";
template <>
constexpr const char* kTypeName<std::int32_t> = "Int32";
template <>
constexpr const char* kTypeName<std::int64_t> = "Int64";
template <>
constexpr const char* kTypeName<double> = "Float64";

// The header names every array with its offset before any array is written; the arrays then follow in the order in
// which the header named them.
class VtuFile {
 public:
  explicit VtuFile(const std::string& path) : sink_(path) {}

  void header(std::string_view line) { sink_.text(line); }

  template <class T>
  void declare(const std::string& name, std::size_t values, std::int32_t components = 1) {
    sink_.text(std::string("        <DataArray type=\"") + kTypeName<T> + "\" Name=\"" + name + '"');
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
  FileSink sink_;
  std::uint64_t declared_ = 0;
};

struct Counts {
  explicit Counts(const MeshPiece& mesh)
      : points(mesh.points.size()),
        triangles(mesh.triangles.size()),
        lines(mesh.edges.size()),
        cells(triangles + lines),
        connectivity(3 * triangles + 2 * lines) {}
  std::size_t points, triangles, lines, cells, connectivity;
};

void declare_point_data(VtuFile& file, const MeshPiece& mesh) {
  file.header("      <PointData>\n");
  if (!mesh.point_markers.empty()) file.declare<std::int32_t>("marker", mesh.point_markers.size());
  if (mesh.attributes_per_point > 0)
    file.declare<double>("attribute", mesh.attributes.size(), mesh.attributes_per_point);
  file.header("      </PointData>\n");
}

void declare_cell_data(VtuFile& file, const MeshPiece& mesh, const Counts& counts) {
  file.header("      <CellData>\n");
  if (counts.lines > 0) file.declare<std::int32_t>("marker", counts.cells);
  if (!mesh.regions.empty()) file.declare<double>("region", counts.cells);
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

template <class Offset>
void write_header(VtuFile& file, const MeshPiece& mesh, const Counts& counts) {
  file.header(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <UnstructuredGrid>\n");
  file.header("    <Piece NumberOfPoints=\"" + std::to_string(counts.points) + "\" NumberOfCells=\"" +
              std::to_string(counts.cells) + "\">\n");
  declare_point_data(file, mesh);
  declare_cell_data(file, mesh, counts);
  declare_grid<Offset>(file, counts);
  file.header("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _");
}

void write_point_data(VtuFile& file, const MeshPiece& mesh) {
  if (!mesh.point_markers.empty()) file.array(mesh.point_markers);
  if (mesh.attributes_per_point > 0) file.array(mesh.attributes);
}

// A line shows the region of a triangle at it, so that colouring by region does not paint the lines a colour of
// their own.
double region_of_line(const MeshPiece& mesh, const std::array<std::int32_t, 2>& triangles) {
  const std::int32_t triangle = triangles[0] >= 0 ? triangles[0] : triangles[1];
  return triangle >= 0 ? mesh.regions[static_cast<std::size_t>(triangle)] : 0;
}

void write_cell_data(VtuFile& file, const MeshPiece& mesh, const Counts& counts) {
  FileSink& sink = file.sink();
  if (counts.lines > 0) {
    file.begin_array<std::int32_t>(counts.cells);
    for (std::size_t t = 0; t < counts.triangles; ++t) sink.raw(std::int32_t{0});
    for (const MeshPiece::Edge& edge : mesh.edges) sink.raw(edge.marker);
  }
  if (!mesh.regions.empty()) {
    file.begin_array<double>(counts.cells);
    sink.raw_array(std::span<const double>(mesh.regions));
    for (const auto& triangles : triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh)))
      sink.raw(region_of_line(mesh, triangles));
  }
}

template <class Offset>
void write_grid(VtuFile& file, const MeshPiece& mesh, const Counts& counts) {
  FileSink& sink = file.sink();
  file.begin_array<double>(3 * counts.points);
  for (const Point& p : mesh.points) sink.raw(std::array<double, 3>{p.x, p.y, 0.0});
  file.begin_array<std::int32_t>(counts.connectivity);
  sink.raw_array(std::span<const std::array<std::int32_t, 3>>(mesh.triangles));
  for (const MeshPiece::Edge& edge : mesh.edges) sink.raw(std::array<std::int32_t, 2>{edge.a, edge.b});
  file.begin_array<Offset>(counts.cells);
  Offset end = 0;
  for (std::size_t t = 0; t < counts.triangles; ++t) sink.raw(end += 3);
  for (std::size_t e = 0; e < counts.lines; ++e) sink.raw(end += 2);
  file.begin_array<std::uint8_t>(counts.cells);
  for (std::size_t t = 0; t < counts.triangles; ++t) sink.raw(kTriangleCell);
  for (std::size_t e = 0; e < counts.lines; ++e) sink.raw(kLineCell);
}

template <class Offset>
void write_all(const MeshPiece& mesh, const std::string& path, const Counts& counts) {
  VtuFile file(path);
  write_header<Offset>(file, mesh, counts);
  write_point_data(file, mesh);
  write_cell_data(file, mesh, counts);
  write_grid<Offset>(file, mesh, counts);
  file.header("\n  </AppendedData>\n</VTKFile>\n");
  file.sink().commit();
}

}  // namespace

void write_vtu(const MeshPiece& mesh, const std::string& path) {
  const Counts counts(mesh);
  if (std::in_range<std::int32_t>(counts.connectivity))
    write_all<std::int32_t>(mesh, path, counts);
  else
    write_all<std::int64_t>(mesh, path, counts);
}

}  // namespace driftmesh
