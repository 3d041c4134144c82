#include "job/keys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "balancer/policy_list.hpp"
#include "base/nearest_name.hpp"
#include "decompose/decompose.hpp"
#include "mesh/bounds.hpp"
#include "pslg/generators.hpp"

namespace driftmesh::job {
namespace {

using Kind = KeyInfo::Kind;
using R = Request;

constexpr double kMaxRanks = 100'000;
constexpr Places kAsSection = 0;  // of a key that applies where its section does; likewise for doors

// ---- The value of a member -------------------------------------------------------------------------------------

template <class Member>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<Member, bool>)
    return Kind::kFlag;
  else if constexpr (std::is_integral_v<Member>)
    return Kind::kInteger;
  else if constexpr (std::is_floating_point_v<Member>)
    return Kind::kNumber;
  else if constexpr (std::is_same_v<Member, std::string>)
    return Kind::kText;
  else if constexpr (std::is_same_v<Member, std::vector<double>>)
    return Kind::kNumbers;
  else if constexpr (std::is_same_v<Member, std::vector<std::string>>)
    return Kind::kOutputs;
  else
    return Kind::kTable;
}

template <class Member>
Value value_of(const Member& member) {
  if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>)
    return static_cast<std::int64_t>(member);
  else
    return member;
}

template <class Member>
Member member_of(const Value& value) {
  if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>)
    return static_cast<Member>(value.as<std::int64_t>());
  else
    return value.as<Member>();
}

// ---- What else a declaration says ------------------------------------------------------------------------------

auto in(double least, double most) {
  return [=](KeyInfo& key) { key.least = least, key.most = most; };
}
auto from(double least) {
  return [=](KeyInfo& key) { key.least = least; };
}
auto above(double least) {
  return [=](KeyInfo& key) { key.least = least, key.above = true; };
}
auto because(const char* why_not_more) {
  return [=](KeyInfo& key) { key.why_not_more = why_not_more; };
}
auto unit(const char* name) {
  return [=](KeyInfo& key) { key.unit = name; };
}
auto file() {
  return [](KeyInfo& key) { key.kind = Kind::kFile; };
}
auto output_file() {
  return [](KeyInfo& key) { key.kind = Kind::kOutput; };
}
auto one_of(std::vector<std::string> choices) {
  return [choices = std::move(choices)](KeyInfo& key) {
    key.kind = Kind::kChoice;
    key.choices = choices;
  };
}
auto option(const char* name, const char* value_name = "") {
  return [=](KeyInfo& key) { key.option = name, key.value_name = value_name; };
}
auto option(char letter, const char* name, const char* value_name) {
  return [=](KeyInfo& key) { key.letter = letter, key.option = name, key.value_name = value_name; };
}
auto option_help(const char* text) {
  return [=](KeyInfo& key) { key.option_help = text; };
}
auto places(Places where) {
  return [=](KeyInfo& key) { key.places = where; };
}
auto doors(Doors which) {
  return [=](KeyInfo& key) { key.doors = which; };
}

template <class Owner, class Member, class... Rest>
void describe(KeyInfo& info, const char* name, Member Owner::*member, const char* help, const Rest&... rest) {
  info.name = name;
  info.help = help;
  info.kind = kind_of<Member>();
  info.standard = value_of(Owner{}.*member);
  info.places = kAsSection;
  info.doors = kAsSection;
  (rest(info), ...);
}

/// A key whose value is a member of one of the request's sections.
template <class Section, class Member, class... Rest>
Key key(const char* name, Section R::*section, Member Section::*member, const char* help, const Rest&... rest) {
  Key made;
  describe(made, name, member, help, rest...);
  made.store = [=](R& r, const Value& value) { r.*section.*member = member_of<Member>(value); };
  made.load = [=](const R& r) { return value_of(r.*section.*member); };
  return made;
}

/// A key whose value is a member of the request itself.
template <class Member, class... Rest>
Key key(const char* name, Member R::*member, const char* help, const Rest&... rest) {
  Key made;
  describe(made, name, member, help, rest...);
  made.store = [=](R& r, const Value& value) { r.*member = member_of<Member>(value); };
  made.load = [=](const R& r) { return value_of(r.*member); };
  return made;
}

template <class Enum>
using Names = std::vector<std::pair<Enum, const char*>>;

/// A key whose value is one of an enumeration, by these names.
template <class Section, class Enum, class... Rest>
Key choice(const char* name, Section R::*section, Enum Section::*member, const Names<Enum>& names, const char* help,
           const Rest&... rest) {
  const auto name_of = [=](Enum value) {
    return std::string(
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.first == value; })->second);
  };
  Key made;
  made.name = name;
  made.help = help;
  made.kind = Kind::kChoice;
  made.standard = name_of(Section{}.*member);
  made.places = kAsSection;
  made.doors = kAsSection;
  for (const auto& [value, word] : names) made.choices.emplace_back(word);
  (rest(made), ...);
  made.store = [=](R& r, const Value& value) {
    r.*section.*member = std::find_if(names.begin(), names.end(), [&](const auto& n) {
                           return n.second == value.as<std::string>();
                         })->first;
  };
  made.load = [=](const R& r) { return Value(name_of(r.*section.*member)); };
  return made;
}

Key groups_key() {
  Key made;
  made.name = "cluster.groups";
  made.help = "Ranks of different kinds, numbered in this order, in place of cluster.ranks and cluster.speed";
  made.kind = Kind::kList;
  made.standard = std::vector<Record>();
  made.places = kSimulated;
  made.doors = kAsSection;
  made.fields.resize(3);
  describe(made.fields[0], "name", &RankGroup::name, "What to call them");
  describe(made.fields[1], "ranks", &RankGroup::ranks, "How many", in(1, kMaxRanks));
  describe(made.fields[2], "speed", &RankGroup::speed, "Triangles per second that each refines; 0: 7.9 million",
           unit("triangles/s"), from(0));
  made.store = [](R& r, const Value& value) {
    r.cluster.groups.clear();
    for (const Record& g : value.as<std::vector<Record>>())
      r.cluster.groups.push_back(
          {member_of<std::string>(g[0].second), member_of<std::int32_t>(g[1].second), member_of<double>(g[2].second)});
  };
  made.load = [](const R& r) {
    std::vector<Record> list;
    for (const RankGroup& g : r.cluster.groups)
      list.push_back({{"name", value_of(g.name)}, {"ranks", value_of(g.ranks)}, {"speed", value_of(g.speed)}});
    return Value(list);
  };
  return made;
}

// ---- The declarations ------------------------------------------------------------------------------------------

/// Keys that stand under one heading of help, and where and by whom they are said unless they say otherwise.
struct Section {
  const char* group;
  Places places;
  Doors doors;
  std::vector<Key> keys;
};

Section input_section() {
  return {"Input",
          kAnywhere,
          kMesh | kExperiment,
          {key("input.file", &R::input, &R::Input::file, "The domain: Triangle's .poly (its .node beside it), or .node",
               file(), option("input"), doors(kMesh | kDecompose | kExperiment)),
           key("input.generate", &R::input, &R::Input::generator,
               "In place of a file: the domain is generated (see driftmesh generate --help)",
               option("generate", "KIND"), one_of(generator_names())),
           key("input.parameters", &R::input, &R::Input::parameters,
               "A parameter of what is generated, as in resolution=300", option("generate-with", "NAME=VALUE"))}};
}

Section triangle_section() {
  constexpr Doors kAll = kMeshers | kDecompose | kCheck;
  return {
      "Triangles (lengths and areas in the units of the input)",
      kAnywhere,
      kAll,
      {key("bounds.angle", &R::bounds, &R::Bounds::angle,
           "Smallest angle, except where small angles of the input force smaller ones. Refinement is proven to "
           "terminate up to 25.6; in practice it does up to about 33",
           unit("degrees"), in(0, kMaxAngle), because("above that refinement need not terminate"),
           option('q', "angle", "DEGREES"), doors(kMeshers)),
       key("bounds.area", &R::bounds, &R::Bounds::area, "Largest area of a triangle; 0: no bound", from(0),
           option('a', "area", "AREA")),
       key("bounds.triangles", &R::bounds, &R::Bounds::triangles,
           "In place of an area: the one that gives about this many triangles", in(0, 1e12), option("triangles", "N"),
           doors(kMeshers | kDecompose)),
       key("bounds.triangles-per-rank", &R::bounds, &R::Bounds::triangles_per_rank,
           "The same, times the number of ranks", in(0, 1e10), option("triangles-per-rank", "N"), places(kMany),
           doors(kMesh | kExperiment)),
       key("bounds.region-areas", &R::bounds, &R::Bounds::region_areas,
           "Whether the area bounds of the input's regions hold", option("no-region-areas"),
           option_help("Ignore the area bounds of the input's regions")),
       key("sizing.size", &R::sizing, &R::Sizing::expression,
           "Target edge length in x and y: \"0.1 + 0.02*sqrt(x^2 + y^2)\"", option("size", "EXPR"),
           doors(kAll & ~kLibrary)),
       key("sizing.background", &R::sizing, &R::Sizing::background,
           "Target edge lengths from a background mesh: FILE.node with FILE.ele, the length as the first attribute "
           "of each point, or FILE.area with an area bound for each triangle",
           file(), option("size-mesh", "FILE"), doors(kAll & ~kLibrary)),
       key("sizing.gradation", &R::sizing, &R::Sizing::gradation,
           "Largest growth of the background mesh's lengths per unit of distance; 0.2 to 0.3 grade well; 0: as they "
           "are",
           from(0), option("gradation", "G"), doors(kAll & ~kLibrary)),
       key("sizing.min", &R::sizing, &R::Sizing::shortest, "Target edge lengths are at least this", from(0),
           option("size-min", "LENGTH"), doors(kAll & ~kLibrary)),
       key("sizing.max", &R::sizing, &R::Sizing::longest, "Target edge lengths are at most this; 0: no limit", from(0),
           option("size-max", "LENGTH"), doors(kAll & ~kLibrary))}};
}

Section limit_section() {
  return {"Limits",
          kAnywhere,
          kMeshers,
          {key("limits.max-triangles", &R::limits, &R::Limits::max_triangles,
               "Stop at this many triangles, or at once if more are to be expected",
               in(1, static_cast<double>(MeshRequest{}.max_triangles)), option("max-triangles", "N")),
           key("limits.max-memory", &R::limits, &R::Limits::max_memory,
               "The same for the memory of each process: 6G is 6 GiB; 0: 90 % of what the machine has free",
               unit("bytes"), in(0, 1e18), option("max-memory", "SIZE")),
           key("limits.keep-incomplete", &R::limits, &R::Limits::keep_incomplete,
               "Write what there is when a limit stops the work", option("keep-incomplete"), places(kOnePiece),
               doors(kMesh | kExperiment))}};
}

Section parts_section() {
  const Names<MappingMethod> mappings = {
      {MappingMethod::kGraph, "graph"}, {MappingMethod::kBlock, "block"}, {MappingMethod::kRoundRobin, "round-robin"}};
  const Names<Presplit> presplits = {{Presplit::kAuto, "auto"}, {Presplit::kOn, "on"}, {Presplit::kOff, "off"}};
  const Names<WorkOrder> orders = {
      {WorkOrder::kGiven, "given"}, {WorkOrder::kLargest, "largest"}, {WorkOrder::kBacklog, "backlog"}};
  return {
      "Subdomains and ranks",
      kCut,
      kMeshers,
      {key("decomposition.subdomains", &R::decomposition, &R::Decomposition::subdomains,
           "Number of subdomains, far more than ranks; works without mpirun too; 0: 20 a rank, or what keeps a "
           "subdomain in cache",
           in(0, kMaxSubdomains), option('n', "subdomains", "N"), doors(kMeshers | kDecompose)),
       key("decomposition.subdomains-per-rank", &R::decomposition, &R::Decomposition::subdomains_per_rank,
           "The same, times the number of ranks", in(0, 1e5), option("subdomains-per-rank", "N"), places(kMany),
           doors(kMesh | kExperiment)),
       key("decomposition.file", &R::decomposition, &R::Decomposition::file,
           "A decomposition made by driftmesh decompose, in place of cutting", file(), option("decomposition", "FILE"),
           doors(kMesh | kExperiment)),
       key("decomposition.separator-angle", &R::decomposition, &R::Decomposition::separator_angle,
           "Smallest angle between separators and everything they meet, where the domain allows it", unit("degrees"),
           in(0, kMaxSeparatorAngle), option("separator-angle", "DEGREES"), doors(kMeshers | kDecompose)),
       key("decomposition.skew", &R::decomposition, &R::Decomposition::skew,
           "0: equal work. Above: deliberately uneven subdomains, for experiments; each cut gives one side up to "
           "1 + S times its due",
           in(0, kMaxSkew), option("split-skew", "S"), doors(kMeshers | kDecompose)),
       key("seed", &R::seed, "Seed of the unevenness; each repetition of an experiment adds one", from(0),
           option("seed", "N"), doors(kMeshers | kDecompose)),
       choice(
           "mapping.method", &R::mapping, &R::Mapping::method, mappings,
           "How subdomains are dealt to ranks at the start: graph (equal work, short interfaces), block or round-robin",
           option("mapping", "HOW"), places(kMany)),
       key("mapping.speeds", &R::mapping, &R::Mapping::speeds,
           "Relative speed of each rank, where known: work is dealt in proportion", above(0),
           option("speeds", "S,S,..."), places(kMany)),
       key("mapping.by-speed", &R::mapping, &R::Mapping::by_speed,
           "Deal work in proportion to the speeds of the cluster", option("map-by-speed"), places(kMany),
           doors(kMesh | kExperiment)),
       key("mapping.by-area", &R::mapping, &R::Mapping::by_area,
           "Deal area in place of expected work: an uneven start, for experiments", option("map-by-area"),
           places(kMany)),
       choice("run.presplit", &R::run, &R::Run::presplit, presplits,
              "Cut interfaces to size before refinement: on, off (the protocol in full), or auto, which is wherever a "
              "bound on "
              "area or size says what size",
              option("presplit", "MODE")),
       key("run.aggregation", &R::run, &R::Run::aggregation, "Most split points that travel in one message", in(1, 1e6),
           option("aggregation", "K"), places(kMany)),
       choice("run.order", &R::run, &R::Run::order, orders,
              "Which subdomain a rank refines next: given (neighbors together), largest or backlog",
              option("order", "ORDER")),
       key("run.slice", &R::run, &R::Run::slice, "Points inserted between two looks at the network", in(1, 1e9),
           option("slice", "N")),
       key("run.sleep", &R::run, &R::Run::sleep,
           "Keep finished subdomains in about 10 bytes a triangle in place of 40 until a neighbor needs them again",
           option("sleep"))}};
}

Section balance_section() {
  return {
      "Balancing: subdomains move between ranks while they are refined",
      kMany,
      kMeshers,
      {key("balance.policy", &R::balance, &R::Balance::policy, "Who decides what moves (docs/balancing.md)",
           one_of(balancer::policy_names()), option("balance", "POLICY")),
       key("balance.parameters", &R::balance, &R::Balance::parameters,
           "A parameter of the policy, as in method=graph; in a sweep over policies, that of one: zoltan.method=graph",
           option("balance-with", "NAME=VALUE")),
       key("balance.look", &R::balance, &R::Balance::look, "Time between two looks of a rank at its own load",
           unit("seconds"), above(0), option("balance-look", "SECONDS")),
       key("balance.gap", &R::balance, &R::Balance::gap,
           "Shortest time between two reports of a rank, and between two plans", unit("seconds"), from(0),
           option("balance-gap", "SECONDS")),
       key("balance.interval", &R::balance, &R::Balance::interval,
           "Longest time between two reports of a rank that has work", unit("seconds"), above(0),
           option("balance-interval", "SECONDS")),
       key("balance.gain", &R::balance, &R::Balance::gain, "Share of the finishing time that moving must save",
           in(0, 1), option("balance-gain", "SHARE"))}};
}

Section cluster_section() {
  const Names<ClusterKind> kinds = {{ClusterKind::kSimulated, "simulated"}, {ClusterKind::kReal, "real"}};
  return {
      "Clusters",
      kSimulated,
      kExperiment,
      {choice("cluster.kind", &R::cluster, &R::Cluster::kind, kinds,
              "Ranks in virtual time, or those that mpirun starts", places(kMany)),
       key("cluster.ranks", &R::cluster, &R::Cluster::ranks,
           "Number of ranks; 0: those of cluster.groups, or of mpirun", in(0, kMaxRanks), places(kMany)),
       key("cluster.speed", &R::cluster, &R::Cluster::speed,
           "Triangles per second that each refines; 0: 7.9 million, as the machine in docs/benchmarks.md",
           unit("triangles/s"), from(0)),
       groups_key(),
       key("cluster.drag", &R::cluster, &R::Cluster::drag,
           "Share of its speed that is left to each rank, real or simulated, as in 1,0.5; empty: all of it",
           in(0.01, 1), option("drag", "F,F,..."), places(kMany), doors(kMesh | kExperiment)),
       key("cluster.latency", &R::cluster, &R::Cluster::latency,
           "Time from the end of sending to arrival, on simulated clusters", unit("seconds"), from(0), places(kMany)),
       key("cluster.bandwidth", &R::cluster, &R::Cluster::bandwidth,
           "Bytes per second that leave a rank, on simulated clusters", above(0), places(kMany)),
       key("cluster.message-overhead", &R::cluster, &R::Cluster::message_overhead,
           "Time of a rank for each message it sends or receives, on simulated clusters", unit("seconds"), from(0),
           places(kMany))}};
}

Section output_section() {
  return {
      "Output",
      kAnywhere,
      kMesh,
      {key("output.meshes", &R::output, &R::Output::meshes,
           "Mesh file, by extension: .vtu (ParaView), .pvtu (the same in pieces, one per rank), .msh (Gmsh 4.1), or "
           ".node, .ele, .poly, .edge, .neigh (each writes Triangle's whole set); - is standard output",
           option('o', "output", "FILE")),
       key("output.picture", &R::output, &R::Output::picture,
           "Picture of the mesh: .png, .svg or .pdf (more: driftmesh plot --help)", output_file(),
           option("plot", "FILE")),
       key("output.record", &R::output, &R::Output::record, "Write everything in the summary as JSON too",
           output_file(), option("json", "FILE")),
       key("output.quiet", &R::output, &R::Output::quiet, "Print nothing but errors", option("quiet"))}};
}

Section experiment_section() {
  return {
      "Experiments",
      kMany,
      kExperiment,
      {key("name", &R::name, "What the results are called; by default the name of the file"),
       key("repetitions", &R::repetitions, "How often each run is made", in(1, 1000)),
       key("pictures", &R::pictures, "Draw each run"),
       key("lb-statistics", &R::lb_phases,
           "Number of phases in the load balancing statistics written for DARMA vt's tools; 0: none", in(0, 10'000))}};
}

std::vector<Key> all_keys() {
  std::vector<Key> keys;
  for (Section& section : std::vector{input_section(), triangle_section(), limit_section(), parts_section(),
                                      balance_section(), cluster_section(), output_section(), experiment_section()})
    for (Key& k : section.keys) {
      k.group = section.group;
      if (k.places == kAsSection) k.places = section.places;
      if (k.doors == kAsSection) k.doors = section.doors;
      keys.push_back(std::move(k));
    }
  return keys;
}

// ---- Values from text ------------------------------------------------------------------------------------------

[[noreturn]] void fail(const KeyInfo& key, const std::string& what, const std::string& next) {
  throw KeyError(key.name, what, next);
}

double number(const KeyInfo& key, const std::string& text) {
  double value = 0;
  if (!read_number(text, key.unit == "bytes", value))
    fail(key, "is '" + text + "'", "give a number, as in 20, 1.5e3 or 5k");
  check_range(key, value);
  return value;
}

std::int64_t integer(const KeyInfo& key, const std::string& text) {
  const double value = number(key, text);
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double whole = key.unit == "bytes" ? std::floor(value) : value;
  if (whole != std::floor(whole) || std::fabs(whole) > kExact * (key.unit == "bytes" ? 1024 : 1))
    fail(key, "is " + text, "give a whole number");
  return static_cast<std::int64_t>(whole);
}

}  // namespace

const std::vector<Key>& keys() {
  static const std::vector<Key> all = all_keys();
  return all;
}

KeyPath find_key(const std::string& name) {
  for (const Key& k : keys()) {
    if (k.name == name) return {&k, "", false};
    if (k.kind == Kind::kTable && name.starts_with(k.name + ".")) return {&k, name.substr(k.name.size() + 1), false};
  }
  return {};
}

KeyPath find_option(const std::string& option) {
  for (const Key& k : keys())
    if (!option.empty() && k.option == option) return {&k, "", option.starts_with("no-")};
  return {};
}

std::string nearest_key(const std::string& name, Doors door) {
  std::vector<std::string> names;
  for (const Key& k : keys()) {
    if ((k.doors & door) == 0) continue;
    names.push_back(k.name);
    if (const std::size_t dot = k.name.find('.'); dot != std::string::npos) names.push_back(k.name.substr(0, dot));
    if (!k.option.empty()) names.push_back(k.option);
  }
  return nearest_name(name, names);
}

void check_range(const KeyInfo& key, double value) {
  if (std::isnan(value)) fail(key, "is not a number", "give one");
  if (value < key.least || (key.above && value == key.least))
    fail(key, "is " + shortest_text(value),
         (key.above ? "it must be above " : "it must be at least ") + shortest_text(key.least));
  if (value > key.most)
    fail(key, "is " + shortest_text(value),
         "it can be at most " + shortest_text(key.most) + (key.why_not_more.empty() ? "" : ": " + key.why_not_more));
}

Value read_value(const KeyInfo& key, const std::string& text) {
  switch (key.kind) {
    case Kind::kText:
    case Kind::kFile:
    case Kind::kOutput:
      return text;
    case Kind::kFlag:
      if (text != "true" && text != "false") fail(key, "is '" + text + "'", "it is either true or false");
      return text == "true";
    case Kind::kInteger:
      return integer(key, text);
    case Kind::kNumber:
    case Kind::kNumbers:
      return number(key, text);
    case Kind::kChoice:
      if (key.standard != Value(text) && std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end())
        fail(key, "is '" + text + "'", "the nearest that it can be is '" + nearest_name(text, key.choices) + "'");
      return text;
    case Kind::kOutputs:
    case Kind::kTable:
    case Kind::kList:
      break;
  }
  throw Error(key.name + ": has no single value");
}

void store(Request& request, const KeyPath& path, const Value& value) {
  if (path.entry.empty()) return path.key->store(request, path.negated ? Value(!value.as<bool>()) : value);
  auto table = path.key->load(request).as<std::map<std::string, std::string>>();
  table[path.entry] = value.as<std::string>();
  path.key->store(request, table);
}

}  // namespace driftmesh::job
