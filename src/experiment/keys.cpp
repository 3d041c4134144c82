#include "experiment/keys.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "balancer/policies/policy_factory.hpp"
#include "base/nearest_name.hpp"
#include "mesh/bounds.hpp"
#include "pslg/generators.hpp"

namespace driftmesh::experiment {
namespace {

using Kind = KeyInfo::Kind;

constexpr double kMaxRanks = 100'000;
constexpr std::size_t kMaxVtNodes = 32'768;  // vt's numbers of nodes have 16 bits, one of them for the sign

KeyInfo in(KeyInfo info, double least, double most) {
  info.least = least;
  info.most = most;
  return info;
}
KeyInfo from(KeyInfo info, double least) {
  info.least = least;
  return info;
}
KeyInfo above(KeyInfo info, double least) {
  info.least = least;
  info.above = true;
  return info;
}

template <class Value>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<Value, bool>)
    return Kind::kFlag;
  else if constexpr (std::is_integral_v<Value>)
    return Kind::kInteger;
  else if constexpr (std::is_floating_point_v<Value>)
    return Kind::kNumber;
  else if constexpr (std::is_same_v<Value, std::string>)
    return Kind::kText;
  else if constexpr (std::is_same_v<Value, std::vector<double>>)
    return Kind::kNumbers;
  else
    return Kind::kTable;
}

template <class Owner, class Value>
KeyInfo info_of(const char* name, Value Owner::*member, const char* help) {
  KeyInfo info;
  info.name = name;
  info.help = help;
  info.kind = kind_of<Value>();
  info.standard = Owner{}.*member;
  return info;
}

KeyInfo file(KeyInfo info) {
  info.kind = Kind::kFile;
  return info;
}
KeyInfo one_of(KeyInfo info, std::vector<std::string> choices) {
  info.kind = Kind::kChoice;
  info.choices = std::move(choices);
  return info;
}

/// A key whose value is a member of Experiment.
template <class Value, class... Adjust>
Key key(const char* name, Value Experiment::*member, const char* help, Adjust... adjust) {
  KeyInfo info = info_of(name, member, help);
  ((info = adjust(std::move(info))), ...);
  Key made;
  static_cast<KeyInfo&>(made) = std::move(info);
  made.store = [member](Experiment& e, const Json& value) { e.*member = value.get<Value>(); };
  made.load = [member](const Experiment& e) { return Json(e.*member); };
  return made;
}

auto in(double least, double most) {
  return [=](KeyInfo info) { return in(std::move(info), least, most); };
}
auto from(double least) {
  return [=](KeyInfo info) { return from(std::move(info), least); };
}
auto above(double least) {
  return [=](KeyInfo info) { return above(std::move(info), least); };
}
auto one_of(std::vector<std::string> choices) {
  return [=](KeyInfo info) { return one_of(std::move(info), choices); };
}
auto file() {
  return [](KeyInfo info) { return file(std::move(info)); };
}

Key groups_key() {
  Key made;
  made.name = "cluster.groups";
  made.help = "Ranks of different kinds, numbered in this order, in place of cluster.ranks and cluster.speed";
  made.kind = Kind::kList;
  made.standard = Json::array();
  made.fields = {
      info_of("name", &RankGroup::name, "What to call them"),
      in(info_of("ranks", &RankGroup::ranks, "How many"), 1, kMaxRanks),
      from(info_of("speed", &RankGroup::speed,
                   "Triangles a second that one refines; 0: 7.9 million, as the machine in docs/benchmarks.md"),
           0)};
  made.store = [](Experiment& e, const Json& value) {
    e.groups.clear();
    for (const Json& g : value) e.groups.push_back({g.at("name"), g.at("ranks"), g.at("speed")});
  };
  made.load = [](const Experiment& e) {
    Json list = Json::array();
    for (const RankGroup& g : e.groups) list.push_back({{"name", g.name}, {"ranks", g.ranks}, {"speed", g.speed}});
    return list;
  };
  return made;
}

std::vector<Key> make_keys() {
  using E = Experiment;
  return {
      key("name", &E::name, "What the results are called; by default as the file is"),

      key("input.file", &E::input_file, "The domain: Triangle's .poly, or .node", file()),
      key("input.generate", &E::generator, "The domain, made: pipe, bay, ... (see driftmesh generate --help)"),
      key("input.parameters", &E::generator_parameters, "Of what is generated: {resolution: 300, seed: 7}"),

      key("bounds.angle", &E::angle, "Smallest angle of the mesh, in degrees", in(0, kMaxAngle)),
      key("bounds.area", &E::area, "Largest area of a triangle; 0: no bound", from(0)),
      key("bounds.triangles", &E::triangles, "Instead of an area: the one that gives about so many triangles",
          in(0, 1e12)),
      key("bounds.triangles-per-rank", &E::triangles_per_rank, "The same, times the number of ranks", in(0, 1e10)),
      key("bounds.region-areas", &E::region_areas, "Whether the regions' own area bounds hold"),

      key("sizing.size", &E::size_expression, "Target edge length in x and y: \"0.1 + 0.05 * hypot(x, y)\""),
      key("sizing.background", &E::size_background, "Target edge lengths from a background mesh", file()),
      key("sizing.gradation", &E::size_gradation, "Largest growth of the background's lengths; 0: as they are",
          from(0)),
      key("sizing.min", &E::size_shortest, "Edge lengths are at least this", from(0)),
      key("sizing.max", &E::size_longest, "Edge lengths are at most this; 0: no limit", from(0)),

      key("decomposition.subdomains", &E::subdomains, "Subdomains; 0: as many as suit", in(0, 1e7)),
      key("decomposition.subdomains-per-rank", &E::subdomains_per_rank, "The same, times the number of ranks",
          in(0, 1e5)),
      key("decomposition.file", &E::decomposition_file, "A saved decomposition, instead of cutting", file()),
      key("decomposition.separator-angle", &E::separator_angle,
          "Smallest angle of separators with everything, in degrees", in(0, 80)),
      key("decomposition.skew", &E::skew, "0: equal work; up to 1: deliberately uneven subdomains", in(0, 1)),

      key("mapping.method", &E::mapping, "Who starts with which subdomain", one_of({"graph", "block", "round-robin"})),
      key("mapping.by-speed", &E::mapping_by_speed, "Whether the mapping knows the speeds of the ranks"),
      key("mapping.by-area", &E::mapping_by_area, "Whether it deals area in place of expected work"),

      key("cluster.kind", &E::cluster, "Ranks in virtual time, or those that mpirun starts",
          one_of({"simulated", "real"})),
      key("cluster.ranks", &E::ranks, "Ranks; 0: those of cluster.groups, or of mpirun", in(0, kMaxRanks)),
      key("cluster.speed", &E::speed,
          "Triangles a second that each refines; 0: 7.9 million, as the machine in docs/benchmarks.md", from(0)),
      groups_key(),
      key("cluster.drag", &E::drag,
          "Share of its speed that is left to each rank, real or simulated: [1, 0.5]; empty: all of it", in(0.01, 1)),
      key("cluster.latency", &E::latency, "Seconds from the end of sending to arrival", from(0)),
      key("cluster.bandwidth", &E::bandwidth, "Bytes a second that leave a rank", above(0)),
      key("cluster.message-overhead", &E::message_overhead, "Seconds of a rank for each message it sends or receives",
          from(0)),

      key("run.presplit", &E::presplit, "Whether interfaces are cut to size before refinement",
          one_of({"auto", "on", "off"})),
      key("run.aggregation", &E::aggregation, "Split points that travel together at most", in(1, 1e6)),
      key("run.order", &E::order, "Which subdomain a rank refines next", one_of({"given", "largest", "backlog"})),
      key("run.slice", &E::slice, "Points inserted between two looks at the network", in(1, 1e9)),

      key("balance.policy", &E::policy, "Who decides what moves (docs/balancing.md)", one_of(balancer::policy_names())),
      key("balance.parameters", &E::policy_parameters,
          "Of the policy: {method: graph}; of one that is swept over: {zoltan.method: graph}"),
      key("balance.look", &E::balance_look, "Seconds between two looks of a rank at its own load", above(0)),
      key("balance.gap", &E::balance_gap, "Seconds between two reports of a rank, and between two plans, at least",
          from(0)),
      key("balance.interval", &E::balance_interval, "Seconds between two reports of a rank with work, at most",
          above(0)),
      key("balance.gain", &E::balance_gain, "Share of the finishing time that moving must save", in(0, 1)),

      key("seed", &E::seed, "Of what is random: the skew; each repetition adds one", from(0)),
      key("repetitions", &E::repetitions, "How often each run is made", in(1, 1000)),
      key("pictures", &E::pictures, "Whether runs are drawn"),
      key("lb-statistics", &E::lb_phases,
          "Phases into which the statistics of runs for DARMA vt's tools are divided; 0: there are none",
          in(0, 10'000)),
  };
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

KeyPath find_key(const std::string& name) {
  for (const Key& k : keys()) {
    if (k.name == name) return {&k, ""};
    if (k.kind == Kind::kTable && name.starts_with(k.name + ".")) return {&k, name.substr(k.name.size() + 1)};
  }
  return {};
}

std::string nearest_key(const std::string& name) {
  std::vector<std::string> names;
  for (const Key& k : keys()) {
    names.push_back(k.name);
    if (const std::size_t dot = k.name.find('.'); dot != std::string::npos) names.push_back(k.name.substr(0, dot));
  }
  return nearest_name(name, names);
}

void store(Experiment& experiment, const KeyPath& path, const Json& value) {
  if (path.entry.empty()) return path.key->store(experiment, value);
  Json table = path.key->load(experiment);
  table[path.entry] = value;
  path.key->store(experiment, table);
}

std::map<std::string, std::string> parameters_of_policy(const Experiment& e) {
  std::map<std::string, std::string> parameters;
  const std::vector<std::string> policies = balancer::policy_names();
  for (const auto& [name, value] : e.policy_parameters) {
    const std::size_t dot = name.find('.');
    const std::string policy = dot == std::string::npos ? e.policy : name.substr(0, dot);
    if (std::find(policies.begin(), policies.end(), policy) == policies.end())
      throw KeyError("balance.parameters", "there is no policy '" + policy + "'",
                     "the nearest one is '" + nearest_name(policy, policies) + "'");
    if (policy == e.policy) parameters[dot == std::string::npos ? name : name.substr(dot + 1)] = value;
  }
  return parameters;
}

void check(const Experiment& e) {
  const auto require = [](bool holds, const char* key, const char* what, const char* next) {
    if (!holds) throw KeyError(key, what, next);
  };
  require(!e.input_file.empty() || !e.generator.empty(), "input.file", "no domain is given",
          "name a file with input.file, or what to generate with input.generate");
  try {
    static_cast<void>(balancer::make_policy(e.policy, parameters_of_policy(e)));
  } catch (const KeyError&) {
    throw;
  } catch (const Error& error) {
    throw KeyError("balance.parameters", error.what(), "see docs/balancing.md");
  }
  require(e.input_file.empty() || e.generator.empty(), "input.generate", "two domains are given",
          "remove input.file or input.generate");
  require(!e.generator.empty() || e.generator_parameters.empty(), "input.parameters", "nothing is generated",
          "say what with input.generate");
  if (!e.generator.empty()) {
    try {
      static_cast<void>(generate(e.generator, e.generator_parameters));
    } catch (const Error& error) {
      throw KeyError("input.generate", error.what(), "see driftmesh generate --help");
    }
  }
  require((e.area > 0) + (e.triangles > 0) + (e.triangles_per_rank > 0) <= 1, "bounds.triangles",
          "the size of triangles is asked for twice", "keep one of area, triangles and triangles-per-rank");
  require(e.size_expression.empty() || (e.triangles == 0 && e.triangles_per_rank == 0), "sizing.size",
          "a number of triangles and a size field are asked for", "remove one, or give bounds.area");
  require(e.subdomains == 0 || e.subdomains_per_rank == 0, "decomposition.subdomains-per-rank",
          "the number of subdomains is given twice", "remove one");
  require(e.decomposition_file.empty() || (e.subdomains == 0 && e.subdomains_per_rank == 0), "decomposition.file",
          "a decomposition is given, and how to make one", "remove one");
  require(e.groups.empty() || e.speed == 0, "cluster.speed", "each of cluster.groups has its own speed", "remove one");
  require(e.groups.empty() || e.ranks == 0 || e.ranks == ranks_of(cluster_of(e)), "cluster.ranks",
          "cluster.groups has another number of ranks", "remove one");
  require(e.cluster == "real" || !e.groups.empty() || e.ranks > 0, "cluster.ranks", "a cluster without ranks",
          "give their number, or cluster.groups");
  require(e.cluster == "simulated" || e.groups.empty(), "cluster.groups", "a real cluster has the speeds that it has",
          "remove it, or simulate");
  require(e.cluster == "simulated" || e.speed == 0, "cluster.speed", "a real cluster has the speed that it has",
          "remove it, or simulate");
  const auto ranks = static_cast<std::size_t>(ranks_of(cluster_of(e)));
  require(e.drag.empty() || ranks == 0 || e.drag.size() == ranks, "cluster.drag",
          "it is not for as many ranks as there are", "give one share for each rank");
  require(e.lb_phases == 0 || ranks <= kMaxVtNodes, "lb-statistics", "vt's files know no more than 32768 ranks",
          "remove it, or take fewer ranks");
}

void check_processes(const Experiment& e, std::int32_t processes) {
  const auto started = "mpirun has started " + std::to_string(processes) + (processes == 1 ? " process" : " processes");
  if (e.cluster == "simulated") {
    if (processes > 1)
      throw KeyError("cluster.kind", "a simulated cluster is one process, and " + started,
                     "start it without mpirun, or write kind: real");
    return;
  }
  if (e.ranks > 0 && e.ranks != processes)
    throw KeyError("cluster.ranks",
                   processes == 1 ? "this process is alone, not one of " + std::to_string(e.ranks)
                                  : started + ", not " + std::to_string(e.ranks),
                   "start it with mpirun -n " + std::to_string(e.ranks) + ", or remove the key");
  if (!e.drag.empty() && e.drag.size() != static_cast<std::size_t>(processes))
    throw KeyError("cluster.drag",
                   "it is for " + std::to_string(e.drag.size()) + " ranks, and there are " + std::to_string(processes),
                   "start it with mpirun -n " + std::to_string(e.drag.size()));
}

ClusterSpec cluster_of(const Experiment& e) {
  ClusterSpec cluster;
  cluster.groups = e.groups;
  if (cluster.groups.empty()) cluster.groups = {{"all", e.ranks, e.speed}};
  cluster.drag = e.drag;
  cluster.latency = e.latency;
  cluster.bandwidth = e.bandwidth;
  cluster.message_overhead = e.message_overhead;
  return cluster;
}

}  // namespace driftmesh::experiment
