#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/mesh_input.hpp"
#include "app/report_frames.hpp"
#include "app/run_files.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "sizing/size_tree_file.hpp"
#include "study/run_report.hpp"

namespace driftmesh::app {
namespace {

namespace fs = std::filesystem;

/// More would exceed what browsers hold in one page.
constexpr std::size_t kMostTriangles = 20'000'000;

struct ReportCommand {
  std::vector<std::string> inputs;
  std::string mesh;
  std::string size_tree;
  std::string field;
  std::string output = "report.html";
  ReadOptions reading;
};

/// The lengths that the compiled field in this file asks for in the middle of the triangles.
std::vector<float> sizes_in(const Mesh& mesh, const std::string& path) {
  const std::unique_ptr<SizeTree> tree = read_size_tree(path);
  std::vector<float> sizes;
  sizes.reserve(mesh.triangles.size());
  try {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
      sizes.push_back(static_cast<float>(tree->edge_length({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3})));
    }
  } catch (const InputError&) {
    throw;
  } catch (const Error&) {
    throw InputError({path}, "has no lengths for some triangles of the mesh",
                     "name the file that --save-size-tree made with this mesh");
  }
  return sizes;
}

void run_report(const ReportCommand& command) {
  if (command.inputs.empty() && command.mesh.empty())
    throw cli::UsageError("name a run, a folder of runs, meshes to be played, or a --mesh");
  if (fs::path(command.output).extension() != ".html")
    throw InputError({command.output}, "is not a page", "use a name that ends in .html");
  FileRegistry files;
  if (!command.size_tree.empty() && command.mesh.empty()) throw cli::UsageError("--size-tree needs a --mesh");
  std::vector<std::string> runs, frames;
  for (const std::string& input : command.inputs) (holds_frames(input) ? frames : runs).push_back(input);
  if (!command.field.empty() && frames.empty()) throw cli::UsageError("--field needs meshes to be played");
  const std::vector<fs::path> records = study::records_of(runs);
  for (const fs::path& record : records) files.reads(record.string(), "RUN");
  if (!command.mesh.empty()) register_mesh_input(files, command.mesh, "--mesh", command.reading);
  if (!command.size_tree.empty()) files.reads(command.size_tree, "--size-tree");
  std::optional<FrameFiles> series;
  if (!frames.empty()) series = list_frames(frames, files, command.reading);
  register_output(files, command.output, "--output");
  ReportedMesh mesh;
  if (!command.mesh.empty())
    mesh = {fs::path(command.mesh).filename().string(), read_any_mesh(command.mesh, command.reading), {}};
  if (mesh.mesh.triangles.size() > kMostTriangles)
    throw InputError(
        {command.mesh, 0},
        fmt::format("has {} triangles, and a page shows at most {}", mesh.mesh.triangles.size(), kMostTriangles),
        "make a picture with `driftmesh plot`");
  if (!command.size_tree.empty()) mesh.sizes = sizes_in(mesh.mesh, command.size_tree);
  std::optional<PackedFrames> packed;
  if (series) packed = pack_frames(*series, command.field, kMostTriangles, command.reading);
  study::write_report(command.output, records, mesh, packed ? &*packed : nullptr);
  std::vector<std::string> parts;
  const auto count = [&](std::size_t number, const char* word) {
    if (number > 0) parts.push_back(fmt::format("{} {}{}", number, word, number == 1 ? "" : "s"));
  };
  count(records.size(), "run");
  count(mesh.mesh.triangles.size(), "triangle");
  count(packed ? packed->size() : 0, "frame");
  fmt::print("{}: {}\n", command.output, fmt::join(parts, ", "));
}

}  // namespace

cli::Command report_command() {
  const auto command = std::make_shared<ReportCommand>();
  return {
      .name = "report",
      .summary = "Make a page for browsers of runs, a mesh, or meshes that follow each other",
      .options =
          {{.kind = cli::Option::Kind::kPositional,
            .name = "run",
            .value = "RUN",
            .help = "Records of runs (--json of mesh, or run-*.json), or folders that `driftmesh run` has written. A "
                    "trace beside a record adds the timeline. Meshes, or a .pvd that names some, are frames that the "
                    "page plays, with one field as colors",
            .repeats = true,
            .completes = cli::Option::Completes::kFile,
            .take = cli::into(command->inputs)},
           {.name = "mesh",
            .value = "FILE",
            .help = "A mesh to look at: " + mesh_inputs(),
            .completes = cli::Option::Completes::kFile,
            .take = cli::into(command->mesh)},
           {.name = "size-tree",
            .value = "FILE",
            .help =
                "The lengths of edges that the mesh was asked for, by --save-size-tree of `driftmesh mesh`: the page "
                "shows them, and edges in relation to them",
            .completes = cli::Option::Completes::kFile,
            .take = cli::into(command->size_tree)},
           {.name = "field",
            .value = "NAME",
            .help = "The data at points or triangles of the meshes that are played, if there are several",
            .take = cli::into(command->field)},
           {.name = "output",
            .letter = 'o',
            .value = "FILE",
            .help = "The page. It needs no network and no other file",
            .standard = command->output,
            .completes = cli::Option::Completes::kFile,
            .take = cli::into(command->output)},
           allow_outside_option(command->reading)},
      .examples = {"driftmesh report results/ -o report.html", "driftmesh report flow_*.vtu --field depth -o flow.html",
                   "driftmesh mesh bay.poly --area 5000 -o bay.vtu --json bay.json && driftmesh report bay.json --mesh "
                   "bay.vtu"},
      .exit_codes = "0 done, 1 error, 2 wrong usage",
      .run = [command](cli::Call&) {
        run_report(*command);
        return 0;
      }};
}

}  // namespace driftmesh::app
