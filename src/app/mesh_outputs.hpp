#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "job/request.hpp"

/// The files that `driftmesh mesh` was told to write.
namespace driftmesh::app {

/// What `driftmesh mesh` was told: see run_mesh.
struct Told {
  const job::Request& request;
  const std::string& command;
  const std::string& config;
};

/// Throws InputError if the files that are read and written with so many pieces overlap, or cannot be written.
void register_files(const Told& told, std::int32_t pieces);

/// The files of the mesh in so many pieces and of its picture, but not the record.
[[nodiscard]] std::vector<std::string> files_written(const job::Request& request, std::int32_t pieces);

}  // namespace driftmesh::app
