#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/triangle_files.hpp"
#include "base/standard_streams.hpp"
#include "cli/help_text.hpp"
#include "cli/values.hpp"
#include "triangle/switches.hpp"
#include "triangle/triangulate.hpp"

namespace driftmesh::app {
namespace {

const std::string kNotes =
    "Works like Triangle, switch by switch and file by file, with driftmesh's mesher. Through a link named triangle, "
    "the "
    "program is this command: ln -s driftmesh triangle; ./triangle -pq30 bay.poly.\n\n"
    "It reads FILE.poly (-p), FILE.node and FILE.ele (-r; with -p also FILE.poly, with -a also FILE.area), or "
    "FILE.node, and "
    "writes FILE.1.node, FILE.1.ele and FILE.1.poly, or with the next number if FILE ends in one. Items are numbered "
    "from 0 "
    "or 1, like the input.\n\n"
    "Switches, of which several may follow one dash, and numbers follow at once:\n\n"
    "  -p  segments, holes and regions of a .poly\n"
    "  -r  refine a mesh, whose points stay\n"
    "  -q  angles of at least 20 degrees, or -q30: of at least 30; 34 is the most\n"
    "  -a  areas of at most those of the regions or of the .area; -a0.1: of at most 0.1\n"
    "  -u  lengths of edges by --size\n"
    "  -A  triangles get the attributes of regions; with -p\n"
    "  -c  the convex hull counts as segments\n"
    "  -D  conforming Delaunay: all circumcircles are empty; also -s\n"
    "  -Y  no new points on the boundary; -YY: on no segment\n"
    "  -S  at most so many new points: -S100\n"
    "  -j  leave out points in no triangle\n"
    "  -e  also write edges (.edge)\n"
    "  -n  also write neighbors (.neigh)\n"
    "  -v  also write the Voronoi diagram (.v.node, .v.edge)\n"
    "  -g  also write an .off file for Geomview\n"
    "  -o2 triangles of six points\n"
    "  -O  ignore holes\n"
    "  -B  no markers; -P: no .poly; -N: no .node; -E: no .ele\n"
    "  -I  no number in file names; the .node and .poly that were read stay\n"
    "  -C  check the mesh\n"
    "  -Q  print nothing; -V: print more\n"
    "  -i -F -l -X -z  change nothing here";

struct TriangleOptions {
  std::string file;
  std::string switches;
  std::string size;
};

int run_triangle(const TriangleOptions& options) {
  triangle::Switches switches = triangle::parse_switches(options.switches);
  if (switches.help) {
    print(cli::help_text("driftmesh triangle", triangle_command()));
    return 0;
  }
  if (options.file.empty()) throw cli::UsageError("FILE is missing");
  if (!options.size.empty() && !switches.unsuitable)
    throw cli::UsageError("--size has a meaning with the switch -u only; add it");
  if (switches.unsuitable && options.size.empty())
    throw cli::UsageError("-u needs lengths of edges: --size EXPRESSION");
  TriangleFiles files(options.file, switches);
  const triangle::Tables input = files.read();
  const std::vector<std::string> outputs = files.outputs();
  triangle::Caller caller;
  caller.size = options.size;
  if (!switches.quiet) caller.warning = [](const std::string& warning) { print("Warning: " + warning + "\n"); };
  const triangle::Result result = triangle::triangulate(input, switches, caller);
  files.write(result);
  if (switches.quiet) return 0;
  for (const std::string& path : outputs) print("Writing " + path + ".\n");
  print("\nStatistics:\n\n" + triangle::statistics(input, result.mesh));
  return 0;
}

}  // namespace

cli::Command triangle_command() {
  const auto options = std::make_shared<TriangleOptions>();
  return {.name = "triangle",
          .summary = "Mesh as Triangle does, with its switches and files",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "file",
                       .value = "FILE",
                       .help = "The input: FILE.poly, FILE.node or FILE.ele, with or without the extension",
                       .completes = cli::Option::Completes::kFile,
                       .take = cli::into(options->file)},
                      {.name = "size",
                       .value = "EXPRESSION",
                       .help = "For -u: lengths of edges as a function of x and y (docs/size-expressions.md)",
                       .take = cli::into(options->size)}},
          .notes = kNotes,
          .examples = {"driftmesh triangle -pq30a0.1 box.poly", "driftmesh triangle -rpa0.02 box.1"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .take_switches = [options](const std::string& word) { options->switches += word; },
          .run = [options](cli::Call&) { return run_triangle(*options); }};
}

}  // namespace driftmesh::app
