#include "base/file_registry.hpp"

#include <filesystem>

#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

bool is_device(const std::string& path) {
  std::error_code ignored;
  return !is_standard_stream(path) && std::filesystem::is_character_file(path, ignored);
}

/// Standard input and output are two files, each of which can be used once.
FileIdentity identity_of_stream(const char* name) {
  return {0, 0, name};
}

}  // namespace

void FileRegistry::reads(const std::string& path, const std::string& use) {
  if (is_device(path)) return;
  if (is_standard_stream(path)) {
    const auto [first, is_new] = read_.try_emplace(identity_of_stream("standard input"), Use{path, use});
    if (!is_new && first->second.name != use)
      throw InputError({path},
                       first->second.name + " and " + use + " both read it, and standard input can be read only once",
                       "name a file for one of the two");
    return;
  }
  const FileIdentity file = identity_of(path);
  read_.try_emplace(file, Use{path, use});
  if (const auto written = written_.find(file); written != written_.end())
    refuse_to_overwrite(written->second, {path, use});
}

void FileRegistry::writes(const std::string& path, const std::string& use) {
  if (is_device(path)) return;
  const FileIdentity file = is_standard_stream(path) ? identity_of_stream("standard output") : identity_of(path);
  if (const auto read = read_.find(file); read != read_.end()) refuse_to_overwrite({path, use}, read->second);
  const auto [first, is_new] = written_.try_emplace(file, Use{path, use});
  if (is_new) return;
  const Use& other = first->second;
  const std::string spelled = other.path == path ? "" : " (there called " + other.path + ")";
  throw InputError({path},
                   use == other.name ? use + " would write it twice" + spelled
                                     : use + " and " + other.name + spelled + " would both write it",
                   "give each output a name of its own");
}

void FileRegistry::refuse_to_overwrite(const Use& written, const Use& read) {
  const std::string spelled = read.path == written.path ? "" : " (there called " + read.path + ")";
  throw InputError({written.path}, written.name + " would overwrite it, and " + read.name + spelled + " reads it",
                   "give the output another name");
}

}  // namespace driftmesh
