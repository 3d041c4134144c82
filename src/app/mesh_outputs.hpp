#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driftmesh/files.hpp"
#include "driftmesh/mesh.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"

/// The files that `driftmesh mesh` was told to write.
namespace driftmesh::app {

/// What `driftmesh mesh` was told: see run_mesh.
struct Told {
  const job::Request& request;
  const std::string& command;
  const std::string& config;
};

/// Whether any file needs the mesh.
[[nodiscard]] bool writes(const job::Request::Output& wanted);
/// Whether any of them needs it in one piece.
[[nodiscard]] bool writes_whole(const job::Request::Output& wanted);
/// Whether any of them needs all of it on rank 0.
[[nodiscard]] bool gathers(const job::Request::Output& wanted);

/// Throws InputError if the files that are read and written with so many pieces overlap, or cannot be written.
void register_files(const Told& told, std::int32_t pieces);

/// The files of the mesh in so many pieces and of its picture, but not the record.
[[nodiscard]] std::vector<std::string> files_written(const job::Request& request, std::int32_t pieces);

/// Everything but the mesh that a file of it needs. Warnings go to `watch`, which must outlive the result.
[[nodiscard]] WriteOptions writing_of(const job::Request& request, const std::vector<Point>& holes, job::Watch& watch);

/// Draws the picture.
void draw(const job::Request& request, const Mesh& mesh);

}  // namespace driftmesh::app
