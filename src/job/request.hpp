#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cluster/cluster_spec.hpp"
#include "driftmesh/defaults.hpp"
#include "driftmesh/mesh_order.hpp"
#include "driftmesh/time_step.hpp"
#include "mapping/mapping.hpp"
#include "mesh/bounds.hpp"
#include "mesh/handles.hpp"
#include "runtime/agenda.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// Which ranks make a mesh in subdomains.
enum class ClusterKind {
  kSimulated,  ///< ranks in virtual time, all in this process
  kReal,       ///< the processes that mpirun has started
};

/// How subdomains agree on the points between them.
enum class Method {
  kCoupled,    ///< they tell each other what they insert
  kRounds,     ///< each refines by itself for a round, and then all tell each other: no mesh depends on ranks or time
  kDecoupled,  ///< all points are made beforehand; a run that needs more fails
  kPdr,        ///< there are none between subdomains: ranks refine one mesh, cell by cell
};

/// Which of several rasters counts where they overlap.
enum class RasterOrder { kGiven, kFinest };

/// All settings of a mesh, from a command line, a YAML file, or a program that uses the library. key_table.cpp declares
/// each member once: its name, unit, range, default, help, and where it applies. Members are grouped as the sections of
/// a file are. Nothing here is checked yet (see check.hpp).
struct Request {
  struct Input {
    std::string file;
    std::string generator;
    std::map<std::string, std::string> parameters;  ///< parameters for the generator
    double snap = 0;                                ///< what is that near is joined; 0: nothing
    bool hull = false;                              ///< whether the convex hull is the outline
    double simplify = 0;                            ///< by how much lines may move; 0: nothing is simplified
    double close_channels = 0;                      ///< channels narrower than that are filled; 0: none
    HoleRule holes = HoleRule::kPoints;
    bool strict = false;                              ///< warnings about the input are errors
    std::map<std::string, std::string> marker_names;  ///< by the numbers of markers
    std::map<std::string, std::string> region_names;  ///< by the attributes of regions
    std::string layers;                               ///< layers in the file, separated by commas; empty: the only one
    bool degrees = false;                             ///< the domain is in degrees though its file does not say so
    std::string projection = "auto";                  ///< the plane for a domain in degrees
    std::map<std::string, std::string> rasters;       ///< their files, by name, with commas between several
    double raster_blend = 0;                          ///< the width of seams between them
    RasterOrder raster_order = RasterOrder::kGiven;
    std::string contour;              ///< "depth=0": the domain is where this raster is above a level; empty: it is not
    std::vector<double> contour_box;  ///< west, south, east, north limits of that domain; empty: the whole raster
    std::vector<double> contour_seeds;  ///< x and y of points in the parts that are meant; empty: the largest part
  } input;

  struct Bounds : PlainBounds {
    double angle = defaults::kMinAngle;
    double triangles = 0;           ///< in place of an area; 0: not given
    double triangles_per_rank = 0;  ///< the same
  } bounds;

  struct Sizing {
    std::string expression;
    std::string background;
    std::int32_t across = 0;  ///< layers of triangles across every channel; 0: any number
    std::string tree{};       ///< a file of compiled lengths, in place of all others; empty: none
    std::string save_tree{};  ///< the file that compiled lengths are saved in; empty: none
    double gradation = 0;     ///< 0: lengths are taken as they are
    double shortest = 0;
    double longest = 0;  ///< 0: no limit
    std::int64_t resolution = defaults::kSizeResolution;
    double courant_step = 0;  ///< 0: no time step is asked for
    double courant = defaults::kCourant;
    double courant_speed = 0;
    CourantLength courant_length = CourantLength::kEdge;
    /// Whether some lengths are those of expressions.
    [[nodiscard]] bool is_compiled() const { return !expression.empty() || across > 0; }
    /// Whether lengths vary from place to place.
    [[nodiscard]] bool varies() const { return is_compiled() || !background.empty() || !tree.empty(); }
  } sizing;

  struct Limits {
    std::int64_t max_triangles = kMostRefined;
    std::int64_t max_memory = 0;  ///< bytes; 0: 90 % of what the machine has free
    bool keep_incomplete = false;
  } limits;

  struct Decomposition {
    std::int32_t subdomains = 0;  ///< 0: as many as suit
    std::int32_t subdomains_per_rank = 0;
    std::string file;
    double separator_angle = defaults::kSeparatorAngle;
    double skew = 0;
    double forecast_error = 1;  ///< factor by which forecasts are off, up or down
    friend bool operator==(const Decomposition&, const Decomposition&) = default;
  } decomposition;

  struct Mapping {
    MappingMethod method = MappingMethod::kGraph;
    bool by_speed = false;
    bool by_area = false;
    std::vector<double> speeds;  ///< one for each rank, relative; empty: all equal
    std::string file;            ///< instead of all these
    bool to_late_ranks = true;   ///< also to simulated ranks that are not there at the start
    friend bool operator==(const Mapping&, const Mapping&) = default;
  } mapping;

  struct Cluster {
    ClusterKind kind = ClusterKind::kSimulated;
    std::int32_t ranks = 0;
    double speed = 0;  ///< 0: that of the reference machine
    std::vector<RankGroup> groups;
    std::vector<double> rank_speeds;
    std::vector<RankChange> changes;
    std::vector<double> drag;
    double latency = defaults::kLatency;
    double bandwidth = defaults::kBandwidth;
    std::int32_t ranks_per_host = ClusterSpec{}.ranks_per_host;
    double memory = ClusterSpec{}.memory;
    double message_overhead = defaults::kMessageOverhead;
    double scale = ClusterSpec{}.scale;
    std::string costs;  ///< a file; empty: those of the reference machine
  } cluster;

  /// How long a rank may say nothing, in seconds.
  struct Patience {
    double silence = 10;  ///< then it is named
    double give_up = 0;   ///< then the run ends; 0: never
  } patience;

  struct Run {
    Method method = Method::kCoupled;
    Presplit presplit = Presplit::kAuto;
    std::int64_t aggregation = defaults::kAggregation;
    WorkOrder order = WorkOrder::kGiven;
    std::int64_t slice = defaults::kSlice;
    bool sleep = false;
    std::string scratch;       ///< a folder on disk for sleeping subdomains; empty: they sleep in memory
    std::int32_t threads = 0;  ///< 0: one for each core
    std::string checkpoint;    ///< the file that the state of the work is kept in; empty: none
    double every = 600;        ///< seconds between two of these
    std::string resume;        ///< the file of a run to go on with; empty: none
  } run;

  struct Balance {
    std::string policy = "none";
    std::map<std::string, std::string> parameters;
    double look = defaults::kLook;
    double gap = defaults::kGap;
    double interval = defaults::kInterval;
    double gain = defaults::kGain;
  } balance;

  std::int64_t seed = 1;

  struct Output {
    std::vector<std::string> meshes;
    bool ascii = false;
    MeshOrder order = MeshOrder::kGiven;
    bool ghost_layer = false;
    std::vector<double> open_boundary;  ///< markers
    double open_from = 0;               ///< shorter boundaries with these markers are land
    std::string crs = "auto";           ///< the coordinates in files
    std::string depth;                  ///< the raster that points get values of; empty: none
    std::string session;                ///< the file of an adaptive mesh that begins with this one; empty: none
    std::string picture;
    std::string record;
    bool quiet = false;
  } output;

  // Only for experiments, which make many runs.
  std::string name = "experiment";
  std::int32_t repetitions = 1;
  bool report = true;
  std::int32_t lb_phases = 0;
};

}  // namespace driftmesh::job
