#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/run_files.hpp"
#include "cli/values.hpp"
#include "io/mesh_file.hpp"

namespace driftmesh::app {
namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
  ReadOptions reading;
  WriteOptions writing;
};

void run_convert(const ConvertOptions& options) {
  FileRegistry files;
  register_mesh_input(files, options.input, "INPUT", options.reading);
  register_mesh_output(files, options.output, "OUTPUT");
  write_mesh(read_mesh(options.input, options.reading), options.output, options.writing);
}

}  // namespace

cli::Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {.name = "convert",
          .summary = "Write a mesh in another format",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "input",
                       .value = "INPUT",
                       .help = std::string("The mesh: ") + kMeshFiles,
                       .required = true,
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(options->input)},
                      {.kind = cli::Option::Kind::kPositional,
                       .name = "output",
                       .value = "OUTPUT",
                       .help = "The new file; its extension selects the format",
                       .required = true,
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(options->output)},
                      {.kind = cli::Option::Kind::kFlag,
                       .name = "ascii",
                       .help = "Write .msh as text, for programs that read no binary one (deal.II)",
                       .take = cli::into(options->writing.ascii)},
                      {.name = "open-boundary",
                       .value = "MARKERS",
                       .help = "Markers of the segments that are open sea, in .14, .grd and .gr3; others are land",
                       .take = cli::into(options->writing.open_boundary)},
                      allow_outside_option(options->reading)},
          .examples = {"driftmesh convert bay.vtu bay.msh"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [options](cli::Call&) {
            run_convert(*options);
            return 0;
          }};
}

}  // namespace driftmesh::app
