#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "sim/domains.hpp"
#include "sim/life.hpp"

namespace driftmesh::sim {

/// Runs of one mesh, each of which goes on from what the one before it has left, until one is not ended: everything but
/// the domain's shape follows from the seed.
struct JourneyPlan {
  std::uint64_t seed = 1;
  std::string domain;
  std::int32_t subdomains = 1;
  bool in_rounds = true;  ///< with checkpoints; or else coupled, and each run begins anew
  bool presplit = false;
  std::int64_t slice = 1;  ///< insertions
  double every = 0;        ///< part of the time that a whole run takes
  struct Leg {
    std::int32_t ranks = 1;
    std::vector<Fault> faults;  ///< times as parts of what a whole run takes
  };
  std::vector<Leg> legs;

  [[nodiscard]] static JourneyPlan from_seed(std::uint64_t seed);
  [[nodiscard]] std::string describe() const;
};

/// What has happened, in numbers that add up.
struct JourneyCounts {
  std::int64_t journeys = 0, in_rounds = 0, lives = 0, resumed = 0, anew = 0, saves = 0, refused = 0, given_up = 0;
  std::map<Fault::Kind, std::int64_t> faults;
  double oldest =
      0;  ///< seconds since the last checkpoint of a run that nothing delayed, when it was ended, over what was due
};

class Journeys {
 public:
  /// Both for tests of the oracles. `between`: is given what a run has left before the next one goes on from it.
  explicit Journeys(Sabotage sabotage = Sabotage::kNone, std::function<void(Files&)> between = {})
      : sabotage_(sabotage), between_(std::move(between)) {}

  /// Makes one. Returns the first problem, or nothing.
  [[nodiscard]] std::string travel(const JourneyPlan& plan);
  [[nodiscard]] const JourneyCounts& counts() const { return counts_; }

 private:
  struct Whole {
    std::uint64_t digest = 0;
    double seconds = 0;
    std::int64_t triangles = 0;
  };
  class Travel;

  [[nodiscard]] LifePlan life_of(const JourneyPlan& plan);
  /// A run that nothing befalls.
  [[nodiscard]] const Whole& whole(const JourneyPlan& plan);

  Sabotage sabotage_;
  std::function<void(Files&)> between_;
  Domains domains_;
  std::map<std::tuple<std::string, std::int32_t, bool, bool, std::int64_t>, Whole> wholes_;
  JourneyCounts counts_;
};

[[nodiscard]] const char* name_of(Fault::Kind kind);
/// "12 journeys, 9 in rounds, ..."
[[nodiscard]] std::string words_of(const JourneyCounts& counts);

}  // namespace driftmesh::sim
