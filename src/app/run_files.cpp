#include "app/run_files.hpp"

#include <filesystem>

#include "app/mesh_input.hpp"
#include "base/atomic_file.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
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

}  // namespace

cli::Option allow_outside_option(ReadOptions& options) {
  return {.kind = cli::Option::Kind::kFlag,
          .name = "allow-outside",
          .help = "Let a .pvtu or .pvd name files outside of its own folder",
          .take = cli::into(options.allow_outside)};
}

cli::Option allow_code_option(bool& allowed) {
  return {.kind = cli::Option::Kind::kFlag,
          .name = "allow-code",
          .help = "Let the YAML file name a policy in a shared library, which is code that runs",
          .take = cli::into(allowed)};
}

void register_mesh_input(FileRegistry& files, const std::string& path, const std::string& use,
                         const ReadOptions& options) {
  if (is_saved_session(path)) return files.reads(path, use);
  for (const std::string& file : files_to_read(path, options)) files.reads(file, use);
}

void register_output(FileRegistry& files, const std::string& path, const std::string& use) {
  if (path.empty()) return;
  files.writes(path, use);
  try_to_open(path);
}

void register_mesh_output(FileRegistry& files, const std::string& path, const std::string& use, std::int32_t ranks) {
  if (ranks == 0) require_whole(path);
  for (const std::string& file : mesh_files(path, ranks)) register_output(files, file, use);
}

void register_picture(FileRegistry& files, const std::string& path, const std::string& use) {
  if (path.empty()) return;
  if (!is_picture_name(path))
    throw InputError({path}, "is not a picture format", "use a name that ends in .png, .svg or .pdf");
  register_output(files, path, use);
}

}  // namespace driftmesh::app
