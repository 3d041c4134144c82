#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "driftmesh/mesh.hpp"
#include "io/triangle_data.hpp"
#include "io/vtu_format.hpp"

namespace driftmesh {

/// The file beside mesh.h5 that describes it to readers of XDMF: mesh.xdmf.
[[nodiscard]] std::string xdmf_path(const std::string& path);

// One HDF5 file in the layouts of several readers (docs/file-formats.md). One process makes the file with all of its
// arrays, which are contiguous and have no content yet; then every process that has a part of the mesh writes the rows
// of that part to the places of the arrays, whatever the others do meanwhile.

/// How much is in the file.
struct Hdf5Shape {
  std::uint64_t points = 0;
  std::uint64_t triangles = 0;
  std::uint64_t lines = 0;
  VtuArrays arrays;
  Names names{};
  std::string coordinates{};              ///< see Mesh
  std::vector<std::string> data_names{};  ///< what data at triangles are called
};
/// Where arrays begin, by their names: byte offsets into the file. An array without elements has no place.
using Hdf5Places = std::map<std::string, std::uint64_t>;

/// `file` exists and is replaced; messages call it `path`. Throws FileError.
[[nodiscard]] Hdf5Places create_hdf5(const std::string& file, const std::string& path, const Hdf5Shape& shape);

/// What one process writes of a mesh.
struct Hdf5Part {
  const Mesh& mesh;
  std::vector<std::int32_t> points;  ///< those that it writes, to consecutive rows
  std::vector<std::int32_t> lines;   ///< those of mesh.edges that it writes, likewise
  std::vector<std::int64_t> row;     ///< one for every point of the mesh, also for those that others write
  std::uint64_t first_point = 0;     ///< the rows of the first ones that it writes
  std::uint64_t first_triangle = 0;  ///< number among all triangles of the mesh
  std::uint64_t first_line = 0;
  std::map<double, std::int32_t> tags{};  ///< tags for the regions of the whole mesh
  const TriangleData* data = nullptr;     ///< at its triangles; null: none
};

/// Throws FileError.
void write_hdf5_part(const std::string& file, const std::string& path, const Hdf5Shape& shape, const Hdf5Places& places,
                     const Hdf5Part& part);

/// Describes the .h5 file at `path` in the file beside it. Throws FileError.
void write_xdmf(const std::string& path, const Hdf5Shape& shape);

/// All of it for a whole mesh. Both files appear when complete. Throws FileError, and InputError if `path` cannot hold
/// a regular file.
void write_hdf5(const Mesh& mesh, const TriangleData& data, const std::string& path);

/// Reads what these functions write. A file that ranks wrote gives the same mesh whichever rank held what (see
/// merge_pieces), and nothing from other files (see require_own_content). Errors: InputError, FileError.
[[nodiscard]] Mesh read_hdf5(const std::string& path);
/// The same, with the numbers that the file has at cells besides; none of a file that ranks wrote, whose triangles
/// change places.
[[nodiscard]] Mesh read_hdf5(const std::string& path, TriangleData& data);

}  // namespace driftmesh
