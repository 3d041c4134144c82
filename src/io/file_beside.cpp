#include "io/file_beside.hpp"

#include <filesystem>

#include "base/file_identity.hpp"
#include "base/key_error.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

std::string file_beside(const std::string& file, std::size_t line, const std::string& words, const std::string& name,
                        const ReadOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::string path = (folder / name).string();
  if (!options.allow_outside && !lies_within(path, folder.empty() ? "." : folder.string()))
    throw Keyed<InputError>({file, line}, "names the " + words + " " + name + ", outside of its own folder",
                            "move it there, or allow it with {allow-outside}");
  return path;
}

}  // namespace driftmesh
