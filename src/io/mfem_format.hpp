#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "io/file_sink.hpp"

namespace driftmesh {

// The text format of MFEM (mfem.org/mesh-format-v1.0, -v1.x), of one mesh, and of the parts that the ranks of a ParMesh
// have. Attributes are positive in MFEM: those of elements are the tags of regions (see group_tags), or 1 without
// regions, those of boundary elements the tags of markers; comments say which value each tag is for, and its name.
// There is no place for subsegments inside of the domain and for data on points.

// Geometry types of the format.
inline constexpr std::int32_t kMfemSegment = 1;
inline constexpr std::int32_t kMfemTriangle = 2;

/// What some ranks have in common, in the same order in the files of all of them.
struct MfemGroup {
  std::vector<std::int32_t> ranks;                   ///< ascending
  std::vector<std::int32_t> points;                  ///< indices into the points of this rank
  std::vector<std::array<std::int32_t, 2>> edges{};  ///< between such points, in the same direction everywhere
};

/// What one file holds.
struct MfemPart {
  const Mesh& mesh;
  std::vector<std::int32_t> boundary;  ///< those of mesh.edges that bound the whole domain
  std::map<double, std::int32_t> region_tags;
  std::map<double, std::int32_t> marker_tags;
  std::vector<MfemGroup> groups{};  ///< a rank's: first itself alone; empty: one mesh of one process
};

/// The file is complete, but appears under its name only on commit(). Throws FileError.
[[nodiscard]] std::unique_ptr<FileSink> prepare_mfem(const MfemPart& part, const std::string& path);

/// A mesh in one file. Throws FileError.
void write_mfem(const Mesh& mesh, const std::string& path);

/// Reads what write_mfem writes, and planar meshes of straight triangles from MFEM. Attributes of elements become
/// regions unless all are 1. `file` is for messages. Throws InputError.
[[nodiscard]] Mesh parse_mfem(const std::string& file, std::string_view text);

/// The file of a rank, as MFEM numbers them: bay.pmesh means bay.mesh.000000, bay.mesh.000001, ...
[[nodiscard]] std::string mfem_part_path(const std::string& path, std::int32_t rank);

}  // namespace driftmesh
