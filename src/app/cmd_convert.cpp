#include <fmt/format.h>

#include <cstddef>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "app/commands.hpp"
#include "app/mesh_input.hpp"
#include "app/run_files.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesh_order.hpp"
#include "io/mesh_file.hpp"
#include "mesh/mesh_edges.hpp"
#include "pslg/names.hpp"

namespace driftmesh::app {
namespace {

struct ConvertOptions {
  std::string input;
  std::string output;
  ReadOptions reading;
  WriteOptions writing;
  Names names;  // replace those of the mesh
  bool boundary_only = false;
  std::string order = kMeshOrders[0].second;
};

/// Removes subsegments with triangles on both sides.
void keep_boundary(Mesh& mesh) {
  const auto at_edges = triangles_at_edges(mesh, ConstrainedEdgeIndex(mesh));
  std::size_t kept = 0;
  for (std::size_t e = 0; e < at_edges.size(); ++e)
    if (at_edges[e][0] < 0 || at_edges[e][1] < 0) mesh.edges[kept++] = mesh.edges[e];
  mesh.edges.resize(kept);
}

/// Stores the parts of 5=inlet.
template <class Value>
cli::Take into_names(std::map<Value, std::string>& names, std::optional<Value> (*number_from)(std::string_view)) {
  return [&names, number_from](const std::string& text) {
    const std::size_t equals = text.find('=');
    const auto number = number_from(text.substr(0, equals));
    if (equals == std::string::npos || !number) throw cli::UsageError("is '" + text + "', which is not NUMBER=NAME");
    const auto name = names.try_emplace(*number, text.substr(equals + 1)).first;
    if (name->second != text.substr(equals + 1))
      throw cli::UsageError("gives " + text.substr(0, equals) + " two names, '" + name->second + "' and '" +
                            text.substr(equals + 1) + "'; remove one of them");
  };
}

/// Throws InputError if the options speak of markers or regions that the mesh has not.
void require_known(const ConvertOptions& options, const Mesh& mesh) {
  std::set<std::int32_t> markers{0};  // edges that are not listed have 0
  for (const Mesh::Edge& edge : mesh.edges) markers.insert(edge.marker);
  const std::set<double> regions(mesh.regions.begin(), mesh.regions.end());
  const auto fail = [&](const std::string& what, const char* option) {
    throw InputError({options.input}, "has no " + what + ", which " + option + " names",
                     "driftmesh check lists what it has");
  };
  for (const std::int32_t marker : options.writing.open_boundary)
    if (!markers.contains(marker)) fail("segment with marker " + std::to_string(marker), "--open-boundary");
  for (const auto& [marker, name] : options.names.markers)
    if (!markers.contains(marker)) fail("segment with marker " + std::to_string(marker), "--marker-name");
  for (const auto& [region, name] : options.names.regions)
    if (!regions.contains(region)) fail(fmt::format("region {}", region), "--region-name");
}

std::vector<std::string> words_of_orders() {
  std::vector<std::string> words;
  for (const auto& [order, word] : kMeshOrders) words.emplace_back(word);
  return words;
}

/// An option of some formats needs a file of one of them.
void require_served(const ConvertOptions& options) {
  const MeshFormat& format = format_of(options.output);
  const auto require_format = [&](bool asked, const std::string& option, bool MeshFormat::*something) {
    if (asked && !(format.*something))
      throw cli::UsageError(option + " is about " + mesh_files_with(something) + ", but OUTPUT is '" + options.output +
                            "'; give it such a name, or remove " + option);
  };
  require_format(options.writing.ascii, "--ascii", &MeshFormat::has_text);
  require_format(!options.writing.open_boundary.empty(), "--open-boundary", &MeshFormat::is_grid);
  require_format(options.writing.open_from > 0, "--open-from", &MeshFormat::is_grid);
}

void run_convert(const ConvertOptions& options) {
  require_served(options);
  FileRegistry files;
  register_mesh_input(files, options.input, "INPUT", options.reading);
  register_mesh_output(files, options.output, "OUTPUT");
  Mesh mesh = read_any_mesh(options.input, options.reading);
  require_known(options, mesh);
  Names names = options.names;
  names.markers.merge(mesh.names.markers);
  names.regions.merge(mesh.names.regions);
  mesh.names = std::move(names);
  if (options.boundary_only) keep_boundary(mesh);
  mesh = ordered(std::move(mesh), mesh_order_from(options.order));
  WriteOptions writing = options.writing;
  writing.warn = [](const std::string& warning) { std::cerr << "warning: " << warning << '\n'; };
  write_mesh(mesh, options.output, writing);
}

}  // namespace

cli::Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {.name = "convert",
          .summary = "Write a mesh in another format",
          .options =
              {{.kind = cli::Option::Kind::kPositional,
                .name = "input",
                .value = "INPUT",
                .help = "The mesh: " + mesh_inputs(),
                .required = true,
                .completes = cli::Option::Completes::kFile,
                .take = cli::into(options->input)},
               {.kind = cli::Option::Kind::kPositional,
                .name = "output",
                .value = "OUTPUT",
                .help = "The new file; its extension selects the format: " + whole_mesh_files_written(),
                .required = true,
                .completes = cli::Option::Completes::kFile,
                .take = cli::into(options->output)},
               {.kind = cli::Option::Kind::kFlag,
                .name = "ascii",
                .help = "Write .msh as text, for programs that read no binary one (deal.II)",
                .take = cli::into(options->writing.ascii)},
               {.kind = cli::Option::Kind::kFlag,
                .name = "boundary-only",
                .help = "Leave out segments inside of the domain, for programs that refuse them (deal.II)",
                .take = cli::into(options->boundary_only)},
               {.name = "order",
                .value = "ORDER",
                .help = "Order of points and triangles: given, hilbert (along a Hilbert curve) or rcm (reverse "
                        "Cuthill-McKee, for solvers: a small bandwidth)",
                .choices = words_of_orders(),
                .take = cli::into(options->order)},
               {.name = "open-boundary",
                .value = "MARKERS",
                .help = "Markers of the segments that are open sea, in .14, .grd and .gr3 (default: those called open)",
                .take = cli::into(options->writing.open_boundary)},
               {.name = "open-from",
                .value = "LENGTH",
                .help = "Shortest open boundary in .14, .grd and .gr3; shorter ones, such as creeks that the frame of "
                        "the domain cuts, are land",
                .take = cli::into(options->writing.open_from, {0, std::numeric_limits<double>::max()})},
               {.name = "crs",
                .value = "SYSTEM",
                .help = "Coordinates: lonlat (degrees on WGS 84), projected (meters of the plane in which the mesh was "
                        "made), a code such as EPSG:3035 (with GDAL), or auto: lonlat in .14, .grd and .gr3 if the "
                        "domain was given in degrees, otherwise projected",
                .take = cli::into(options->writing.crs)},
               {.name = "marker-name",
                .value = "MARKER=NAME",
                .help = "What a marker of segments is called in files that can hold names, such as 5=inlet",
                .repeats = true,
                .take = into_names(options->names.markers, marker_from)},
               {.name = "region-name",
                .value = "REGION=NAME",
                .help = "What a region is called in files that can hold names, such as 10=land",
                .repeats = true,
                .take = into_names(options->names.regions, region_from)},
               allow_outside_option(options->reading)},
          .examples = {"driftmesh convert bay.vtu bay.msh"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [options](cli::Call&) {
            run_convert(*options);
            return 0;
          }};
}

}  // namespace driftmesh::app
