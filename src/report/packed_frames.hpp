#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "report/page_block.hpp"

namespace driftmesh {

/// Meshes that follow each other, each with the values of one field: what the page plays. They are packed one by one,
/// so that few of them are in memory at a time; one that is the same as its predecessor is packed once.
class PackedFrames {
 public:
  /// What the page calls them, and the field, which is at the points or at the triangles of all of them.
  PackedFrames(std::string name, std::string field, bool at_points);

  /// `values`: one for each point or triangle; those that are not finite have no color. `time`: if it is known. The
  /// mesh has triangles.
  void add(const Mesh& mesh, const std::vector<double>& values, std::optional<double> time);

  [[nodiscard]] std::size_t size() const { return frames_; }
  /// Of all frames together.
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  /// What the page has of them; empty without frames.
  [[nodiscard]] std::string blocks() const;

 private:
  void add_mesh(const Mesh& mesh);

  std::string name_, field_;
  bool at_points_;
  std::size_t frames_ = 0, meshes_ = 0, triangles_ = 0;
  std::vector<Point> points_;  // those of the last mesh
  std::vector<std::array<std::int32_t, 3>> corners_;
  Corners box_{};   // around all points
  Point middle_{};  // that of the first mesh
  float least_ = std::numeric_limits<float>::infinity(), most_ = -least_;
  std::string packed_;
};

}  // namespace driftmesh
