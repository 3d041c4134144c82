#include <algorithm>
#include <initializer_list>
#include <vector>

#include "io/boundary_strings.hpp"
#include "io/file_sink.hpp"
#include "io/fort14_format.hpp"

namespace driftmesh {
namespace {

void write_line(FileSink& sink, std::initializer_list<std::size_t> numbers, const char* meaning) {
  for (const std::size_t number : numbers) {
    sink.number(number);
    sink.character(' ');
  }
  sink.text("= ");
  sink.text(meaning);
  sink.character('\n');
}

void write_nodes(FileSink& sink, const Mesh& mesh) {
  const auto width = static_cast<std::size_t>(mesh.attributes_per_point);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    sink.number(v + 1);
    for (const double value : {mesh.points[v].x, mesh.points[v].y, width > 0 ? mesh.attributes[v * width] : 0}) {
      sink.character(' ');
      sink.number(value);
    }
    sink.character('\n');
  }
}

void write_triangles(FileSink& sink, const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sink.number(t + 1);
    sink.text(" 3");
    for (const std::int32_t corner : mesh.triangles[t]) {
      sink.character(' ');
      sink.number(corner + 1);
    }
    sink.character('\n');
  }
}

using Strings = std::vector<BoundaryString>;

std::size_t nodes_of(const Strings& strings) {
  std::size_t count = 0;
  for (const BoundaryString& string : strings) count += string.vertices.size();
  return count;
}

void write_vertices(FileSink& sink, const BoundaryString& string) {
  for (const std::int32_t vertex : string.vertices) {
    sink.number(vertex + 1);
    sink.character('\n');
  }
}

void write_open(FileSink& sink, const Strings& open) {
  write_line(sink, {open.size()}, "number of open boundaries");
  write_line(sink, {nodes_of(open)}, "number of nodes on open boundaries");
  for (const BoundaryString& string : open) {
    write_line(sink, {string.vertices.size()}, "number of nodes on this open boundary");
    write_vertices(sink, string);
  }
}

void write_land(FileSink& sink, const Strings& land) {
  write_line(sink, {land.size()}, "number of land boundaries");
  write_line(sink, {nodes_of(land)}, "number of nodes on land boundaries");
  for (const BoundaryString& string : land) {
    const bool is_island = string.kind == BoundaryString::Kind::kIsland;
    write_line(sink, {string.vertices.size(), is_island ? std::size_t{1} : std::size_t{0}},
               is_island ? "number of nodes of this island, type" : "number of nodes on this land boundary, type");
    write_vertices(sink, string);
  }
}

}  // namespace

void write_fort14(const Mesh& mesh, const std::string& path, std::span<const std::int32_t> open) {
  Strings strings =
      boundary_strings(mesh, [&](std::int32_t marker) { return std::ranges::find(open, marker) != open.end(); });
  const auto land = std::stable_partition(strings.begin(), strings.end(), [](const BoundaryString& string) {
    return string.kind == BoundaryString::Kind::kOpen;
  });
  FileSink sink(path);
  sink.text("driftmesh\n");
  write_line(sink, {mesh.triangles.size(), mesh.points.size()}, "number of elements and nodes");
  write_nodes(sink, mesh);
  write_triangles(sink, mesh);
  write_open(sink, {strings.begin(), land});
  write_land(sink, {land, strings.end()});
  sink.commit();
}

}  // namespace driftmesh
