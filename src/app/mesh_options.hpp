#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "mesh/mesher.hpp"
#include "protocol/aggregator.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh::app {

/// What `driftmesh mesh` was asked for.
struct MeshOptions {
  std::string input;
  double area = 0;  ///< <= 0: no bound
  double angle = 20;
  bool no_region_areas = false;
  SizingOptions sizing;

  std::int64_t max_triangles = MeshRequest{}.max_triangles;
  std::uint64_t max_memory = 0;  ///< bytes; 0: 90 % of what the machine has free
  bool keep_incomplete = false;

  /// For a mesh in parts; ask for them with any of the first three, or start with mpirun.
  struct Parts {
    std::int32_t subdomains = 0;  ///< 0: as many as suit
    std::string decomposition;    ///< a file to take it from, instead
    double separator_angle = 60;
    double skew = 0;
    std::uint64_t seed = 1;
    std::string mapping = "graph";
    bool map_by_area = false;
    std::vector<double> speeds;
    std::string presplit = "auto";
    std::size_t aggregation = protocol::Aggregator::kDefaultThreshold;
    std::string order = "given";
    bool sleep = false;
    std::string policy = "none";
    std::vector<std::string> policy_parameters;  ///< name=value
    std::vector<double> drag;                    ///< of each rank: the fraction of its time that it works
    [[nodiscard]] bool wanted() const { return subdomains > 0 || !decomposition.empty(); }
  } parts;

  std::vector<std::string> outputs;
  std::string picture;
  std::string json;
  bool quiet = false;
  std::string config;
};

/// The options of `driftmesh mesh`. `options` must outlive them.
[[nodiscard]] std::vector<cli::Option> mesh_options(MeshOptions& options);

/// Throws UsageError for options that are missing or do not go together.
void check_mesh_options(const MeshOptions& options);

}  // namespace driftmesh::app
