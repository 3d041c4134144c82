#include "app/output_files.hpp"

#include <filesystem>
#include <set>

#include "base/atomic_file.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/pvtu_format.hpp"
#include "picture/plot.hpp"

namespace driftmesh::app {
namespace {

namespace fs = std::filesystem;

/// Tests whether a file can be opened for writing. Skips anything but regular files: opening a pipe has side effects.
void try_to_open(const std::string& file) {
  std::error_code ignored;
  if (is_standard_stream(file)) return;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored)) return;
  const AtomicFile attempt(file);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

void check_file(const std::string& file, const std::string& input) {
  for (const std::string& read : {input, fs::path(input).replace_extension(".node").string()})
    if (same_file(file, read))
      throw InputError({file}, "would overwrite the input or its .node file", "give the mesh another name");
  try_to_open(file);
}

}  // namespace

std::vector<std::string> files_of_output(const std::string& path, std::int32_t ranks) {
  if (!is_in_pieces(path)) return mesh_files(path);
  std::vector<std::string> files{path};
  for (std::int32_t r = 0; r < ranks; ++r) files.push_back(pvtu_piece_path(path, r));
  return files;
}

void check_outputs(const std::vector<std::string>& meshes, const std::string& picture, const std::string& record,
                   const std::string& input, std::int32_t ranks) {
  std::vector<std::string> files;
  for (const std::string& mesh : meshes) {
    if (ranks == 0 && is_in_pieces(mesh))
      throw InputError({mesh}, "is for a mesh in pieces", "cut the domain with --subdomains, or write a .vtu");
    for (const std::string& file : files_of_output(mesh, ranks)) files.push_back(file);
  }
  if (!picture.empty() && !is_picture_name(picture))
    throw InputError({picture}, "is not a picture format", "use a name that ends in .png, .svg or .pdf");
  for (const std::string& file : {picture, record})
    if (!file.empty()) files.push_back(file);
  std::set<std::string> seen;
  for (const std::string& file : files) {
    check_file(file, input);
    const std::string name = is_standard_stream(file) ? "-" : fs::absolute(file).lexically_normal().string();
    if (!seen.insert(name).second) throw InputError({file}, "would be written twice", "name each output once");
  }
}

}  // namespace driftmesh::app
