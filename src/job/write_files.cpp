#include "job/write_files.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::job {

WriteOptions writing_of(const Request::Output& files, const std::vector<Point>& holes, Watch& watch) {
  const std::vector<double>& open = files.open_boundary;
  return {.holes = holes,
          .ascii = files.ascii,
          .open_boundary = {open.begin(), open.end()},
          .open_from = files.open_from,
          .crs = files.crs,
          .ghost_layer = files.ghost_layer,
          .warn = [&watch](const std::string& warning) { watch.warn(warning); }};
}

bool needs_whole(const Request::Output& files) {
  return !files.picture.empty() || !std::ranges::all_of(files.meshes, is_in_pieces);
}

void write_whole(const Request::Output& files, Mesh& mesh, const std::vector<Point>& holes, const Draw& draw,
                 Watch& watch) {
  mesh.numbers = {};
  mesh.ranks = {};
  if (files.order != MeshOrder::kGiven) timed(watch, "order", [&] { mesh = ordered(std::move(mesh), files.order); });
  timed(watch, "write", [&] {
    for (const std::string& path : files.meshes)
      if (!is_in_pieces(path)) {
        watch.writing(path);
        write_mesh(mesh, path, writing_of(files, holes, watch));
      }
  });
  if (draw) timed(watch, "plot", [&] { draw(mesh); });
}

}  // namespace driftmesh::job
