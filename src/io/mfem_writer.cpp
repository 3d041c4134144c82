#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "driftmesh/id_vector.hpp"
#include "io/mfem_format.hpp"
#include "io/msh_groups.hpp"
#include "io/tag_comments.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

class MfemText {
 public:
  MfemText(FileSink& sink, const MfemPart& part) : sink_(sink), part_(part), mesh_(part.mesh) {}

  void write() {
    const bool is_parallel = !part_.groups.empty();
    sink_.text(is_parallel ? "MFEM mesh v1.2\n\n" : "MFEM mesh v1.0\n\n");
    write_tag_comments(sink_, part_.marker_tags, part_.region_tags, mesh_.names);
    sink_.text("\ndimension\n2\n");
    write_elements();
    write_boundary();
    write_points();
    if (!is_parallel) return;
    sink_.text("\nmfem_serial_mesh_end\n");
    write_groups();
    write_shared();
    sink_.text("\nmfem_mesh_end\n");
  }

 private:
  void count(std::string_view name, std::size_t number) {
    sink_.text(name);
    sink_.line(number);
  }

  void write_elements() {
    count("\nelements\n", mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::int32_t tag = mesh_.regions.empty() ? 1 : part_.region_tags.at(mesh_.regions[t]);
      sink_.line(tag, kMfemTriangle, mesh_.triangles[t]);
    }
  }

  void write_boundary() {
    count("\nboundary\n", part_.boundary.size());
    for (const std::int32_t e : part_.boundary) {
      const Mesh::Edge& edge = mesh_.edges[to_index(e)];
      sink_.line(part_.marker_tags.at(edge.marker), kMfemSegment, edge.a, edge.b);
    }
  }

  void write_points() {
    count("\nvertices\n", mesh_.points.size());
    sink_.text("2\n");
    for (const Point& p : mesh_.points) sink_.line(p.x, p.y);
  }

  void write_groups() {
    count("\ncommunication_groups\nnumber_of_groups ", part_.groups.size());
    sink_.text("\n# number of ranks in each group, followed by the ranks\n");
    for (const MfemGroup& group : part_.groups) sink_.line(group.ranks.size(), group.ranks);
  }

  void write_shared() {
    std::size_t points = 0, edges = 0;
    for (const MfemGroup& group : part_.groups) points += group.points.size(), edges += group.edges.size();
    count("\ntotal_shared_vertices ", points);
    count("total_shared_edges ", edges);
    for (std::size_t g = 1; g < part_.groups.size(); ++g) {  // the first is this rank alone
      count("\n# group ", g);
      count("shared_vertices ", part_.groups[g].points.size());
      for (const std::int32_t point : part_.groups[g].points) sink_.line(point);
      count("\nshared_edges ", part_.groups[g].edges.size());
      for (const auto& edge : part_.groups[g].edges) sink_.line(edge);
    }
  }

  FileSink& sink_;
  const MfemPart& part_;
  const Mesh& mesh_;
};

}  // namespace

std::unique_ptr<FileSink> prepare_mfem(const MfemPart& part, const std::string& path) {
  auto sink = std::make_unique<FileSink>(path);
  MfemText(*sink, part).write();
  return sink;
}

void write_mfem(const Mesh& mesh, const std::string& path) {
  MfemPart part{.mesh = mesh, .boundary = boundary_edges(mesh), .region_tags = {}, .marker_tags = {}};
  std::set<double> markers, regions(mesh.regions.begin(), mesh.regions.end());
  for (const Mesh::Edge& edge : mesh.edges) markers.insert(edge.marker);
  for (const auto& [marker, name] : mesh.names.markers) markers.insert(marker);
  for (const auto& [region, name] : mesh.names.regions) regions.insert(region);
  part.region_tags = tags_of_values(regions);
  part.marker_tags = tags_of_values(markers);
  prepare_mfem(part, path)->commit();
}

std::string mfem_part_path(const std::string& path, std::int32_t rank) {
  const std::string digits = std::to_string(rank);
  const std::size_t zeros = digits.size() < 6 ? 6 - digits.size() : 0;
  return std::filesystem::path(path).replace_extension(".mesh.").string() + std::string(zeros, '0') + digits;
}

}  // namespace driftmesh
