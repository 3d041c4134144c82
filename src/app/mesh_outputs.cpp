#include "app/mesh_outputs.hpp"

#include <algorithm>
#include <filesystem>

#include "app/run_files.hpp"
#include "base/file_registry.hpp"
#include "io/mesh_file.hpp"
#include "job/domain.hpp"
#include "job/files.hpp"
#include "picture/plot.hpp"

namespace driftmesh::app {

using job::Request;

bool writes(const Request::Output& wanted) {
  return !wanted.meshes.empty() || !wanted.picture.empty();
}

bool writes_whole(const Request::Output& wanted) {
  return !wanted.picture.empty() || !std::ranges::all_of(wanted.meshes, is_in_pieces);
}

bool gathers(const Request::Output& wanted) {
  return !wanted.picture.empty() || !std::ranges::all_of(wanted.meshes, is_written_by_all);
}

void register_files(const Told& told, std::int32_t pieces) {
  const auto called = [](const char* key) { return job::called(key, job::kMesh); };
  FileRegistry files;
  if (!told.config.empty()) files.reads(told.config, "--config");
  job::register_reads(told.request, job::kMesh, files);
  const Request::Output& wanted = told.request.output;
  for (const std::string& mesh : wanted.meshes) register_mesh_output(files, mesh, called("output.meshes"), pieces);
  register_picture(files, wanted.picture, called("output.picture"));
  register_output(files, wanted.record, called("output.record"));
}

std::vector<std::string> files_written(const Request& request, std::int32_t pieces) {
  std::vector<std::string> files;
  for (const std::string& mesh : request.output.meshes)
    for (const std::string& file : files_of_output(mesh, pieces)) files.push_back(file);
  if (!request.output.picture.empty()) files.push_back(request.output.picture);
  return files;
}

WriteOptions writing_of(const Request& request, const std::vector<Point>& holes, job::Watch& watch) {
  const std::vector<double>& open = request.output.open_boundary;
  return {holes,
          request.output.ascii,
          {open.begin(), open.end()},
          request.output.ghost_layer,
          [&watch](const std::string& warning) { watch.warn(warning); }};
}

void draw(const Request& request, const Mesh& mesh) {
  const std::string title = std::filesystem::path(job::input_name(request)).filename().string();
  plot_mesh(mesh, request.output.picture, {.title = title});
}

}  // namespace driftmesh::app
