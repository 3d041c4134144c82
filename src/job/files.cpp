#include "job/files.hpp"

#include <vector>

#include "base/letter_case.hpp"
#include "job/input_file.hpp"
#include "job/keys.hpp"
#include "mapping/mapping_file.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::job {

std::string called(const std::string& key, EntryPoint entry_point) {
  const Key* const found = find_key(key).key;
  if (found == nullptr) return "--" + key;  // an option of commands alone
  if (entry_point == kExperiment) return key;
  if (found->option.empty()) return key;
  return key == "input.file" ? upper_case(found->option) : "--" + found->option;
}

Words words_of(EntryPoint entry_point) {
  return [=](const std::string& key) { return called(key, entry_point); };
}

void register_reads(const Request& request, EntryPoint entry_point, FileRegistry& files) {
  const auto reads = [&](const std::vector<std::string>& paths, const char* key) {
    for (const std::string& path : paths) files.reads(path, called(key, entry_point));
  };
  if (!request.input.file.empty()) reads(input_files(request.input.file), "input.file");
  for (const auto& [name, text] : request.input.rasters) reads(files_in(text), "input.rasters");
  if (!request.sizing.background.empty()) reads(background_files(request.sizing.background), "sizing.background");
  if (!request.sizing.tree.empty()) reads({request.sizing.tree}, "sizing.tree");
  if (!request.decomposition.file.empty()) reads({request.decomposition.file}, "decomposition.file");
  if (!request.mapping.file.empty()) reads(mapping_files(request.mapping.file), "mapping.file");
  if (request.run.resume != request.run.checkpoint && !request.run.resume.empty())
    reads({request.run.resume}, "run.resume");
  if (!request.cluster.costs.empty()) reads({request.cluster.costs}, "cluster.costs");
}

}  // namespace driftmesh::job
