#include "io/mesh_formats.hpp"

#include <filesystem>

#include "base/read_file.hpp"
#include "io/fort14_format.hpp"
#include "io/hdf5_format.hpp"
#include "io/medit_format.hpp"
#include "io/mfem_format.hpp"
#include "io/msh_format.hpp"
#include "io/pvtu_format.hpp"
#include "io/su2_format.hpp"
#include "io/triangle_format.hpp"
#include "io/vtu_format.hpp"

namespace driftmesh {
namespace {

using Paths = std::vector<std::string>;

std::string stem_of(const std::string& path) {
  return std::filesystem::path(path).replace_extension().string();
}

/// The files that `name` gives to the pieces.
template <auto name>
Paths pieces_of(const std::string& path, std::int32_t count) {
  Paths files;
  for (std::int32_t k = 0; k < count; ++k) files.push_back(name(path, k));
  return files;
}

Paths pvtu_files(const std::string& path, std::int32_t pieces) {
  Paths files = pieces_of<pvtu_piece_path>(path, pieces);
  files.insert(files.begin(), path);
  return files;
}

Paths pvtu_files_read(const std::string& path, const ReadOptions& options) {
  Paths files = read_pvtu_header(path, options).pieces;
  files.insert(files.begin(), path);
  return files;
}

Paths triangle_files(const std::string& path, std::int32_t) {
  const std::string stem = stem_of(path);
  return {stem + ".node", stem + ".ele", stem + ".poly", stem + ".edge", stem + ".neigh"};
}

template <auto write_format>
void written(const Mesh& mesh, const std::string& path, const WriteOptions&) {
  write_format(mesh, path);
}

/// Two formats have the ending .mesh; their first line tells which one it is.
Mesh parse_mfem_or_medit(const std::string& file, std::string_view text) {
  return text.starts_with("MFEM") ? parse_mfem(file, text) : parse_medit(file, text);
}

std::vector<MeshFormat> all_formats() {
  return {{.extensions = {".vtu"},
           .remark = "ParaView",
           .keeps = kAllParts & ~kWeirs,
           .write = written<write_vtu>,
           .parse = [](const std::string& file, std::string_view bytes) { return parse_vtu(file, bytes); },
           .begins = kBeginsXml,
           .parse_with_data =
               [](const std::string& file, std::string_view bytes, TriangleData& data) {
                 Mesh mesh = parse_vtu(file, bytes);
                 data = parse_vtu_triangle_data(file, bytes);
                 return mesh;
               },
           .write_with_data = [](const Mesh& mesh, const TriangleData& data, const std::string& path,
                                 const WriteOptions&) { write_vtu_with_data(mesh, data, path); }},
          {.extensions = {".pvtu"},
           .remark = "the same in pieces, one per rank",
           .keeps = kAllParts & ~kWeirs,
           .has_ghosts = true,
           .read = [](const std::string& path, const ReadOptions& options) { return read_pvtu(path, options); },
           .read_with_data = [](const std::string& path, const ReadOptions& options,
                                TriangleData& data) { return read_pvtu(path, options, &data); },
           .files = pvtu_files,
           .files_read = pvtu_files_read,
           .in_pieces = PieceWriters::kThreadsAndRanks,
           .whole = ".vtu"},
          {.extensions = {".msh"},
           .remark = "Gmsh 4.1",
           .keeps = kDomainParts | kNamedParts | kSubdomains,
           .has_text = true,
           .write = [](const Mesh& mesh, const std::string& path,
                       const WriteOptions& options) { write_msh(mesh, {}, path, options.ascii); },
           .parse = parse_msh,
           .begins = "$",
           .parse_with_data = parse_msh,
           .write_with_data = [](const Mesh& mesh, const TriangleData& data, const std::string& path,
                                 const WriteOptions& options) { write_msh(mesh, data, path, options.ascii); }},
          {.extensions = {".h5"},
           .remark = "HDF5 with an .xdmf beside it, for solvers",
           .keeps = kDomainParts | kNamedParts | kSubdomains,
           .write = [](const Mesh& mesh, const std::string& path, const WriteOptions&) { write_hdf5(mesh, {}, path); },
           .read = [](const std::string& path, const ReadOptions&) { return read_hdf5(path); },
           .read_with_data = [](const std::string& path, const ReadOptions&,
                                TriangleData& data) { return read_hdf5(path, data); },
           .write_with_data = [](const Mesh& mesh, const TriangleData& data, const std::string& path,
                                 const WriteOptions&) { write_hdf5(mesh, data, path); },
           .files =
               [](const std::string& path, std::int32_t) {
                 return Paths{path, xdmf_path(path)};
               },
           .files_read = [](const std::string& path, const ReadOptions&) { return Paths{path}; }},
          {.extensions = {".su2"},
           .keeps = kMarkers | kMarkerNames | kBoundaryTypes,
           .write = written<write_su2>,
           .parse = parse_su2},
          {.extensions = {".mesh"},
           .remark = "MFEM",
           .keeps = kMarkers | kRegions | kNamedParts,
           .write = written<write_mfem>,
           .parse = parse_mfem_or_medit},
          {.extensions = {".medit.mesh"},
           .remark = "Medit: mmg2d, FreeFEM",
           .keeps = kPointMarkers | kMarkers | kInnerSegments | kOrderOfSegments | kRegions | kNamedParts,
           .write = written<write_medit>,
           .parse = parse_mfem_or_medit},
          {.extensions = {".pmesh"},
           .remark = "MFEM's ParMesh, a file for each rank",
           .keeps = kMarkers | kRegions | kNamedParts,
           .files = pieces_of<mfem_part_path>,
           .in_pieces = PieceWriters::kRanks,
           .whole = ".mesh"},
          {.extensions = {".14", ".grd"},
           .remark = "ADCIRC",
           .keeps = kFirstAttribute | kBoundaryTypes | kWeirs,
           .is_grid = true,
           .write = [](const Mesh& mesh, const std::string& path,
                       const WriteOptions& options) { write_fort14(mesh, path, options, true); },
           .parse = parse_fort14},
          {.extensions = {".gr3"},
           .remark = "SCHISM",
           .keeps = kFirstAttribute | kBoundaryTypes,
           .is_grid = true,
           .write = [](const Mesh& mesh, const std::string& path,
                       const WriteOptions& options) { write_fort14(mesh, path, options, false); },
           .parse = parse_fort14},
          {.extensions = {".node", ".ele", ".poly", ".edge", ".neigh"},
           .remark = "each writes all of Triangle's files",
           .keeps = kDomainParts,
           .write = [](const Mesh& mesh, const std::string& path,
                       const WriteOptions& options) { write_triangle_format(mesh, stem_of(path), options.holes); },
           .read = [](const std::string& path, const ReadOptions&) { return read_triangle_format(stem_of(path)); },
           .files = triangle_files}};
}

}  // namespace

std::span<const MeshFormat> mesh_formats() {
  static const std::vector<MeshFormat> formats = all_formats();
  return formats;
}

}  // namespace driftmesh
