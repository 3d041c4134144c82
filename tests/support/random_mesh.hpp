#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "driftmesh/mesh.hpp"

namespace driftmesh::test {

/// The optional parts of a random mesh besides points and triangles.
struct RandomMeshParts {
  bool point_markers = true;
  bool regions = true;
  bool edges = true;
  std::int32_t attributes_per_point = 2;
};

/// A valid mesh of the unit square times `scale`: a jittered grid of columns x rows cells, each cut along a random
/// diagonal, with a hole of one cell where there is room; points, triangles and edges in random order. Its
/// constrained edges are the outer boundary, the hole's, and a line between two regions, with markers that include
/// 0 and the extremes of int32.
class RandomMesh {
 public:
  RandomMesh(std::uint32_t seed, std::int32_t columns, std::int32_t rows, RandomMeshParts parts = {}, double scale = 1)
      : random_(seed), columns_(columns), rows_(rows), parts_(parts) {
    make_names();
    make_points(scale);
    for (std::int32_t j = 0; j < rows_; ++j)
      for (std::int32_t i = 0; i < columns_; ++i)
        if (!is_hole(i, j)) add_cell(i, j);
    std::shuffle(mesh_.edges.begin(), mesh_.edges.end(), random_);
    shuffle_triangles();
  }

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

 private:
  void make_names() {
    names_.resize(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1)));
    std::iota(names_.begin(), names_.end(), 0);
    std::shuffle(names_.begin(), names_.end(), random_);
  }

  std::int32_t vertex(std::int32_t i, std::int32_t j) const {
    return names_[static_cast<std::size_t>(j * (columns_ + 1) + i)];
  }

  void make_points(double scale) {
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    mesh_.points.resize(names_.size());
    for (std::int32_t j = 0; j <= rows_; ++j)
      for (std::int32_t i = 0; i <= columns_; ++i) {
        const bool fixed_x = i == 0 || i == columns_;
        const bool fixed_y = j == 0 || j == rows_;
        mesh_.points[static_cast<std::size_t>(vertex(i, j))] = {
            scale * (i + (fixed_x ? 0 : jitter(random_))) / columns_,
            scale * (j + (fixed_y ? 0 : jitter(random_))) / rows_};
      }
    mesh_.attributes_per_point = parts_.attributes_per_point;
    mesh_.attributes.resize(names_.size() * static_cast<std::size_t>(parts_.attributes_per_point));
    for (double& value : mesh_.attributes) value = jitter(random_) * 1e-7;
    if (!parts_.point_markers) return;
    mesh_.point_markers.resize(names_.size());
    for (std::int32_t& marker : mesh_.point_markers) marker = random_marker();
  }

  bool is_hole(std::int32_t i, std::int32_t j) const {
    return columns_ > 2 && rows_ > 2 && i == columns_ / 2 && j == rows_ / 2;
  }
  bool is_outside(std::int32_t i, std::int32_t j) const {
    return i < 0 || j < 0 || i >= columns_ || j >= rows_ || is_hole(i, j);
  }
  double region(std::int32_t i) const { return i < columns_ / 2 ? 7 : -1.25; }

  void add_cell(std::int32_t i, std::int32_t j) {
    const std::int32_t a = vertex(i, j);
    const std::int32_t b = vertex(i + 1, j);
    const std::int32_t c = vertex(i + 1, j + 1);
    const std::int32_t d = vertex(i, j + 1);
    if (random_() % 2 == 0) {
      add_triangle(a, b, c, region(i));
      add_triangle(a, c, d, region(i));
    } else {
      add_triangle(a, b, d, region(i));
      add_triangle(b, c, d, region(i));
    }
    if (!parts_.edges) return;
    if (is_outside(i, j - 1)) add_edge(a, b);
    if (is_outside(i + 1, j) || (i + 1 == columns_ / 2)) add_edge(b, c);
    if (is_outside(i, j + 1)) add_edge(d, c);
    if (is_outside(i - 1, j)) add_edge(a, d);
  }

  void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, double region) {
    switch (random_() % 3) {
      case 0:
        mesh_.triangles.push_back({a, b, c});
        break;
      case 1:
        mesh_.triangles.push_back({b, c, a});
        break;
      default:
        mesh_.triangles.push_back({c, a, b});
    }
    if (parts_.regions) mesh_.regions.push_back(region);
  }

  void add_edge(std::int32_t a, std::int32_t b) {
    if (random_() % 2 == 0) std::swap(a, b);
    mesh_.edges.push_back({a, b, random_marker()});
  }

  std::int32_t random_marker() {
    constexpr std::int32_t kMarkers[] = {0, 1, 2, 5, 1000000, -3, INT32_MAX, INT32_MIN};
    return kMarkers[random_() % 8];
  }

  void shuffle_triangles() {
    for (std::size_t i = mesh_.triangles.size(); i > 1; --i) {
      const std::size_t j = random_() % i;
      std::swap(mesh_.triangles[i - 1], mesh_.triangles[j]);
      if (parts_.regions) std::swap(mesh_.regions[i - 1], mesh_.regions[j]);
    }
  }

  std::mt19937 random_;
  std::int32_t columns_;
  std::int32_t rows_;
  RandomMeshParts parts_;
  std::vector<std::int32_t> names_;
  Mesh mesh_;
};

}  // namespace driftmesh::test
