#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/file_registry.hpp"
#include "triangle/switches.hpp"
#include "triangle/triangulate.hpp"

namespace driftmesh::app {

/// The files of one call of Triangle: bay.node, bay.poly, bay.1.ele, ...
class TriangleFiles {
 public:
  /// `name`: as it is given, with or without .node, .poly, .ele or .area. The last three say as much as the switches p,
  /// r, and r with a.
  TriangleFiles(std::string name, triangle::Switches& switches);

  /// Reads the files that the switches ask for. Throws FileError, InputError with file and line.
  [[nodiscard]] triangle::Tables read();
  /// The files that write() makes. Throws InputError if one of them was read.
  [[nodiscard]] std::vector<std::string> outputs();
  /// Writes the files, all or none, numbered from 0 or 1 like those that were read. Throws FileError.
  void write(const triangle::Result& result) const;

 private:
  [[nodiscard]] std::string input(const char* extension);
  [[nodiscard]] std::string output(const char* extension) const { return target_ + extension; }
  [[nodiscard]] bool writes_points() const;
  [[nodiscard]] bool writes_segments() const;
  void write_segments(const triangle::Tables& mesh) const;
  void write_voronoi(const triangle::Result& result) const;
  void write_geomview(const triangle::Tables& mesh) const;

  const triangle::Switches& switches_;
  std::string source_, target_;  // without extension
  std::int32_t first_number_ = 1;
  bool has_node_file_ = true;  // which the vertices were read from
  FileRegistry files_;
};

}  // namespace driftmesh::app
