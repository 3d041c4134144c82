#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapt/fields.hpp"
#include "adapt/saved.hpp"
#include "app/checked_mesh.hpp"
#include "app/commands.hpp"
#include "app/mesh_input.hpp"
#include "app/number_map.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/cores.hpp"
#include "base/key_error.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/repair.hpp"
#include "gis/coordinates.hpp"
#include "job/check.hpp"
#include "job/contour.hpp"
#include "job/domain.hpp"
#include "job/files.hpp"
#include "job/input_file.hpp"
#include "job/rasters.hpp"
#include "sizing/across.hpp"
#include "verify/report_text.hpp"
#include "verify/stayed.hpp"
#include "verify/verify.hpp"

namespace driftmesh::app {
namespace {

constexpr int kRejected = 1;
constexpr int kUnreadable = 2;

// Of a mesh that may have been in other coordinates meanwhile: what that may do to circumcircles of triangles.
constexpr double kSlack = 100 * kRoundedPlaces;

struct CheckOptions {
  std::string mesh;
  std::string input;
  std::string against;
  std::string map;
  VerifyOptions verify;
  Pslg given;  // the input before it is repaired, if needed
  std::unique_ptr<const SizeField> size;
  std::shared_ptr<const Raster> depth;
  GivenKeys bounds;
  bool angle_given = false;
  bool quiet = false;
  std::size_t threads = 0;  // 0: as many as the machine has cores
  ReadOptions reading;
};

/// Keeps what has polygons as the file has it, too.
std::optional<InputFile> read_and_repair(CheckOptions& options, const job::Request::Input& asked) {
  if (options.input.empty() && asked.contour.empty()) return std::nullopt;
  InputFile input = asked.contour.empty() ? job::read_domain_file(options.input, asked) : job::contour_input(asked);
  if (!input.pslg.polygons.empty() && asked.close_channels == 0) {
    options.given = input.pslg;
    options.verify.given = &options.given;
  }
  options.verify.moved = asked.snap + asked.simplify;
  options.verify.holes = job::holes_left(asked);
  const std::string name = asked.contour.empty() ? options.input : job::contour_files(asked);
  const RepairReport repairs = job::clean_input(asked, name, input.pslg);
  if (!options.quiet) print(repairs.summary());
  return input;
}

/// "'u' at points (2 values each), 'q' at triangles"
std::string list_of_fields(const adapt::Fields& fields) {
  std::string list;
  for (const auto& [name, field] : fields) {
    list += (list.empty() ? "'" : ", '") + name + "' at " + adapt::words_of(field.place);
    if (field.components != 1) list += fmt::format(" ({} values each)", field.components);
  }
  return list.empty() ? "no fields" : list;
}

/// A saved adaptive mesh must meet the bounds of its session, unless others are given.
void judge_by(const adapt::SavedHead& session, CheckOptions& options) {
  const QualityBounds& bounds = session.plan.bounds;
  if (!options.angle_given) options.verify.min_angle = bounds.min_angle;
  if (options.verify.plain.area == 0) options.verify.plain.area = bounds.plain.area;
  options.verify.plain.region_areas = options.verify.plain.region_areas && bounds.plain.region_areas;
  if (!options.quiet)
    print(fmt::format("session        generation {}, {}\n", session.generation, list_of_fields(session.fields)));
}

VerifyReport read_and_verify(CheckOptions& options, const job::Request& request) {
  CheckedMesh mesh(options.mesh, options.reading);
  const adapt::SavedHead* const session = mesh.session();
  if (session != nullptr) judge_by(*session, options);
  job::Request::Input asked = request.input;
  if (const std::string own = mesh.projection(); !own.empty()) {
    if (asked.projection == "auto") asked.projection = own;
    if (session == nullptr) options.verify.delaunay_slack = kSlack;
  }
  const std::optional<InputFile> file = read_and_repair(options, asked);
  if (file) mesh.settle_on(file->pslg.points);
  const Pslg* const input = file ? &file->pslg : session != nullptr ? &session->pslg : nullptr;
  const bool sized = request.sizing.varies() || request.sizing.longest > 0 || request.sizing.courant_step > 0;
  SizingOptions sizes = input != nullptr ? job::sizing_of(request.sizing, *input)
                                         : job::sizing_of(request.sizing, sized ? mesh.box() : Box{});
  sizes.exact = true;
  sizes.across = 0;  // layers are counted, whatever they take
  job::Rasters rasters = job::rasters_of(request, file ? file->projection : "");
  open_all(rasters, sizes.domain, {});
  options.depth = rasters.depths();
  sizes.rasters = std::move(rasters.open);
  options.verify.courant = job::courant_of(request.sizing);
  if (options.verify.courant.step > 0) options.verify.depth = options.depth.get();
  options.verify.threads = to_index(threads_or_cores(options.threads));
  options.size = make_size_field(sizes);
  options.verify.size = options.size.get();
  // Lengths whose growth is limited cannot fall much between the points that are looked up anyway.
  if (!request.sizing.expression.empty() && request.sizing.gradation == 0) options.verify.size_spacing = sizes.spacing;
  options.verify.across = {request.sizing.across, width_for(request.sizing.shortest, request.sizing.across)};
  options.verify.size_is_compiled = !request.sizing.expression.empty() || !request.sizing.background.empty();
  VerifyReport report = mesh.verify(input, options.verify);
  if (!options.quiet) print(fmt::format("digest         {:016x}\n", mesh.digest()));
  return report;
}

/// Prints what of an older mesh stayed. Whether nothing contradicts.
bool keeps_what_was(const CheckOptions& options) {
  if (options.against.empty()) return true;
  std::optional<NumberMap> map;
  if (!options.map.empty()) map = read_number_map(options.map);
  const StayedReport report =
      compare_stayed(read_any_mesh(options.against, options.reading), read_any_mesh(options.mesh, options.reading), map,
                     options.verify.max_listed);
  if (!options.quiet) print("against        " + options.against + "\n" + stayed_text(report, map.has_value()));
  if (report.contradictions > 0)
    print(fmt::format("rejected: contradicts what {} has{} ({})\n", options.against, map ? ", or its map" : "",
                      report.contradictions));
  return report.contradictions == 0;
}

int run_check(CheckOptions& options) {
  if (options.against.empty() && !options.map.empty())
    throw cli::UsageError("--map is for --against, which is not given");
  job::Request request;
  in_words_of_options(options.bounds, {}, [&] {
    options.bounds.apply(request);
    request.input.file = options.input;
    job::check(request, job::kOnePiece);
    job::check_given(request, options.bounds.names());
  });
  options.verify.plain = request.bounds;
  try {
    const VerifyReport report = read_and_verify(options, request);
    if (!options.quiet) print(report_text(report, options.verify));
    const bool keeps = keeps_what_was(options);
    if (keeps || !report.accepted()) print(verdict_text(report, options.verify) + "\n");
    flush_standard_output();
    return keeps && report.accepted() ? 0 : kRejected;
  } catch (const Error& error) {
    std::cerr << "driftmesh: " << text_of(error).in(job::words_of(job::kCheck)) << '\n';
    return kUnreadable;
  }
}

std::vector<cli::Option> bound_options(CheckOptions& options) {
  constexpr const char* kGroup = "Bounds that the mesh must meet (as for driftmesh mesh)";
  std::vector<cli::Option> all = key_options(job::kCheck, options.bounds, kGroup);
  all.push_back({.name = "angle",
                 .letter = 'q',
                 .value = "DEGREES",
                 .help = "Smallest angle, except where the input forces smaller ones",
                 .group = kGroup,
                 .take = [&options, into = cli::into(options.verify.min_angle, {0, 60})](const std::string& text) {
                   into(text);
                   options.angle_given = true;
                 }});
  return all;
}

std::vector<cli::Option> check_options(CheckOptions& options) {
  std::vector<cli::Option> all{
      {.kind = cli::Option::Kind::kPositional,
       .name = "mesh",
       .value = "MESH",
       .help = "The mesh: " + mesh_inputs(),
       .required = true,
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(options.mesh)},
      {.kind = cli::Option::Kind::kPositional,
       .name = "input",
       .value = "INPUT",
       .help = "The input that the mesh was made from; if given, the mesh must cover its domain and contain its "
               "segments, markers, points and regions. A saved adaptive mesh has it in its file",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(options.input)},
      {.name = "against",
       .value = "OLD",
       .help = "An older mesh of which this one is to have kept all that did not change; reports what stayed, and "
               "rejects what contradicts: other boundary numbers, regions or data at triangles that stayed",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(options.against)},
      {.name = "map",
       .value = "FILE.csv",
       .help = "The map from the numbers of --against that driftmesh adapt has written; each entry is checked",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(options.map)},
      {.name = "list",
       .value = "N",
       .help = "Number of findings of each kind to print",
       .standard = std::to_string(options.verify.max_listed),
       .take = cli::into(options.verify.max_listed)},
      {.name = "threads",
       .value = "N",
       .help = "Number of threads; 0: as many as the machine has cores",
       .standard = "0",
       .take = cli::into(options.threads, {0, 1024})},
      {.kind = cli::Option::Kind::kFlag,
       .name = "strict",
       .help = "Reject a mesh with triangles that do not allow the time step of --courant-step; otherwise they are "
               "listed",
       .take = cli::into(options.verify.strict_step)},
      {.kind = cli::Option::Kind::kFlag,
       .name = "quiet",
       .help = "Print only the verdict",
       .take = cli::into(options.quiet)},
      allow_outside_option(options.reading)};
  std::ranges::move(bound_options(options), std::back_inserter(all));
  return all;
}

}  // namespace

cli::Command check_command() {
  const auto options = std::make_shared<CheckOptions>();
  return {.name = "check",
          .summary = "Verify a mesh file, independently of how it was made",
          .options = check_options(*options),
          .notes =
              "Angles below the bound are allowed where the input has them, and in wedges between input segments "
              "that meet at less than 60 degrees; the report lists them. Sizes are looked up in each triangle at its "
              "corners "
              "and centroid, and where they are asked for by an expression four times in each square of the domain's "
              "longer side over --size-resolution; there an edge may be 1.25 times what is asked for.",
          .examples = {"driftmesh check bay.vtu bay.poly --angle 20 --area 5000",
                       "driftmesh check next.vtu new-pier.geojson --against port.vtu --map numbers.csv"},
          .exit_codes = "0 accepted, 1 rejected, 2 a file could not be read or written, or wrong usage",
          .run = [options](cli::Call&) { return run_check(*options); }};
}

}  // namespace driftmesh::app
