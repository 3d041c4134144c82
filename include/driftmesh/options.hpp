#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

namespace balancer {
class Policy;
}
struct Decomposition;

/// How far a mesh has come. On many ranks, of this rank's subdomains.
struct Progress {
  std::int64_t triangles = 0;  ///< made so far
  double forecast = 0;         ///< to be expected in the end
};

/// Whether interfaces are cut to size before refinement.
enum class Presplit {
  kAuto,  ///< where the bounds say anything about size
  kOn,    ///< the same, and an error if they do not
  kOff,   ///< never: the protocol of the paper in full
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

/// What a mesh must be like, and how it is made. Every member has a default; name the ones that matter:
/// {.min_angle = 25, .max_area = 1e-3}. Ranges and meanings are those of `driftmesh mesh --help`. What cannot apply (a
/// policy where one process is alone) is refused, never ignored: Error.
///
/// Lengths and areas are in the units of the input, angles in degrees, times in seconds, memory in bytes.
struct MeshOptions {
  // ---- Triangles ----
  double min_angle = 20;     ///< 0 to 34; smaller ones remain where the input has small angles
  double max_area = 0;       ///< 0: no bound
  double triangles = 0;      ///< in place of an area: the one that gives about so many triangles; 0: not given
  bool region_areas = true;  ///< whether the area bounds of the input's regions hold
  /// Target edge length at a point, > 0, or infinity for no bound: a triangle is too large when its area exceeds that
  /// of the equilateral triangle with the smallest value at its corners and centroid for a side. Any function of the
  /// point alone; a SizeField by std::ref. Called often, from the calling thread; on many ranks it must be the same
  /// function on each of them. What it throws ends the work and passes through.
  std::function<double(const Point&)> size{};

  // ---- Limits, of this process ----
  std::int64_t max_triangles = 0;  ///< LimitError rather than more; 0: what the data structure holds, about 500 million
  std::int64_t max_memory = 0;     ///< likewise; 0: 90 % of what the machine has free
  /// Called now and then, at least once; false cancels, which throws Cancelled.
  std::function<bool(const Progress&)> progress{};

  /// The domain in subdomains.
  struct Subdomains {
    std::int32_t count = 0;  ///< 0: in one process, one piece; on ranks 20 for each, or what keeps each in cache
    /// In place of cutting: made from the same input, perhaps with other bounds. See decomposition.hpp.
    std::shared_ptr<const Decomposition> given{};
    double separator_angle = 60;  ///< smallest angle between separators and all they meet, where the domain allows it
    double skew = 0;              ///< 0: equal work; up to 1: deliberately uneven, for experiments
    std::int64_t seed = 1;        ///< of the unevenness
    Presplit presplit = Presplit::kAuto;
    WorkOrder order = WorkOrder::kGiven;
    std::int64_t slice = 16384;  ///< points inserted between two looks at the network
    bool sleep = false;  ///< finished subdomains shrink to 10 bytes a triangle, until a neighbor needs them again
  } subdomains{};

  /// Many ranks.
  struct Ranks {
    MappingMethod mapping = MappingMethod::kGraph;
    std::vector<double> speeds{};    ///< relative speed of each rank, if known: work is dealt in proportion
    bool map_by_area = false;        ///< deal out area in place of expected work: an uneven start, for experiments
    std::int64_t aggregation = 512;  ///< split points that travel in one message at most
  } ranks{};

  /// Subdomains that move between ranks while they are refined.
  struct Balance {
    std::string policy = "none";                      ///< by name: see docs/balancing.md
    std::map<std::string, std::string> parameters{};  ///< of that policy, as in {{"method", "graph"}}
    std::shared_ptr<const balancer::Policy> own{};    ///< in place of a name; an equal one on every rank
    double look = 0.01;                               ///< between two looks of a rank at its own load
    double gap = 0.02;    ///< between two reports of a rank, and between two plans, at least
    double interval = 1;  ///< between two reports of a rank that has work, at most
    double gain = 0.02;   ///< share of the finishing time that moving must save
  } balance{};
};

}  // namespace driftmesh
