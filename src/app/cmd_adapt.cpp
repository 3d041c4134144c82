#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/adapt_command.hpp"
#include "app/adapt_summary.hpp"
#include "app/commands.hpp"
#include "app/mesh_input.hpp"
#include "app/new_domain.hpp"
#include "app/number_map.hpp"
#include "app/progress_line.hpp"
#include "app/request_line.hpp"
#include "app/run_files.hpp"
#include "base/cores.hpp"
#include "base/staged_files.hpp"
#include "base/standard_streams.hpp"
#include "base/stopwatch.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "io/mesh_file.hpp"
#include "job/input_file.hpp"
#include "job/watch.hpp"
#include "mesh/bounds.hpp"
#include "patch/area.hpp"
#include "patch/point_data.hpp"
#include "patch/remake.hpp"
#include "patch/unmet.hpp"
#include "pslg/names.hpp"

namespace driftmesh::app {
namespace {

using NamedFields = std::vector<patch::NamedField>;

/// "'u', 'v'", or "no data" where there are none.
std::string list_of_names(const NamedFields& fields, FieldPlace place) {
  std::string list;
  for (const patch::NamedField& named : fields)
    if (named.field.place == place) list += (list.empty() ? "'" : ", '") + named.name + "'";
  return (list.empty() ? "no data" : list) + " at " + adapt::words_of(place);
}

[[noreturn]] void refuse_name(const NamedFields& fields, const std::string& what, const std::string& name,
                              const std::string& option, const AdaptCommand& command) {
  throw InputError(
      {command.mesh}, "has no " + what + " '" + name + "', which " + option + " names",
      "it has " + list_of_names(fields, FieldPlace::kPoints) + " and " + list_of_names(fields, FieldPlace::kTriangles));
}

/// All data of the mesh, those at points first.
NamedFields take_data(Mesh& mesh, TriangleData data) {
  NamedFields fields = patch::take_point_data(mesh);
  for (auto& named : data)
    fields.push_back({named.first, {.place = FieldPlace::kTriangles, .values = std::move(named.second)}});
  return fields;
}

std::vector<double> lengths_of(const NamedFields& fields, const AdaptCommand& command) {
  const auto found = std::ranges::find_if(fields, [&](const patch::NamedField& named) {
    return named.name == command.lengths && named.field.place == FieldPlace::kPoints;
  });
  if (found == fields.end()) refuse_name(fields, "point data", command.lengths, "--lengths", command);
  const std::vector<double>& lengths = found->field.values;
  for (std::size_t v = 0; v < lengths.size(); ++v)
    if (!(lengths[v] > 0))
      throw InputError(
          {command.mesh},
          fmt::format("has a length of {} in '{}' at point {} (counted from 0)", lengths[v], command.lengths, v),
          "lengths must be greater than 0");
  return lengths;
}

/// Data at points and at triangles may have one name; both are meant then.
void apply_transfers(NamedFields& fields, const AdaptCommand& command) {
  std::set<std::string> names;
  for (const std::string& transfer : command.transfers) {
    const std::size_t equals = transfer.rfind('=');
    const std::string how = equals == std::string::npos ? "" : transfer.substr(equals + 1);
    if (!how.empty() && how != "conserve" && how != "interpolate")
      throw cli::UsageError("--transfer is '" + transfer + "'; it is NAME, NAME=interpolate or NAME=conserve");
    const std::string name = transfer.substr(0, equals);
    if (!names.insert(name).second) throw cli::UsageError("--transfer names '" + name + "' twice; give it once");
    bool any = false;
    for (patch::NamedField& named : fields) {
      if (named.name != name) continue;
      any = true;
      if (how != "conserve") continue;
      try {
        patch::conserve(named, !command.outline.empty());
      } catch (const Error& error) {
        throw InputError(command.mesh + ": " + error.what());
      }
    }
    if (!any) refuse_name(fields, "data", name, "--transfer", command);
  }
}

/// Puts data at points into the mesh, and returns those at triangles. `names`: of the fields, in their order.
TriangleData give_data(patch::Remade& remade, const NamedFields& names) {
  TriangleData data;
  const auto points = static_cast<std::size_t>(remade.mesh.attributes_per_point);
  for (std::size_t i = points; i < names.size(); ++i) data.emplace(names[i].name, std::move(remade.fields[i].values));
  remade.fields.resize(points);
  patch::give_point_data(remade.mesh, remade.fields);
  return data;
}

std::optional<Box> box_from(const std::string& text) {
  Box box;
  try {
    const std::vector<std::string> words = cli::separated(text);
    if (words.size() != 4) return std::nullopt;
    const auto number = [&](std::size_t i) { return cli::read_number(words[i], {}); };
    box.extend(Point{number(0), number(1)});
    box.extend(Point{number(2), number(3)});
  } catch (const cli::UsageError&) {
    return std::nullopt;
  }
  return box;
}

std::optional<double> region_named(const Mesh& mesh, const std::string& text) {
  for (const auto& [attribute, name] : mesh.names.regions)
    if (name == text) return attribute;
  const std::optional<double> region = region_from(text);
  return region && std::ranges::find(mesh.regions, *region) != mesh.regions.end() ? region : std::nullopt;
}

/// "the regions 1 'sand', 2", or "no regions".
std::string list_of_regions(const Mesh& mesh) {
  constexpr std::size_t kMost = 20;
  const std::set<double> regions(mesh.regions.begin(), mesh.regions.end());
  std::vector<std::string> words;
  for (const double region : regions) {
    if (words.size() == kMost) {
      words.push_back(fmt::format("... {} in all", regions.size()));
      break;
    }
    const auto name = mesh.names.regions.find(region);
    words.push_back(fmt::format("{}", region) + (name == mesh.names.regions.end() ? "" : " '" + name->second + "'"));
  }
  return words.empty() ? "no regions" : fmt::format("the regions {}", fmt::join(words, ", "));
}

/// The triangles that --only names.
std::vector<bool> area_of(const Mesh& mesh, const AdaptCommand& command) {
  const std::string& only = command.only;
  std::vector<bool> inside;
  if (const std::optional<Box> box = box_from(only)) {
    inside = patch::triangles_in(mesh, *box);
  } else if (const std::optional<double> region = region_named(mesh, only)) {
    inside = patch::triangles_of_region(mesh, *region);
  } else if (std::filesystem::exists(only)) {
    InputFile input = read_input(only);
    repair(input.pslg, only);
    inside = patch::triangles_in(mesh, input.pslg);
  } else {
    throw cli::UsageError("--only is '" + only + "', which is no box x0,y0,x1,y1, no region of " + command.mesh +
                          " (it has " + list_of_regions(mesh) + "), and no file that exists");
  }
  if (std::ranges::find(inside, true) == inside.end())
    throw InputError({command.mesh}, "has no triangle in '" + only + "', which --only names",
                     fmt::format("its points lie from {:.10g},{:.10g} to {:.10g},{:.10g}", Box::of(mesh.points).low.x,
                                 Box::of(mesh.points).low.y, Box::of(mesh.points).high.x, Box::of(mesh.points).high.y));
  return inside;
}

/// What is recorded of stages, for the summary.
class StageNotes final : public job::Watch {
 public:
  explicit StageNotes(bool shows) : line_(shows) {}
  void begins(const std::string& stage) override { line_.begin(stage); }
  void warned(const std::string& warning) override { std::cerr << "warning: " << warning << '\n'; }
  void end() { line_.end(); }

 private:
  ProgressLine line_;
};

/// If more than half has to change, all does.
patch::Unmet what_is_to_change(const Mesh& mesh, patch::Order& order, const AdaptCommand& command) {
  const double threshold = command.threshold.value_or(AdaptCommand::kThreshold);
  patch::Unmet unmet;
  try {
    order.linked = patch::link(mesh);
    unmet =
        patch::find_unmet(mesh, order.linked->triangulation, order.lengths, order.options, order.min_angle, threshold);
  } catch (const Error& error) {
    throw InputError(command.mesh + ": " + error.what());
  }
  const auto change = std::ranges::count(unmet.triangles, true);
  if (threshold == 1 || 2 * change > static_cast<std::ptrdiff_t>(mesh.triangles.size()))
    unmet.triangles.assign(mesh.triangles.size(), true);
  return unmet;
}

void require_consistent(const AdaptCommand& command) {
  const AdaptiveOptions& options = command.options;
  const bool has_lengths = !command.lengths.empty() || options.shortest > 0 || !std::isinf(options.longest);
  if (!has_lengths && command.only.empty() && command.outline.empty())
    throw cli::UsageError(
        "nothing says what is to change; give --lengths, --max-length or --min-length, or --only or a new --outline");
  if (options.shortest > options.longest)
    throw cli::UsageError(
        fmt::format("--min-length is {}, which is more than --max-length {}", options.shortest, options.longest));
  if (command.outline.empty() && command.tolerance > 0)
    throw cli::UsageError("--outline-tolerance is for --outline, which is not given");
  for (const auto& [option, value] : {std::pair{"--only", command.only}, std::pair{"--outline", command.outline}})
    if (command.threshold && !value.empty())
      throw cli::UsageError(std::string("--threshold is for all of a mesh, and ") + option +
                            " says what is made anew; leave out one of them");
}

void run_adapt(const AdaptCommand& command) {
  require_consistent(command);
  FileRegistry files;
  register_mesh_input(files, command.mesh, "MESH", command.reading);
  register_mesh_output(files, command.output, "--output");
  require_whole(command.output);
  register_output(files, command.map, "--map");
  if (!command.outline.empty())
    for (const std::string& file : input_files(command.outline)) files.reads(file, "--outline");
  StageNotes notes(!command.quiet);
  TriangleData data;
  const char* const reading = command.outline.empty() ? "read" : "read mesh";  // reading the outline is another stage
  Mesh mesh = job::timed(notes, reading, [&] { return read_any_mesh(command.mesh, command.reading, data); });
  const std::size_t before = mesh.triangles.size();
  NamedFields named = take_data(mesh, std::move(data));
  patch::Order order{
      .options = command.options, .min_angle = command.angle, .threads = threads_or_cores(command.threads)};
  if (!command.lengths.empty()) order.lengths = lengths_of(named, command);
  apply_transfers(named, command);
  patch::Unmet unmet;
  if (!command.only.empty()) {
    order.inside = area_of(mesh, command);
  } else if (command.outline.empty()) {
    unmet = job::timed(notes, "compare", [&] { return what_is_to_change(mesh, order, command); });
    order.inside = unmet.triangles;
  }
  patch::NewDomain domain;
  if (!command.outline.empty()) {
    domain = read_new_domain(command.outline, command.tolerance, mesh, notes);
    order.domain = &domain;
  }
  const Box box = Box::of(mesh.points);
  std::vector<adapt::Field> fields;
  for (patch::NamedField& field : named) fields.push_back(std::move(field.field));  // names stay, in their order
  patch::Remade remade = job::timed(notes, "remake", [&] {
    try {
      return patch::remake(std::move(mesh), std::move(fields), std::move(order));
    } catch (const LimitError&) {
      throw;
    } catch (const InputError&) {
      throw;
    } catch (const Error& error) {
      throw InputError(command.mesh + ": " + error.what());
    }
  });
  const TriangleData new_data = give_data(remade, named);
  StagedFiles staged;
  job::timed(notes, "write", [&] {
    if (!command.map.empty()) write_number_map(command.map, remade.old_points, remade.old_triangles);
    write_mesh(remade.mesh, new_data, command.output,
               {.warn = [](const std::string& w) { std::cerr << "warning: " << w << '\n'; }});
  });
  staged.commit();
  notes.end();
  if (!command.outline.empty())
    if (const std::string warning = warning_if_nothing_stays(remade, box, command); !warning.empty())
      notes.warned(warning);
  if (!command.quiet) print(adapt_summary(remade, unmet, before, command, notes.take_stages()));
}

std::vector<cli::Option> adapt_options(AdaptCommand& command) {
  constexpr double kMost = std::numeric_limits<double>::max();
  return {
      {.kind = cli::Option::Kind::kPositional,
       .name = "mesh",
       .value = "MESH",
       .help = "The mesh: " + mesh_inputs(),
       .required = true,
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.mesh)},
      {.name = "output",
       .letter = 'o',
       .value = "NEW",
       .help = "The new mesh; its extension selects the format: " + whole_mesh_files_written(),
       .required = true,
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.output)},
      {.name = "lengths",
       .value = "NAME",
       .help = "The point data that have the length of edges that is wanted at each point, linear between them",
       .take = cli::into(command.lengths)},
      {.name = "transfer",
       .value = "NAME[=conserve]",
       .help = "How data get to the new mesh: interpolated, as all at points are, taken from the old triangle at the "
               "center of a new one, as all at triangles are, or such that their integrals stay",
       .repeats = true,
       .take = cli::into(command.transfers)},
      {.name = "only",
       .value = "AREA",
       .help = "Make only this part anew, and as much around it as the angle bound takes; all else keeps its "
               "points, triangles and numbers: a box x0,y0,x1,y1, the name or number of a region, or a file of "
               "polygons",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.only)},
      {.name = "outline",
       .value = "FILE",
       .help = "The domain that the mesh is to have from now on, in a file as driftmesh mesh reads it; made anew is "
               "what touches a line where the outlines differ, and as much around it as the angle bound takes",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.outline)},
      {.name = "outline-tolerance",
       .value = "LENGTH",
       .help = "Lines of both outlines that are so near to each other are the same; 0: as near as rounding puts them",
       .standard = "0",
       .take = cli::into(command.tolerance, {0, kMost})},
      {.name = "map",
       .value = "FILE.csv",
       .help = "Write which points and triangles are new (old number -1) or have another number than before, "
               "counted from 0",
       .completes = cli::Option::Completes::kFile,
       .take = cli::into(command.map)},
      {.name = "angle",
       .letter = 'q',
       .value = "DEGREES",
       .help = "Smallest angle of new triangles, except where the outline has smaller ones",
       .standard = fmt::format("{}", defaults::kMinAngle),
       .take = cli::into(command.angle, {0, kMaxAngle})},
      {.name = "min-length",
       .value = "LENGTH",
       .help = "Shorter lengths are raised to this one",
       .take = cli::into(command.options.shortest, {0, kMost})},
      {.name = "max-length",
       .value = "LENGTH",
       .help = "Longer lengths are lowered to this one",
       .take = cli::into(command.options.longest, {.least = 0, .most = kMost, .above = true})},
      {.name = "threshold",
       .value = "FACTOR",
       .help = "Without --only and --outline: where edges are not longer than wanted, and shorter by less than this "
               "factor, what is "
               "there stays; 1: all is made anew",
       .standard = fmt::format("{}", AdaptCommand::kThreshold),
       .take = cli::into(command.threshold, {1, kMost})},
      {.name = "gradation",
       .value = "GROWTH",
       .help = "Lengths grow by at most this much per unit of distance; 0: no limit",
       .standard = "0.2",
       .take = cli::into(command.options.gradation, {0, kMost})},
      {.name = "max-triangles",
       .value = "COUNT",
       .help = "Stop if what is made anew would have more triangles",
       .take = cli::into(command.options.most_triangles, {.least = 0, .most = kMost, .above = true})},
      {.name = "threads",
       .value = "N",
       .help = "Number of threads, on which nothing depends but time; 0: as many as the machine has cores",
       .standard = "0",
       .take = cli::into(command.threads, {0, 1024})},
      {.kind = cli::Option::Kind::kFlag,
       .name = "quiet",
       .help = "Print no summary and no progress",
       .take = cli::into(command.quiet)},
      allow_outside_option(command.reading)};
}

}  // namespace

cli::Command adapt_command() {
  const auto command = std::make_shared<AdaptCommand>();
  return {.name = "adapt",
          .summary = "Refine and coarsen a mesh from a file, or a part of it",
          .options = adapt_options(*command),
          .notes =
              "The outline, markers, regions and names are those of the mesh, unless --outline gives another one. "
              "What data it has at points, and in .vtu, .pvtu, .msh and .h5 at triangles, comes along.",
          .examples = {"driftmesh adapt flow.vtu --lengths h -o next.vtu",
                       "driftmesh adapt port.vtu --outline new-pier.geojson --map numbers.csv -o next.vtu"},
          .exit_codes = "0 done, 1 error, 2 wrong usage, 3 stopped by a limit",
          .run = [command](cli::Call&) {
            run_adapt(*command);
            return 0;
          }};
}

}  // namespace driftmesh::app
