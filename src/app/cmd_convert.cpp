#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh::app {
namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
};

// Triangle's set of files has five names, a mesh in pieces has some too; writing one must not replace another that is
// being read.
void refuse_to_overwrite_input(const ConvertOptions& options) {
  std::error_code ignored;
  for (const std::string& read : files_to_read(options.input))
    for (const std::string& written : mesh_files(options.output))
      if (std::filesystem::equivalent(read, written, ignored))
        throw InputError({written, 0}, "is the input itself", "choose another name for the output");
}

}  // namespace

void add_convert(CLI::App& program) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand("convert", "Write a mesh in another format");
  command->add_option("input", options->input, "The mesh: .vtu, .pvtu, .msh, or any file of Triangle's .node/.ele set")
      ->type_name("")
      ->required();
  command->add_option("output", options->output, "The new file; its extension chooses the format")
      ->type_name("")
      ->required();
  command->footer(
      "Example:\n"
      "  driftmesh convert bay.vtu bay.msh\n"
      "Exit code: 0 done, 1 error, 2 wrong usage.");
  command->callback([options] {
    refuse_to_overwrite_input(*options);
    write_mesh(read_mesh(options->input), options->output);
  });
}

}  // namespace driftmesh::app
