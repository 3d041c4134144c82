#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "driftmesh/point.hpp"
#include "driftmesh/time_step.hpp"

namespace driftmesh {

namespace balancer {
class Policy;
}
struct Decomposition;

/// Progress of the refinement; on many ranks, of this rank's subdomains.
struct Progress {
  std::int64_t triangles = 0;  ///< made so far
  double forecast = 0;         ///< expected in the end
};

/// Whether interfaces are split to size before refinement.
enum class Presplit {
  kAuto,  ///< if there is a bound on area or size
  kOn,    ///< always; an error without such a bound
  kOff,   ///< never: the protocol of the paper in full
};

/// What is a hole of the domain.
enum class HoleRule {
  kPoints,  ///< an area with a hole point of the input
  kNested,  ///< also every second ring of segments from the outside in, unless it has a region point
};

/// Which of a rank's subdomains works next.
enum class WorkOrder {
  kGiven,    ///< in the order of their numbers, which is one of neighborhood: neighbors finish together
  kLargest,  ///< most triangles to be made first: what may be moved later is small
  kBacklog,  ///< most points waiting first: answers to neighbors leave early
};

/// How subdomains are dealt to ranks at the start.
enum class MappingMethod {
  kGraph,       ///< balanced work, short interfaces between ranks (METIS)
  kBlock,       ///< consecutive subdomains, balanced work
  kRoundRobin,  ///< subdomain i on rank i mod P: for experiments, the worst interfaces
};

/// Requirements on a mesh, and how it is made. Every member has a default; name the ones that matter:
/// {.min_angle = 25, .max_area = 1e-3}. Ranges and meanings are those of `driftmesh mesh --help`. Options that do not
/// apply (such as a policy in a single process) are rejected with an Error, never ignored.
///
/// Lengths and areas are in the units of the input, angles in degrees, times in seconds, memory in bytes.
///
/// \code
/// driftmesh::MeshOptions options{.min_angle = 28, .triangles = 50e3, .threads = 2};
/// options.progress = [](const driftmesh::Progress& p) { return p.triangles < 1'000'000; };  // false cancels
/// options.subdomains.count = 16;
/// const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::generate("bay"), options);
/// \endcode
struct MeshOptions {
  // ---- The domain ----
  double snap = 0;            ///< vertices and segments at most this far apart are joined (see repair.hpp); 0: none
  bool hull = false;          ///< whether the convex hull of all points is the outline: its edges become segments
  double simplify = 0;        ///< by how much lines may move for fewer points (see simplify.hpp); 0: not at all
  double close_channels = 0;  ///< channels narrower than this are filled (see close_channels.hpp); 0: none
  HoleRule holes = HoleRule::kPoints;
  bool strict = false;  ///< whether warnings are errors: an InputError is thrown
  /// Called for each thing that the author of the input may not have meant, with its place: flaws of polygons,
  /// segments outside the domain, regions that are not separated, rings of segments that are neither holes nor regions.
  /// On many ranks, on rank 0.
  std::function<void(const std::string&)> warning{};

  // ---- Triangles ----
  double min_angle = defaults::kMinAngle;  ///< 0 to 34; smaller ones remain where the input has small angles
  double max_area = 0;                     ///< 0: no bound
  double triangles = 0;      ///< instead of an area: choose the one that gives about this many triangles; 0: not given
  bool region_areas = true;  ///< whether the area bounds of the input's regions apply
  /// Target edge length at a point, > 0, or infinity for no bound: a triangle is too large if its area exceeds that of
  /// the equilateral triangle whose side is the smallest value at its corners and centroid, or 1.11 times a value
  /// between them that size_resolution finds. Must depend on the point alone; pass a SizeField by std::ref. Called
  /// often, at points of the domain only; on many ranks it must be the same function on all of
  /// them. Exceptions it throws end the work and propagate.
  std::function<double(const Point&)> size{};
  /// Layers of triangles across every channel of the domain; 0: any number. Triangles get small enough for that,
  /// however narrow the channel is: close_channels sets a limit. See docs/size-expressions.md.
  std::int32_t across = 0;
  /// `size` is also looked up on a grid of this many squares along the longer side of the domain, and around its lowest
  /// points where it is steep: no feature that fills a square is missed. Triangles too small for the grid are judged by
  /// corners and centroid alone. The function is called about once for each point of the grid, up to 4 million times by
  /// default; choose less for one that is costly and known to be smooth.
  std::int64_t size_resolution = defaults::kSizeResolution;
  /// The time step that triangles are to allow, in steps of `courant.step` seconds, before any bound on their size:
  /// triangles are only split for their size where those that this makes allow it. Coordinates and depths are in
  /// meters. Where the input or the angle bound keep triangles from allowing it, they stay; with `strict` an
  /// InputError is thrown, on all ranks.
  CourantRule courant{};
  /// Rasters of the domain by their names: a file each, or several with commas between them.
  std::map<std::string, std::string> rasters{};
  /// The one with depths, positive downward: `courant` asks it, and points get their depths as attributes.
  std::string depth{};

  /// The most threads that work at once in a single process, where the mesh is large enough to be cut; the mesh does
  /// not depend on it. 0: one for each core, but only the calling thread if there is a `size`, which may not be made
  /// for more. With more than one, `size` is called by all of them at once; `progress` and `warning` by the calling
  /// one. On many ranks, the threads of each, 0: one.
  std::int32_t threads = 0;

  // ---- Limits of this process ----
  std::int64_t max_triangles = 0;  ///< beyond it, LimitError; 0: none but the capacity of one piece, about 500 million
  std::int64_t max_memory = 0;     ///< in bytes, likewise; 0: 90 % of the machine's free memory
  /// Called from time to time, at least once; returning false cancels the work with Cancelled.
  std::function<bool(const Progress&)> progress{};

  /// Decomposition into subdomains.
  struct Subdomains {
    /// 1: one piece. 0: 20 per rank, or more so that each fits in cache; in a single process one piece, except where a
    /// bound on size asks for more than half a million triangles.
    std::int32_t count = 0;
    /// An existing decomposition of the same input, possibly made with other bounds. See decomposition.hpp.
    std::shared_ptr<const Decomposition> given{};
    double separator_angle = defaults::kSeparatorAngle;  ///< smallest angle between separators and whatever they meet,
                                                         ///< where the domain allows
    double skew = 0;        ///< 0: equal work; up to 1: deliberately uneven, for experiments
    std::int64_t seed = 1;  ///< seed for skew
    Presplit presplit = Presplit::kAuto;
    WorkOrder order = WorkOrder::kGiven;
    std::int64_t slice = defaults::kSlice;  ///< most points inserted between polls of the network
    bool sleep = false;  ///< compress finished subdomains to 10 bytes per triangle until a neighbor needs them
  } subdomains{};

  /// Many ranks.
  struct Ranks {
    MappingMethod mapping = MappingMethod::kGraph;
    std::vector<double> speeds{};  ///< relative speed of each rank, if known: work is mapped in proportion
    bool map_by_area = false;      ///< map by area instead of expected work: an uneven start, for experiments
    std::int64_t aggregation = defaults::kAggregation;  ///< most split points in one message
    double silence = 10;  ///< seconds after which a warning names a rank that does not answer
    double give_up = 0;   ///< seconds after which such a rank ends the job; 0: never
  } ranks{};

  /// Subdomains that move between ranks while they are refined.
  struct Balance {
    std::string policy = "none";                      ///< a name: see docs/balancing.md
    std::map<std::string, std::string> parameters{};  ///< parameters for the policy, as in {{"method", "graph"}}
    std::shared_ptr<const balancer::Policy> own{};    ///< instead of a name; must be equivalent on every rank
    double look = defaults::kLook;                    ///< time between a rank's checks of its own load
    double gap = defaults::kGap;                      ///< shortest time between reports of a rank, and between plans
    double interval = defaults::kInterval;            ///< longest time between reports of a rank that has work
    double gain = defaults::kGain;                    ///< fraction of the finishing time that moving must save
  } balance{};
};

}  // namespace driftmesh
