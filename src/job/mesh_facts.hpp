#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "mesh/exceptions.hpp"
#include "mesh/refine_counters.hpp"
#include "mesh/step_inspection.hpp"

namespace driftmesh::job {

/// Facts about a finished mesh, or a part of one: those of the parts add up to those of the whole. Angles are in
/// degrees.
struct MeshFacts {
  std::int64_t triangles = 0;
  std::int64_t vertices = 0;  ///< shared ones count once in each part
  std::int64_t subsegments = 0;
  RefineCounters counters;
  AngleSummary shape;
  std::uint64_t digest = 0;

  struct Place {
    Point at;
    double angle = 180;
  };
  /// Triangles that miss a bound for the same reason.
  struct ExceptionGroup {
    static constexpr std::size_t kMaxPlaces = 3;
    std::string cause;
    std::int64_t count = 0;
    double worst_angle = 180;   ///< the worst below the angle bound
    std::vector<Place> places;  ///< the worst: corners with the smallest angles, each once
  };
  std::vector<ExceptionGroup> exceptions;

  /// What a time step that was asked for has come to.
  struct Step {
    static constexpr std::size_t kMaxPlaces = 3;
    struct Place {
      Point at;
      double room = 1;  ///< the longest step there over the one asked for
    };
    /// Triangles that do not allow it, for the same reason.
    struct Group {
      std::int64_t count = 0;
      std::array<Place, kMaxPlaces> places{};  ///< the worst, as many as there are
      double longest_needed = 0;               ///< the longest edge that one of them needs
    };
    double least_room = std::numeric_limits<double>::infinity();
    std::array<Group, kStepCauses> groups{};  ///< by StepCause

    [[nodiscard]] std::int64_t misses() const;
    void add(const Step& other);
  };
  Step step;
};

/// Adds the facts of `mesh`, a part refined to `bounds`. `complete`: refinement was not stopped by a limit.
/// `on_all_cores`: in several threads, where this process is alone.
void add_part(MeshFacts& facts, const Triangulation& mesh, const QualityBounds& bounds, bool complete,
              bool on_all_cores = false);
/// Adds the work of refining a part.
void add_counters(MeshFacts& facts, const RefineCounters& counters);
/// Adds the facts of other parts.
void add_facts(MeshFacts& facts, const MeshFacts& others);

void write_facts(ByteWriter& writer, const MeshFacts& facts);
[[nodiscard]] MeshFacts read_facts(ByteReader& reader);

}  // namespace driftmesh::job
