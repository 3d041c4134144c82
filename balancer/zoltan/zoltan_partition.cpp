#include "balancer/zoltan/zoltan_partition.hpp"

#include <dlfcn.h>
#include <mpi.h>
#include <zoltan.h>
#include <zoltan_dd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "balancer/snapshot/effort.hpp"
#include "base/letter_case.hpp"
#include "base/narrow.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::balancer {
namespace {

using Ids = ZOLTAN_ID_PTR;

// Zoltan initializes MPI if necessary; whoever initializes it also finalizes it.
void initialize_once() {
  static const bool done = [] {
    int mpi_was_there = 0;
    MPI_Initialized(&mpi_was_there);
    float version = 0;
    if (Zoltan_Initialize(0, nullptr, &version) != ZOLTAN_OK) throw Error("Zoltan cannot be initialized");
    if (!mpi_was_there) std::atexit([] { MPI_Finalize(); });
    return true;
  }();
  static_cast<void>(done);
}

// If Zoltan uses SCOTCH: its threads and its random numbers, which go on from call to call, would make other parts each
// time.
void make_scotch_repeat() {
  static const auto reset = [] {
    ::setenv("SCOTCH_PTHREAD_NUMBER", "1", 0);
    return reinterpret_cast<void (*)()>(::dlsym(RTLD_DEFAULT, "SCOTCH_randomReset"));
  }();
  if (reset) reset();
}

/// Owns a Zoltan object; freeing one after MPI_Finalize would abort.
class Zoltan {
 public:
  explicit Zoltan(MPI_Comm communicator) {
    zoltan_ = Zoltan_Create(communicator);
    if (!zoltan_) throw Error("Zoltan cannot be created: no memory");
    static_cast<void>(set("DEBUG_LEVEL", "0"));
  }
  ~Zoltan() { Zoltan_Destroy(&zoltan_); }
  Zoltan(const Zoltan&) = delete;
  Zoltan& operator=(const Zoltan&) = delete;

  [[nodiscard]] bool set(const std::string& name, const std::string& value) {
    return Zoltan_Set_Param(zoltan_, name.c_str(), value.c_str()) == ZOLTAN_OK;
  }
  [[nodiscard]] Zoltan_Struct* get() const { return zoltan_; }

 private:
  Zoltan_Struct* zoltan_ = nullptr;
};

/// A distributed directory of the processes that have each subdomain. All calls are collective.
class Whereabouts {
 public:
  explicit Whereabouts(MPI_Comm communicator) {
    if (Zoltan_DD_Create(&directory_, communicator, 1, 0, 0, 0, 0) != ZOLTAN_OK)
      throw Error("Zoltan's directory cannot be created: no memory");
  }
  ~Whereabouts() { Zoltan_DD_Destroy(&directory_); }
  Whereabouts(const Whereabouts&) = delete;
  Whereabouts& operator=(const Whereabouts&) = delete;

  /// This process has these.
  void enter(std::vector<ZOLTAN_ID_TYPE> ids) {
    const int result =
        Zoltan_DD_Update(directory_, ids.data(), nullptr, nullptr, nullptr, static_cast<int>(ids.size()));
    if (result != ZOLTAN_OK) throw Error("Zoltan's directory rejected subdomains");
  }
  /// The process of each subdomain, or -1 if none has it: Zoltan warns of those.
  [[nodiscard]] std::vector<int> find(std::vector<ZOLTAN_ID_TYPE> ids) {
    std::vector<int> processes(ids.size(), -1);
    const int result = Zoltan_DD_Find(directory_, ids.data(), nullptr, nullptr, nullptr, static_cast<int>(ids.size()),
                                      processes.data());
    if (result != ZOLTAN_OK && result != ZOLTAN_WARN) throw Error("Zoltan's directory does not answer");
    return processes;
  }

 private:
  Zoltan_DD_Struct* directory_ = nullptr;
};

/// The input for Zoltan: the listed subdomains as vertices of a graph, with edges to all listed neighbors, here or on
/// another process.
struct Graph {
  const LoadSnapshot* snapshot;
  IdVector<ZOLTAN_ID_TYPE, int> first{0};  // edges of vertex i: first[i] up to first[i + 1]
  IdVector<int, ZOLTAN_ID_TYPE> target;
  IdVector<int, int> process;  // the owner of `target`
  IdVector<int, float> weight;

  explicit Graph(const LoadSnapshot& s) : snapshot(&s) {}

  /// `process_of(neighbors)`: which process lists each of them, or -1.
  template <class ProcessOf>
  void add_edges(const ProcessOf& process_of) {
    std::vector<ZOLTAN_ID_TYPE> neighbors;
    for (const SubdomainLoad& s : snapshot->subdomains)
      for (const Neighbor& n : (*snapshot->layout)[s.id].neighbors)
        neighbors.push_back(static_cast<ZOLTAN_ID_TYPE>(n.subdomain));
    const std::vector<int> processes = process_of(neighbors);
    const double mean = mean_border();
    std::size_t at = 0;
    for (const SubdomainLoad& s : snapshot->subdomains) {
      for (const Neighbor& n : (*snapshot->layout)[s.id].neighbors) {
        const int where = processes[at++];
        if (where < 0 || is_settled(s, n)) continue;
        target.push_back(static_cast<ZOLTAN_ID_TYPE>(n.subdomain));
        process.push_back(where);
        weight.push_back(static_cast<float>(n.length / mean));
      }
      first.push_back(narrow<int>(target.size(), "borders between subdomains"));
    }
  }
  /// Whether the points on a border are known on both sides, as far as this process can tell.
  [[nodiscard]] bool is_settled(const SubdomainLoad& s, const Neighbor& n) const {
    const SubdomainLoad* const other = find(*snapshot, n.subdomain);
    return other && !is_open_border(*snapshot, s, *other);
  }
  /// The mean, taken over all subdomains to be the same on all processes. Zoltan weighs borders against sizes_to_move.
  [[nodiscard]] double mean_border() const {
    double sum = 0, count = 0;
    for (const Layout::Subdomain& s : snapshot->layout->subdomains)
      for (const Neighbor& n : s.neighbors) sum += n.length, ++count;
    return sum > 0 ? sum / count : 1;
  }
  [[nodiscard]] int size() const { return static_cast<int>(snapshot->subdomains.size()); }
  [[nodiscard]] const SubdomainLoad& at(ZOLTAN_ID_TYPE i) const { return snapshot->subdomains[i]; }
  [[nodiscard]] const Layout::Subdomain& place(ZOLTAN_ID_TYPE i) const { return (*snapshot->layout)[at(i).id]; }
};

const Graph& graph_of(void* data) {
  return *static_cast<const Graph*>(data);
}

// Zoltan's query functions. Global IDs are subdomain IDs, local IDs are indices into the list of the snapshot.

int count_objects(void* data, int* error) {
  *error = ZOLTAN_OK;
  return graph_of(data).size();
}

void list_objects(void* data, int, int, Ids global, Ids local, int, float* weights, int* error) {
  const Graph& graph = graph_of(data);
  for (int i = 0; i < graph.size(); ++i) {
    local[i] = static_cast<ZOLTAN_ID_TYPE>(i);
    global[i] = static_cast<ZOLTAN_ID_TYPE>(graph.at(local[i]).id);
    weights[i] =
        static_cast<float>(std::max(1.0, graph.at(local[i]).remaining));  // Zoltan's curves do not accept zero weights
  }
  *error = ZOLTAN_OK;
}

void current_parts(void* data, int, int, int count, Ids, Ids local, int* parts, int* error) {
  for (int i = 0; i < count; ++i) parts[i] = to_int(graph_of(data).at(local[i]).owner);
  *error = ZOLTAN_OK;
}

/// In units of the cheapest move of any.
void sizes_to_move(void* data, int, int, int count, Ids, Ids local, int* sizes, int* error) {
  constexpr double kMost = 1e6;
  const Graph& graph = graph_of(data);
  const double least = graph.snapshot->subdomains.empty()
                           ? 0
                           : std::ranges::min(graph.snapshot->subdomains, {}, &SubdomainLoad::cost).cost;
  for (int i = 0; i < count; ++i) {
    const double cost = graph.at(local[i]).cost;
    sizes[i] = least > 0 ? static_cast<int>(std::min(kMost, cost / least)) : 1;
  }
  *error = ZOLTAN_OK;
}

std::int64_t count_fixed(const LoadSnapshot& snapshot) {
  return std::ranges::count_if(snapshot.subdomains, &SubdomainLoad::fixed);
}

int fixed_objects(void* data, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(count_fixed(*graph_of(data).snapshot));
}

void list_fixed(void* data, int, int, Ids global, int* parts, int* error) {
  for (const SubdomainLoad& s : graph_of(data).snapshot->subdomains) {
    if (!s.fixed) continue;
    *global++ = static_cast<ZOLTAN_ID_TYPE>(s.id);
    *parts++ = to_int(s.owner);
  }
  *error = ZOLTAN_OK;
}

int count_dimensions(void*, int* error) {
  *error = ZOLTAN_OK;
  return 2;
}

void centroids(void* data, int, int, int count, Ids, Ids local, int, double* coordinates, int* error) {
  for (int i = 0; i < count; ++i) {
    coordinates[2 * i] = graph_of(data).place(local[i]).x;
    coordinates[2 * i + 1] = graph_of(data).place(local[i]).y;
  }
  *error = ZOLTAN_OK;
}

void count_edges(void* data, int, int, int count, Ids, Ids local, int* edges, int* error) {
  const Graph& graph = graph_of(data);
  for (int i = 0; i < count; ++i) edges[i] = graph.first[local[i] + 1] - graph.first[local[i]];
  *error = ZOLTAN_OK;
}

void list_edges(void* data, int, int, int count, Ids, Ids local, int*, Ids targets, int* processes, int, float* weights,
                int* error) {
  const Graph& graph = graph_of(data);
  for (int i = 0; i < count; ++i)
    for (int e = graph.first[local[i]]; e < graph.first[local[i] + 1]; ++e) {
      *targets++ = graph.target[e];
      *processes++ = graph.process[e];
      *weights++ = graph.weight[e];
    }
  *error = ZOLTAN_OK;
}

// As a hypergraph: one hyperedge for each subdomain and its neighbors, since all of these receive its points.

void hypergraph_size(void* data, int* lists, int* pins, int* format, int* error) {
  const Graph& graph = graph_of(data);
  *lists = graph.size();
  *pins = graph.size() + graph.first.back();
  *format = ZOLTAN_COMPRESSED_EDGE;
  *error = ZOLTAN_OK;
}

void hypergraph(void* data, int, int edges, int, int, Ids edge_ids, int* first_pin, Ids pins, int* error) {
  const Graph& graph = graph_of(data);
  int written = 0;
  for (const auto i : first_ids<ZOLTAN_ID_TYPE>(edges)) {
    edge_ids[i] = static_cast<ZOLTAN_ID_TYPE>(graph.at(i).id);
    first_pin[i] = written;
    pins[written++] = edge_ids[i];
    for (int e = graph.first[i]; e < graph.first[i + 1]; ++e) pins[written++] = graph.target[e];
  }
  *error = ZOLTAN_OK;
}

/// `any_fixed`: on any process. Zoltan's processes wait for each other if only some of them answer that question.
void answer_questions(Zoltan_Struct* zoltan, Graph& graph, bool as_hypergraph, bool any_fixed) {
  Zoltan_Set_Num_Obj_Fn(zoltan, count_objects, &graph);
  Zoltan_Set_Obj_List_Fn(zoltan, list_objects, &graph);
  Zoltan_Set_Part_Multi_Fn(zoltan, current_parts, &graph);
  Zoltan_Set_Obj_Size_Multi_Fn(zoltan, sizes_to_move, &graph);
  Zoltan_Set_Num_Geom_Fn(zoltan, count_dimensions, &graph);
  Zoltan_Set_Geom_Multi_Fn(zoltan, centroids, &graph);
  if (any_fixed) {
    Zoltan_Set_Num_Fixed_Obj_Fn(zoltan, fixed_objects, &graph);
    Zoltan_Set_Fixed_Obj_List_Fn(zoltan, list_fixed, &graph);
  }
  if (as_hypergraph) {
    Zoltan_Set_HG_Size_CS_Fn(zoltan, hypergraph_size, &graph);
    Zoltan_Set_HG_CS_Fn(zoltan, hypergraph, &graph);
  } else {
    Zoltan_Set_Num_Edges_Multi_Fn(zoltan, count_edges, &graph);
    Zoltan_Set_Edge_List_Multi_Fn(zoltan, list_edges, &graph);
  }
}

void set_part_sizes(Zoltan_Struct* zoltan, const LoadSnapshot& snapshot) {
  const IdVector<Rank, double> speeds = assumed_speeds(snapshot.ranks);
  const double total = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  std::vector<float> sizes;
  for (const double speed : speeds) sizes.push_back(static_cast<float>(speed / total));
  std::vector<int> parts(speeds.size());
  std::iota(parts.begin(), parts.end(), 0);
  std::vector<int> weight_index(speeds.size(), 0);
  Zoltan_LB_Set_Part_Sizes(zoltan, 1, static_cast<int>(parts.size()), parts.data(), weight_index.data(), sizes.data());
}

/// Owns the arrays that Zoltan_LB_Partition returns.
struct Answer {
  int changes = 0, global_size = 0, local_size = 0, imports = 0, exports = 0;
  Ids import_global = nullptr, import_local = nullptr, export_global = nullptr, export_local = nullptr;
  int *import_process = nullptr, *import_part = nullptr, *export_process = nullptr, *export_part = nullptr;
  Answer() = default;
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;
  ~Answer() {
    Zoltan_LB_Free_Part(&import_global, &import_local, &import_process, &import_part);
    Zoltan_LB_Free_Part(&export_global, &export_local, &export_process, &export_part);
  }
};

/// Common to both variants: partitions by all processes of `communicator`, each of which lists its own subdomains in
/// `snapshot`.
template <class ProcessOf>
std::vector<Part> partition(MPI_Comm communicator, const LoadSnapshot& snapshot, const ZoltanParameters& parameters,
                            bool any_fixed, const ProcessOf& process_of) {
  Zoltan zoltan(communicator);
  ZoltanParameters all = parameters;
  all.try_emplace("LB_METHOD", "RCB");
  const bool as_hypergraph = all["LB_METHOD"] == "HYPERGRAPH";
  const ZoltanParameters own{{"SEED", "1"},
                             {"LB_APPROACH", "REPARTITION"},
                             {"NUM_GLOBAL_PARTS", std::to_string(snapshot.ranks.size())},
                             {"NUM_GID_ENTRIES", "1"},
                             {"NUM_LID_ENTRIES", "1"},
                             {"OBJ_WEIGHT_DIM", "1"},
                             {"EDGE_WEIGHT_DIM", as_hypergraph ? "0" : "1"},
                             {"REMAP", "0"},
                             // All parts where they are all on this process. Elsewhere what leaves it: a process
                             // without objects fails to list them all.
                             {"RETURN_LISTS", communicator == MPI_COMM_SELF ? "PARTS" : "EXPORT"}};
  all.insert(own.begin(), own.end());
  for (const auto& [name, value] : all)
    if (!zoltan.set(name, value)) throw Error("Zoltan rejects " + name + " = " + value);
  set_part_sizes(zoltan.get(), snapshot);
  Graph graph(snapshot);
  graph.add_edges(process_of);
  answer_questions(zoltan.get(), graph, as_hypergraph, any_fixed);

  make_scotch_repeat();
  Answer answer;
  const int result = Zoltan_LB_Partition(
      zoltan.get(), &answer.changes, &answer.global_size, &answer.local_size, &answer.imports, &answer.import_global,
      &answer.import_local, &answer.import_process, &answer.import_part, &answer.exports, &answer.export_global,
      &answer.export_local, &answer.export_process, &answer.export_part);
  // A warning means that the parts are less balanced than requested.
  if (result != ZOLTAN_OK && result != ZOLTAN_WARN)
    throw Error("Zoltan cannot partition with LB_METHOD = " + all["LB_METHOD"] +
                ", LB_APPROACH = " + all["LB_APPROACH"] + "; see its message above");
  std::vector<Part> parts = present_parts(snapshot);
  for (int i = 0; i < answer.exports; ++i) parts[answer.export_local[i]] = Part{answer.export_part[i]};
  return parts;
}

// The method in small letters.
std::string effort_kind(const ZoltanParameters& parameters) {
  const auto method = parameters.find("LB_METHOD");
  return method == parameters.end() ? "rcb" : lower_case(method->second);
}

}  // namespace

bool zoltan_accepts(const std::string& name, const std::string& value) {
  initialize_once();
  return Zoltan(MPI_COMM_SELF).set(name, value);
}

Efforts effort_of_parts(const LoadSnapshot& snapshot, const ZoltanParameters& parameters) {
  return {
      {effort_kind(parameters), static_cast<double>(snapshot.subdomains.size()) * bisections(snapshot.ranks.size())}};
}

std::vector<Part> zoltan_partition(const LoadSnapshot& snapshot, const ZoltanParameters& parameters) {
  if (snapshot.subdomains.empty()) return {};
  for (const auto& [kind, units] : effort_of_parts(snapshot, parameters)) note_effort(kind.c_str(), units);
  initialize_once();
  const bool any_fixed = count_fixed(snapshot) > 0;
  return partition(MPI_COMM_SELF, snapshot, parameters, any_fixed, [&](const std::vector<ZOLTAN_ID_TYPE>& neighbors) {
    IdVector<SubdomainId, int> process_of(snapshot.layout->subdomains.size(), -1);
    for (const SubdomainLoad& s : snapshot.subdomains) process_of[s.id] = 0;
    std::vector<int> processes;
    for (const ZOLTAN_ID_TYPE n : neighbors) processes.push_back(process_of[static_cast<SubdomainId>(n)]);
    return processes;
  });
}

std::vector<Part> zoltan_partition(const LoadSnapshot& own, const ZoltanParameters& parameters, int communicator) {
  initialize_once();
  const MPI_Comm all = MPI_Comm_f2c(communicator);
  struct Counts {
    std::int64_t subdomains = 0, fixed = 0;
  };
  const Counts here{static_cast<std::int64_t>(own.subdomains.size()), count_fixed(own)};
  Counts everywhere;
  MPI_Allreduce(&here, &everywhere, 2, MPI_INT64_T, MPI_SUM, all);
  if (everywhere.subdomains == 0) return {};
  return partition(all, own, parameters, everywhere.fixed > 0, [&](const std::vector<ZOLTAN_ID_TYPE>& neighbors) {
    Whereabouts whereabouts(all);
    std::vector<ZOLTAN_ID_TYPE> listed;
    for (const SubdomainLoad& s : own.subdomains) listed.push_back(static_cast<ZOLTAN_ID_TYPE>(s.id));
    whereabouts.enter(std::move(listed));
    return whereabouts.find(neighbors);
  });
}

}  // namespace driftmesh::balancer
