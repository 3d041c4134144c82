#include "job/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "base/nearest_name.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "gis/coordinates.hpp"
#include "gis/projection.hpp"
#include "io/mesh_file.hpp"
#include "io/other_coordinates.hpp"
#include "job/contour.hpp"
#include "job/domain.hpp"
#include "job/keys.hpp"
#include "pslg/generators.hpp"
#include "sizing/named_raster.hpp"

namespace driftmesh::job {
namespace {

constexpr std::size_t kMaxVtNodes = 32'768;  // vt numbers nodes with 16 bits, one of them for the sign

/// Two literals, of which texts are made only if they are needed.
template <std::size_t N, std::size_t M>
void require(bool holds, const char* key, const char (&what)[N], const char (&next)[M]) {
  if (!holds) throw KeyError(key, what, next);
}

// ---- Each value by itself --------------------------------------------------------------------------------------

void check_value(const Key& key, const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) check_range(key, *number);
  if (const auto* number = std::get_if<std::int64_t>(&value)) check_range(key, static_cast<double>(*number));
  if (const auto* numbers = std::get_if<std::vector<double>>(&value))
    for (const double number : *numbers) check_range(key, number);
  if (key.kind == KeyInfo::Kind::kChoice) static_cast<void>(read_value(key, value.as<std::string>()));
}

// ---- Where it applies ------------------------------------------------------------------------------------------

[[noreturn]] void refuse_at(const Key& key, PlaceKind place, Method method) {
  if (key.places == kOnePiece)
    throw KeyError(key.name, "applies only to a mesh in one piece: incomplete subdomains would not fit together",
                   "remove it");
  if (key.places == kSimulated)
    throw KeyError(key.name, "applies only to simulated clusters", "remove it, or simulate the cluster");
  if ((key.places & kSubdomains) == 0 && method == Method::kRounds)
    throw KeyError(key.name, "is for ranks that depend on each other, but {run.method} is rounds",
                   "remove it, or use the coupled method");
  if ((key.places & kSubdomains) == 0)
    throw KeyError(key.name, "needs several ranks, but this process is alone", "start it with mpirun, or remove it");
  if (place != kOnePiece)
    throw KeyError(key.name, "does not apply here", "cut the domain with {decomposition.subdomains}, or remove it");
  throw KeyError(key.name, "applies only to a mesh in subdomains, but this one is made in one piece",
                 "cut the domain with {decomposition.subdomains}, or remove it");
}

void check_places(const Request& request, PlaceKind place) {
  for (const Key& key : keys())
    if ((key.places & place) == 0 && key.load(request) != key.standard) refuse_at(key, place, request.run.method);
}

// ---- Combinations of values ------------------------------------------------------------------------------------

void check_input(const Request::Input& input) {
  require(input.file.empty() || input.generator.empty(), "input.generate", "names a second domain",
          "remove it or {input.file}");
  require(input.contour.empty() || (input.file.empty() && input.generator.empty()), "input.contour",
          "makes the domain, but another one is given", "remove {input.file} and {input.generate}, or it");
  require(!input.contour.empty() || (input.contour_box.empty() && input.contour_seeds.empty()),
          input.contour_box.empty() ? "input.contour-seeds" : "input.contour-box", "serves {input.contour} alone",
          "give a raster and a level by {input.contour}, or remove it");
  if (!input.contour.empty()) static_cast<void>(contour_of(input));
  require(!input.degrees || !input.file.empty() || input.generator.empty(), "input.degrees",
          "is about a file, but the domain is generated", "remove it");
  if (input.projection != "auto" && !projection_named(input.projection))
    throw KeyError("input.projection", "is '" + input.projection + "'",
                   "write auto, a zone such as 'UTM zone 18N', or 'stereographic at LON LAT'");
  require(!input.generator.empty() || input.parameters.empty(), "input.parameters", "needs a model to generate",
          "name one with {input.generate}");
  if (input.generator.empty()) return;
  try {
    require_generated(input.generator, input.parameters);
  } catch (const Error& error) {
    throw KeyError("input.generate", KeyText::of("is invalid: {}", text_of(error)),
                   "driftmesh generate --help lists the models and their parameters");
  }
}

void check_crs(const std::string& crs) {
  if (crs != kByFormat && crs != kProjected && crs != kLonLat && !epsg_from(crs))
    throw KeyError("output.crs", "is '" + crs + "'", "write auto, lonlat, projected, or a code such as EPSG:3035");
}

void check_rasters(const Request& request) {
  for (const auto& [name, file] : request.input.rasters) {
    if (!can_name_raster(name))
      throw KeyError("input.rasters", "has the name '" + name + "'",
                     "a name has letters, digits and underscores, and no other meaning in expressions");
    if (file.empty()) throw KeyError("input.rasters", "names no file for '" + name + "'", "write NAME=FILE");
    if (std::ranges::count(files_in(file), "") > 0)
      throw KeyError("input.rasters", "has a comma without a file beside it in '" + file + "', for '" + name + "'",
                     "remove the comma, or name a file");
  }
  const std::string& depth = request.output.depth;
  if (!depth.empty() && !request.input.rasters.contains(depth))
    throw KeyError("output.depth", "is '" + depth + "', but no raster has this name",
                   "name its file in {input.rasters}");
  require(request.input.rasters.empty() || !depth.empty() || !request.sizing.expression.empty() ||
              !request.input.contour.empty(),
          "input.rasters", "serves {sizing.size} and {output.depth}, but neither is given", "give one of them");
}

/// What has no meaning without a time step; `is_set`: whether a key has a value that somebody chose.
template <class IsSet>
void check_served_step(const IsSet& is_set) {
  for (const char* key : {"sizing.courant", "sizing.courant-speed", "sizing.courant-length"})
    require(!is_set(key), key, "serves {sizing.courant-step}, which is not given", "give a time step, or remove it");
}

void check_step(const Request::Sizing& sizing, const std::string& depth) {
  require(sizing.courant_step == 0 || !depth.empty(), "sizing.courant-step", "needs depths",
          "name their raster with {output.depth}");
  if (sizing.courant_step > 0) return;
  Request asked;
  asked.sizing = sizing;
  check_served_step([&](const char* name) {
    const Key& key = *find_key(name).key;
    return key.load(asked) != key.standard;
  });
}

void check_every(bool is_set, const Request::Run& run) {
  require(!is_set || !run.checkpoint.empty(), "run.every", "is the time between checkpoints, but none are asked for",
          "name their file with {run.checkpoint}");
}

void check_sizes(const Request::Bounds& bounds, const Request::Sizing& sizing) {
  const bool has_sources = sizing.is_compiled() || !sizing.background.empty();
  require(sizing.tree.empty() || (!has_sources && sizing.longest == 0), "sizing.tree",
          "has all lengths, so that it cannot be combined with {sizing.size}, {sizing.background}, {sizing.across} or "
          "{sizing.max}",
          "remove it or these");
  require(sizing.tree.empty() || (bounds.triangles == 0 && bounds.triangles_per_rank == 0), "sizing.tree",
          "cannot be combined with a number of triangles", "remove one, or give {bounds.area}");
  require(sizing.save_tree.empty() || has_sources, "sizing.save-tree",
          "saves the lengths of {sizing.size} and {sizing.background}, but neither is given", "give one of them");
  require(bounds.area == 0 || bounds.triangles == 0, "bounds.triangles", "cannot be combined with {bounds.area}",
          "remove one of them");
  require(bounds.triangles_per_rank == 0 || (bounds.area == 0 && bounds.triangles == 0), "bounds.triangles-per-rank",
          "cannot be combined with {bounds.area} or {bounds.triangles}", "remove all but one");
  require(sizing.expression.empty() || (bounds.triangles == 0 && bounds.triangles_per_rank == 0), "sizing.size",
          "cannot be combined with a number of triangles", "remove one, or give {bounds.area}");
  require(sizing.across == 0 || (bounds.triangles == 0 && bounds.triangles_per_rank == 0), "sizing.across",
          "cannot be combined with a number of triangles", "remove one, or give {bounds.area}");
  require(
      sizing.gradation == 0 || has_sources, "sizing.gradation",
      "limits the growth of the lengths of {sizing.size}, {sizing.background} and {sizing.across}, but none of them "
      "is given",
      "give one of them");
  require(sizing.longest == 0 || sizing.shortest <= sizing.longest, "sizing.min", "is greater than {sizing.max}",
          "swap the two");
  require(sizing.shortest == 0 || has_sources || sizing.longest > 0, "sizing.min",
          "limits the lengths of {sizing.size}, {sizing.background}, {sizing.across} or {sizing.max}, but none of them "
          "is given",
          "give one of them");
}

void check_policy(const Request& request, const balancer::PolicyMaker& policies) {
  const auto parameters = parameters_of_policy(request);
  if (!policies) return;
  try {
    static_cast<void>(policies(request.balance.policy, parameters));
  } catch (const Error& error) {
    throw KeyError("balance.parameters", KeyText::of("is invalid: {}", text_of(error)), "see docs/balancing.md");
  }
}

void check_parts(const Request& request) {
  const Request::Decomposition& d = request.decomposition;
  require(d.subdomains == 0 || d.subdomains_per_rank == 0, "decomposition.subdomains-per-rank",
          "cannot be combined with {decomposition.subdomains}", "remove one of them");
  require(d.file.empty() || (d.subdomains == 0 && d.subdomains_per_rank == 0), "decomposition.file",
          "has a number of subdomains, but another one is given", "remove one of them");
  const Request::Mapping& m = request.mapping;
  require(m.file.empty() || (m.method == Request::Mapping{}.method && m.speeds.empty() && !m.by_speed && !m.by_area &&
                             m.to_late_ranks),
          "mapping.file", "replaces the mapping, but settings of one are given", "remove them or {mapping.file}");
  require(request.mapping.speeds.empty() || !request.mapping.by_speed, "mapping.by-speed",
          "cannot be combined with {mapping.speeds}", "remove one of them");
}

void check_rounds(const Request& request, PlaceKind place) {
  if (request.run.method != Method::kRounds) return;
  require((place & kMany) == 0, "run.method", "is rounds, which experiments do not have", "use driftmesh mesh");
  require(request.decomposition.subdomains != 1, "run.method", "is rounds, but one piece is asked for",
          "remove it or {decomposition.subdomains}");
}

void check_checkpoint(const Request::Run& run) {
  require(run.checkpoint.empty() || run.method == Method::kRounds, "run.checkpoint",
          "needs a run in rounds, but another method is asked for", "give {run.method} rounds");
  require(run.resume.empty() || run.method == Method::kRounds, "run.resume",
          "needs a run in rounds, but another method is asked for", "give {run.method} rounds");
  require(!is_standard_stream(run.checkpoint), "run.checkpoint", "is standard output, which keeps nothing",
          "name a file");
}

void check_method(const Request& request) {
  if (request.run.method != Method::kDecoupled) return;
  require(request.run.presplit != Presplit::kOff, "run.presplit",
          "is off, but the decoupled method splits interfaces beforehand", "remove it, or use the coupled method");
  require(!request.sizing.varies(), "run.method",
          "is decoupled, which needs the same bound on size everywhere, but lengths vary",
          "give {bounds.area} or {bounds.triangles} instead of lengths, or use the coupled method");
}

/// What partially coupled refinement does without.
void check_pdr(const Request& request, PlaceKind place) {
  if (request.run.method != Method::kPdr) return;
  require(place == kRanks || place == kSimulated, "run.method", "is pdr, which only experiments have",
          "use driftmesh run");
  require(!request.sizing.varies() && request.sizing.longest == 0, "run.method",
          "is pdr, which needs the same bound on size everywhere, but lengths vary",
          "give {bounds.area} or {bounds.triangles} instead of lengths, or use the coupled method");
  require(request.bounds.area > 0 || request.bounds.triangles > 0 || request.bounds.triangles_per_rank > 0,
          "run.method", "is pdr, but nothing bounds the size of triangles",
          "give {bounds.area} or {bounds.triangles}, or use the coupled method");
  require(request.bounds.angle > 0, "run.method", "is pdr, which needs a bound on angles", "give {bounds.angle}");
  const Request standard;
  const bool parts = request.decomposition != standard.decomposition || request.mapping != standard.mapping;
  require(!parts, "run.method", "is pdr, which has no subdomains to cut or map", "remove what sets them");
  require(request.run.presplit == standard.run.presplit, "run.presplit",
          "has no meaning with pdr: it has no interfaces", "remove it");
  require(request.balance.policy == standard.balance.policy, "balance.policy", "has nothing to move with pdr",
          "remove it");
  require(request.run.threads <= 1 && !request.run.sleep && request.run.scratch.empty(), "run.method",
          "is pdr, whose ranks have one thread and one mesh in memory",
          "remove {run.threads}, {run.sleep} and {run.scratch}");
}

/// An option of some formats needs a file of one of them.
void check_format_options(const Request::Output& output) {
  const auto require_format = [&](bool asked, const char* key, bool MeshFormat::*something) {
    const auto has_it = [&](const std::string& file) { return format_of(file).*something; };
    if (!asked || std::ranges::any_of(output.meshes, has_it)) return;
    throw KeyError(key, "is about " + mesh_files_with(something) + ", but no such file is written",
                   "name one with {output.meshes}, or remove it");
  };
  require_format(output.ascii, "output.ascii", &MeshFormat::has_text);
  require_format(output.ghost_layer, "output.ghost-layer", &MeshFormat::has_ghosts);
  require_format(!output.open_boundary.empty(), "output.open-boundary", &MeshFormat::is_grid);
  require_format(output.open_from > 0, "output.open-from", &MeshFormat::is_grid);
}

void check_output(const Request& request) {
  const Request::Output& output = request.output;
  check_format_options(output);
  require(output.session.empty() || request.run.method == Method::kRounds, "output.session",
          "needs a run in rounds, but another method is asked for", "give {run.method} rounds");
  require(!is_standard_stream(output.session), "output.session", "is standard output, which keeps nothing",
          "name a file");
  require(std::ranges::all_of(output.open_boundary, [](double marker) { return marker == std::floor(marker); }),
          "output.open-boundary", "has a marker that is no whole number", "markers of segments are whole numbers");
}

void check_scratch(const Request& request) {
  if (request.run.scratch.empty()) return;
  require(request.decomposition.subdomains != 1, "run.scratch", "is for subdomains, but one piece is asked for",
          "remove it or {decomposition.subdomains}");
  require(!request.limits.keep_incomplete, "run.scratch",
          "is for subdomains, but keeping an incomplete mesh takes one piece", "remove it or {limits.keep-incomplete}");
}

void check_cluster(const Request& request) {
  const Request::Cluster& c = request.cluster;
  require(c.groups.empty() || c.speed == 0, "cluster.speed",
          "cannot be combined with {cluster.groups}, which have their own speeds", "remove one of them");
  require(c.groups.empty() || c.ranks == 0 || c.ranks == ranks_of(cluster_of(request)), "cluster.ranks",
          "differs from the number of ranks in {cluster.groups}", "remove one of them");
  require(c.rank_speeds.empty() || (c.groups.empty() && c.ranks == 0 && c.speed == 0), "cluster.rank-speeds",
          "cannot be combined with {cluster.ranks}, {cluster.speed} or {cluster.groups}", "remove one of them");
  require(!c.groups.empty() || !c.rank_speeds.empty() || c.ranks > 0, "cluster.ranks", "is 0",
          "give the number of ranks, {cluster.groups}, or {cluster.rank-speeds}");
  try {
    static_cast<void>(schedules_of(cluster_of(request)));
  } catch (const Error& error) {
    throw KeyError("cluster.changes", KeyText::of("is wrong: {}", text_of(error)),
                   "list the changes of each rank in the order of time");
  }
  require(request.mapping.to_late_ranks || std::ranges::count(late_ranks_of(cluster_of(request)), false) > 0,
          "mapping.to-late-ranks", "is off, but no rank is there at the start",
          "let some begin at once, or turn it on");
}

}  // namespace

PlaceKind place_of(const Request& request, EntryPoint entry_point, bool launched) {
  if (entry_point == kExperiment) return request.cluster.kind == ClusterKind::kSimulated ? kSimulated : kRanks;
  if (launched) return kRanks;
  const Request::Decomposition& parts = request.decomposition;
  const bool cut = parts.subdomains > 1 || !parts.file.empty() || request.run.method == Method::kRounds;
  return cut ? kSubdomains : kOnePiece;
}

void check(const Request& request, PlaceKind place, const balancer::PolicyMaker& policies) {
  for (const Key& key : keys()) check_value(key, key.load(request));
  check_every(request.run.every != Request::Run{}.every, request.run);  // before the place: checkpoints change it
  check_places(request, place);
  check_input(request.input);
  static_cast<void>(names_of(request.input));
  check_crs(request.output.crs);
  check_rasters(request);
  check_sizes(request.bounds, request.sizing);
  check_step(request.sizing, request.output.depth);
  check_policy(request, policies);
  check_parts(request);
  check_rounds(request, place);
  check_checkpoint(request.run);
  check_method(request);
  check_pdr(request, place);
  check_scratch(request);
  check_output(request);
  if (place == kSimulated) {
    check_cluster(request);
    check_ranks(request, place, ranks_of(cluster_of(request)));
  }
}

void check_given(const Request& request, const std::set<std::string>& given) {
  const auto is_given = [&](const char* key) { return given.contains(key); };
  if (request.sizing.courant_step == 0) check_served_step(is_given);
  check_every(is_given("run.every"), request.run);
}

void check_alone(const Request& request) {
  const Request::Patience standard;
  const auto check_time = [&](double given, double usual, const char* key) {
    require(given == usual, key, "is about other ranks, but this process is alone",
            "start it with mpirun, or remove it");
  };
  check_time(request.patience.silence, standard.silence, "run.silence");
  check_time(request.patience.give_up, standard.give_up, "run.give-up");
}

void check_ranks(const Request& request, PlaceKind place, std::int32_t ranks) {
  const std::int32_t wanted = request.cluster.ranks;
  if (place != kSimulated && wanted > 0 && wanted != ranks)
    throw KeyError("cluster.ranks",
                   "is " + std::to_string(wanted) +
                       (ranks == 1 ? ", but this process is alone"
                                   : ", but mpirun has started " + std::to_string(ranks) + " processes"),
                   "start it with mpirun -n " + std::to_string(wanted) + ", or remove the key");
  const auto for_each_rank = [&](const std::vector<double>& values, const char* key) {
    if (!values.empty() && values.size() != static_cast<std::size_t>(ranks))
      throw KeyError(key,
                     "has " + std::to_string(values.size()) + (values.size() == 1 ? " value for " : " values for ") +
                         std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks"),
                     "give one for each rank");
  };
  for_each_rank(request.mapping.speeds, "mapping.speeds");
  for_each_rank(request.cluster.drag, "cluster.drag");
  require(request.lb_phases == 0 || static_cast<std::size_t>(ranks) <= kMaxVtNodes, "lb-statistics",
          "supports at most 32768 ranks, the limit of vt's files", "remove it, or use fewer ranks");
}

std::map<std::string, std::string> parameters_of_policy(const Request& request) {
  std::map<std::string, std::string> parameters;
  const std::vector<std::string> policies = balancer::policy_names();
  const std::string own = balancer::short_name(request.balance.policy);
  for (const auto& [setting, value] : request.balance.parameters) {
    const auto [named, name] = balancer::split_parameter(setting);
    const std::string& policy = named.empty() ? own : named;
    if (!balancer::is_policy_library(policy) && std::find(policies.begin(), policies.end(), policy) == policies.end())
      throw KeyError("balance.parameters", "names a policy '" + policy + "' that does not exist",
                     "the nearest one is '" + nearest_name(policy, policies) + "'");
    if (policy == own) parameters[name] = value;
  }
  return parameters;
}

IdVector<Rank, double> shares_of_time(const Request& request, std::int32_t ranks) {
  if (!request.cluster.drag.empty()) return IdVector<Rank, double>(request.cluster.drag);
  return IdVector<Rank, double>(to_index(ranks), 1.0);
}

ClusterSpec cluster_of(const Request& request) {
  const Request::Cluster& c = request.cluster;
  ClusterSpec cluster;
  cluster.groups = c.groups;
  for (const double speed : c.rank_speeds) cluster.groups.push_back({"", 1, speed});
  if (cluster.groups.empty()) cluster.groups = {{"all", c.ranks, c.speed}};
  cluster.changes = c.changes;
  cluster.drag = IdVector<Rank, double>(c.drag);
  cluster.scale = c.scale;
  cluster.latency = c.latency;
  cluster.bandwidth = c.bandwidth;
  cluster.ranks_per_host = c.ranks_per_host;
  cluster.memory = c.memory;
  cluster.message_overhead = c.message_overhead;
  return cluster;
}

}  // namespace driftmesh::job
