#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh::app {
namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
};

// Triangle's file set and a mesh in pieces consist of several files; none of them may overwrite one being read.
void refuse_to_overwrite_input(const ConvertOptions& options) {
  std::error_code ignored;
  for (const std::string& read : files_to_read(options.input))
    for (const std::string& written : mesh_files(options.output))
      if (std::filesystem::equivalent(read, written, ignored))
        throw InputError({written, 0}, "is the input itself", "choose another name for the output");
}

}  // namespace

cli::Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {.name = "convert",
          .summary = "Write a mesh in another format",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "input",
                       .value = "INPUT",
                       .help = "The mesh: .vtu, .pvtu, .msh, or any file of Triangle's .node/.ele set",
                       .required = true,
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(options->input)},
                      {.kind = cli::Option::Kind::kPositional,
                       .name = "output",
                       .value = "OUTPUT",
                       .help = "The new file; its extension chooses the format",
                       .required = true,
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(options->output)}},
          .examples = {"driftmesh convert bay.vtu bay.msh"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [options](cli::Call&) {
            refuse_to_overwrite_input(*options);
            write_mesh(read_mesh(options->input), options->output);
            return 0;
          }};
}

}  // namespace driftmesh::app
