#include <algorithm>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/boundary_strings.hpp"
#include "io/boundary_types.hpp"
#include "io/file_sink.hpp"
#include "io/fort14_format.hpp"
#include "pslg/describe.hpp"

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
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    sink.line(v + 1, mesh.points[v].x, mesh.points[v].y, width > 0 ? mesh.attributes[v * width] : 0);
}

void write_triangles(FileSink& sink, const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    sink.line(t + 1, 3, a + 1, b + 1, c + 1);
  }
}

using Strings = std::vector<BoundaryString>;

std::size_t nodes_of(const Strings& strings) {
  std::size_t count = 0;
  for (const BoundaryString& string : strings) count += string.vertices.size();
  return count;
}

void write_vertices(FileSink& sink, const BoundaryString& string) {
  for (const std::int32_t vertex : string.vertices) sink.line(vertex + 1);
}

void write_open(FileSink& sink, const Strings& open) {
  write_line(sink, {open.size()}, "number of open boundaries");
  write_line(sink, {nodes_of(open)}, "number of nodes on open boundaries");
  for (const BoundaryString& string : open) {
    write_line(sink, {string.vertices.size()}, "number of nodes on this open boundary");
    write_vertices(sink, string);
  }
}

void write_weir(FileSink& sink, const Mesh::Weir& weir) {
  write_line(sink, {weir.points.size(), static_cast<std::size_t>(weir.type)}, "number of nodes on this weir, type");
  const std::size_t width = weir.values.size() / weir.points.size();
  for (std::size_t i = 0; i < weir.points.size(); ++i) {
    const std::span values(weir.values.data() + i * width, width);
    if (weir.across.empty())
      sink.line(weir.points[i] + 1, values);
    else
      sink.line(weir.points[i] + 1, weir.across[i] + 1, values);
  }
}

/// Weirs come last. ADCIRC counts the nodes on both of their sides.
void write_land(FileSink& sink, const Strings& land, std::span<const Mesh::Weir> weirs) {
  std::size_t nodes = nodes_of(land);
  for (const Mesh::Weir& weir : weirs) nodes += weir.points.size() + weir.across.size();
  write_line(sink, {land.size() + weirs.size()}, "number of land boundaries");
  write_line(sink, {nodes}, "number of nodes on land boundaries");
  for (const BoundaryString& string : land) {
    write_line(sink, {string.vertices.size(), static_cast<std::size_t>(string.type)},
               string.closed ? "number of nodes of this island, type" : "number of nodes on this land boundary, type");
    write_vertices(sink, string);
  }
  for (const Mesh::Weir& weir : weirs) write_weir(sink, weir);
}

/// Tells what the file does not hold, or its readers refuse.
void warn(const Mesh& mesh, const std::string& path, const Boundary& boundary, bool has_weirs,
          const WriteOptions& options) {
  if (!options.warn) return;
  if (const auto& touched = boundary.touched; !touched.empty()) {
    const std::string more = touched.size() > 1 ? " and in " + std::to_string(touched.size() - 1) + " more" : "";
    options.warn(path + ": boundaries touch in node " + std::to_string(touched.front() + 1) + " " +
                 coordinates(mesh.points[static_cast<std::size_t>(touched.front())]) + more +
                 "; SCHISM stops at such nodes, so move the boundaries apart");
  }
  const auto opens_one_edge = [](const BoundaryString& string) {
    return string.type == kOpenType && string.vertices.size() == 2;
  };
  if (const auto count = std::ranges::count_if(boundary.strings, opens_one_edge); count > 0) {
    const std::int32_t first = std::ranges::find_if(boundary.strings, opens_one_edge)->vertices.front();
    options.warn(
        path + ": " + std::to_string(count) + (count == 1 ? " open boundary has" : " open boundaries have") +
        " two nodes alone, at node " + std::to_string(first + 1) + ' ' +
        coordinates(mesh.points[static_cast<std::size_t>(first)]) + (count == 1 ? "" : " and elsewhere") +
        "; if these are creeks that the frame of the domain cuts, give a length from which on boundaries are open");
  }
  std::map<std::int32_t, std::size_t> lost = count_types(mesh);
  std::erase_if(lost, [](const auto& count) { return !weir_columns(count.first); });
  if (has_weirs)
    for (const Mesh::Weir& weir : mesh.weirs) lost.erase(weir.type);
  if (!lost.empty())
    options.warn(path + ": weirs become land: " + list_of_types(lost) + "; " +
                 (has_weirs ? "the mesh has no heights for them" : "SCHISM has none"));
}

}  // namespace

void write_fort14(const Mesh& mesh, const std::string& path, const WriteOptions& options, bool has_weirs) {
  const EdgeTypes types(mesh, options.open_boundary, has_weirs);
  const Boundary boundary = boundary_of(
      mesh, [&](std::int32_t from, std::int32_t to, std::int32_t edge) { return types.of(from, to, edge); });
  Strings open, land;
  for (const BoundaryString& string : boundary.strings)
    if (string.type != EdgeTypes::kWeirType) (string.type == kOpenType ? open : land).push_back(string);
  std::stable_partition(land.begin(), land.end(),
                        [](const BoundaryString& string) { return !string.closed; });  // islands last
  FileSink sink(path);
  sink.text(mesh.coordinates.empty() ? kFort14Title : kFort14Title + (' ' + mesh.coordinates));
  sink.character('\n');
  write_line(sink, {mesh.triangles.size(), mesh.points.size()}, "number of elements and nodes");
  write_nodes(sink, mesh);
  write_triangles(sink, mesh);
  write_open(sink, open);
  write_land(sink, land, has_weirs ? std::span<const Mesh::Weir>(mesh.weirs) : std::span<const Mesh::Weir>());
  sink.commit();
  warn(mesh, path, boundary, has_weirs, options);
}

}  // namespace driftmesh
