#pragma once

#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "io/mesh_file.hpp"
#include "job/place.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"

namespace driftmesh::job {

/// Everything but the mesh that a file of it needs. Warnings go to `watch`, which must outlive the result.
[[nodiscard]] WriteOptions writing_of(const Request::Output& files, const std::vector<Point>& holes, Watch& watch);

/// Whether a file or the picture needs the mesh as a whole.
[[nodiscard]] bool needs_whole(const Request::Output& files);

/// Calls write(path) for each file that is in pieces, and tells `watch`.
template <class Write>
void for_each_in_pieces(const Request::Output& files, Watch& watch, const Write& write) {
  for (const std::string& path : files.meshes)
    if (is_in_pieces(path)) {
      watch.writing(path);
      write(path);
    }
}

/// Writes the other files, and draws.
void write_whole(const Request::Output& files, Mesh& mesh, const std::vector<Point>& holes, const Draw& draw,
                 Watch& watch);

}  // namespace driftmesh::job
