#include "app/mesh_outputs.hpp"

#include "app/run_files.hpp"
#include "base/file_registry.hpp"
#include "io/mesh_file.hpp"
#include "job/files.hpp"

namespace driftmesh::app {

using job::Request;

void register_files(const Told& told, std::int32_t pieces) {
  const auto called = [](const char* key) { return job::called(key, job::kMesh); };
  FileRegistry files;
  if (!told.config.empty()) files.reads(told.config, "--config");
  job::register_reads(told.request, job::kMesh, files);
  const Request::Output& wanted = told.request.output;
  for (const std::string& mesh : wanted.meshes) register_mesh_output(files, mesh, called("output.meshes"), pieces);
  register_picture(files, wanted.picture, called("output.picture"));
  register_output(files, wanted.session, called("output.session"));
  register_output(files, wanted.record, called("output.record"));
  register_output(files, told.request.sizing.save_tree, called("sizing.save-tree"));
  register_output(files, told.request.run.checkpoint, called("run.checkpoint"));
}

std::vector<std::string> files_written(const Request& request, std::int32_t pieces) {
  std::vector<std::string> files;
  for (const std::string& mesh : request.output.meshes)
    for (const std::string& file : mesh_files(mesh, pieces)) files.push_back(file);
  for (const std::string& file : {request.output.session, request.output.picture})
    if (!file.empty()) files.push_back(file);
  if (!request.sizing.save_tree.empty()) files.push_back(request.sizing.save_tree);
  return files;
}

}  // namespace driftmesh::app
