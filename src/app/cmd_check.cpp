#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/commands.hpp"
#include "app/number_map.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/key_error.hpp"
#include "base/standard_streams.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/repair.hpp"
#include "gis/coordinates.hpp"
#include "io/mesh_file.hpp"
#include "job/check.hpp"
#include "job/contour.hpp"
#include "job/domain.hpp"
#include "job/files.hpp"
#include "job/input_file.hpp"
#include "job/memory.hpp"
#include "job/rasters.hpp"
#include "mesh/digest.hpp"
#include "mesh/settle_points.hpp"
#include "sizing/across.hpp"
#include "verify/report_text.hpp"
#include "verify/stayed.hpp"
#include "verify/verify.hpp"

namespace driftmesh::app {
namespace {

constexpr int kRejected = 1;
constexpr int kUnreadable = 2;

// Meters, of a mesh that may have been in longitudes and latitudes meanwhile: three units of the last place at 180
// degrees, and what these may do to the circumcircles of triangles.
constexpr double kRounded = 1e-8, kSlack = 100 * kRounded;

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

/// The mesh to check, in one piece or in several that are read one by one.
class CheckedMesh {
 public:
  CheckedMesh(const std::string& path, const ReadOptions& reading) {
    if (is_in_pieces(path))
      files_.emplace(path, reading);
    else
      whole_ = read_mesh(path, reading);
  }

  [[nodiscard]] Box box() const {
    if (!files_) return Box::of(whole_.points);
    Box box;
    for (std::size_t k = 0; k < files_->size(); ++k) box.extend(Box::of(files_->read(k).points));
    return box;
  }

  /// What the coordinates of its points are; empty: not known.
  [[nodiscard]] std::string projection() const {
    const std::string text = files_ && files_->size() > 0 ? files_->read(0).coordinates : whole_.coordinates;
    return coordinates_from(text).value_or(Coordinates{}).projection;
  }

  /// Points of a mesh that knows where it is on the globe, within what rounding moves longitudes and latitudes, become
  /// these, which are those of the input.
  void settle_on(std::vector<Point> places) {
    places_ = std::move(places);
    settle(whole_);
  }

  [[nodiscard]] VerifyReport verify(const Pslg* input, const VerifyOptions& options) {
    if (files_) return verify_files(input, options);
    digest_ = mesh_digest(whole_);
    return input != nullptr ? driftmesh::verify(whole_, *input, options) : driftmesh::verify(whole_, options);
  }
  /// After verify.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

 private:
  /// The digest of the whole mesh is the sum of those of the pieces.
  VerifyReport verify_files(const Pslg* input, VerifyOptions options) {
    std::vector<std::uint64_t> digests(files_->size());
    const Pieces pieces{files_->size(), [&](std::size_t k, const Pieces::Show& show) {
                          Mesh piece = files_->read(k);
                          settle(piece);
                          digests[k] = mesh_digest(piece);
                          show(piece);
                        }};
    options.threads = std::min(options.threads, pieces_at_once());
    VerifyReport report = verify_pieces(pieces, input, options);
    digest_ = std::accumulate(digests.begin(), digests.end(), std::uint64_t{0});
    return report;
  }

  /// As many as fit into half of the free memory; each takes about three times its file.
  [[nodiscard]] std::size_t pieces_at_once() const {
    const std::uint64_t free = job::free_memory(), each = 3 * files_->most_bytes();
    return free == 0 || each == 0 ? 1 : std::max<std::uint64_t>(1, free / 2 / each);
  }

  void settle(Mesh& mesh) const {
    if (!mesh.coordinates.empty()) settle_points(mesh.points, places_, kRounded);
  }

  std::optional<PieceFiles> files_;
  Mesh whole_;
  std::vector<Point> places_;
  std::uint64_t digest_ = 0;
};

VerifyReport read_and_verify(CheckOptions& options, const job::Request& request) {
  CheckedMesh mesh(options.mesh, options.reading);
  job::Request::Input asked = request.input;
  if (const std::string own = mesh.projection(); !own.empty()) {
    if (asked.projection == "auto") asked.projection = own;
    options.verify.delaunay_slack = kSlack;
  }
  const std::optional<InputFile> file = read_and_repair(options, asked);
  if (file) mesh.settle_on(file->pslg.points);
  const Pslg* const input = file ? &file->pslg : nullptr;
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
  options.verify.threads = options.threads != 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
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
  const StayedReport report = compare_stayed(read_mesh(options.against, options.reading),
                                             read_mesh(options.mesh, options.reading), map, options.verify.max_listed);
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
                 .take = cli::into(options.verify.min_angle, {0, 60})});
  return all;
}

std::vector<cli::Option> check_options(CheckOptions& options) {
  std::vector<cli::Option> all{
      {.kind = cli::Option::Kind::kPositional,
       .name = "mesh",
       .value = "MESH",
       .help = "The mesh: " + mesh_files_read(),
       .required = true,
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(options.mesh)},
      {.kind = cli::Option::Kind::kPositional,
       .name = "input",
       .value = "INPUT",
       .help = "The input that the mesh was made from; if given, the mesh must cover its domain and contain its "
               "segments, markers, points and regions",
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
