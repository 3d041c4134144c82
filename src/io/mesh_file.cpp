#include "io/mesh_file.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "io/boundary_types.hpp"
#include "io/fort14_format.hpp"
#include "io/hdf5_format.hpp"
#include "io/mfem_format.hpp"
#include "io/msh_format.hpp"
#include "io/pvtu_format.hpp"
#include "io/su2_format.hpp"
#include "io/triangle_format.hpp"
#include "io/vtu_format.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

enum class Format { kTriangle, kVtu, kPvtu, kMsh, kHdf5, kSu2, kMfem, kMfemParts, kFort14 };

struct Extension {
  const char* text;
  Format format;
};

constexpr std::array<Extension, 15> kExtensions{{{".vtu", Format::kVtu},
                                                 {".pvtu", Format::kPvtu},
                                                 {".msh", Format::kMsh},
                                                 {".h5", Format::kHdf5},
                                                 {".su2", Format::kSu2},
                                                 {".mesh", Format::kMfem},
                                                 {".pmesh", Format::kMfemParts},
                                                 {".14", Format::kFort14},
                                                 {".grd", Format::kFort14},
                                                 {".gr3", Format::kFort14},
                                                 {".node", Format::kTriangle},
                                                 {".ele", Format::kTriangle},
                                                 {".poly", Format::kTriangle},
                                                 {".edge", Format::kTriangle},
                                                 {".neigh", Format::kTriangle}}};

bool is_read(Format format) {
  return format != Format::kMfem && format != Format::kMfemParts;
}

/// ".a, .b or .c"
template <class Wanted>
std::string list_of_extensions(const Wanted& wanted) {
  std::string list;
  std::size_t last = 0;
  for (const Extension& extension : kExtensions) {
    if (!wanted(extension.format)) continue;
    last = list.size();
    list += (list.empty() ? "" : ", ") + std::string(extension.text);
  }
  return list.replace(last, 1, " or");
}

/// Empty for another extension, or none.
std::optional<Format> format_called(const std::string& extension) {
  for (const Extension& known : kExtensions)
    if (extension == known.text) return known.format;
  return std::nullopt;
}

std::string extension_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

Format named_format(const std::string& path) {
  if (names_no_format(path)) return Format::kVtu;
  const std::string extension = extension_of(path);
  if (const auto format = format_called(extension)) return *format;
  throw InputError({path, 0}, extension.empty() ? "has no extension" : "has an unknown extension '" + extension + "'",
                   "a mesh file is " + mesh_files_written());
}

Format format_of(const std::string& path) {
  const Format format = named_format(path);
  if (is_standard_stream(path) && (format == Format::kTriangle || format == Format::kPvtu || format == Format::kHdf5 ||
                                   format == Format::kMfemParts))
    throw InputError({path, 0}, "means several files, but a standard stream is only one",
                     "use - with the extension of a single file, as in -.vtu, or name a file");
  return format;
}

/// Tells what the format has no place for of the types of boundaries.
void warn_of_lost_types(const Mesh& mesh, Format format, const std::string& path, const WriteOptions& options) {
  if (!options.warn || format == Format::kFort14) return;
  std::map<std::int32_t, std::size_t> lost = count_types(mesh);
  const bool has_names = format != Format::kTriangle && format != Format::kMfem;
  if (!lost.empty() && !has_names)
    options.warn(path + ": has no place for types of boundaries, of which markers remain: " + list_of_types(lost));
  std::erase_if(lost, [](const auto& count) { return !weir_columns(count.first); });
  if (!mesh.weirs.empty() && has_names)
    options.warn(path + ": has no place for the heights and coefficients of weirs: " + list_of_types(lost));
}

std::string without_extension(const std::string& path) {
  return std::filesystem::path(path).replace_extension().string();
}

}  // namespace

const std::string& mesh_files_read() {
  static const std::string list = list_of_extensions(is_read);
  return list;
}

const std::string& mesh_files_written() {
  static const std::string list = list_of_extensions([](Format) { return true; });
  return list;
}

void write_mesh(const Mesh& mesh, const std::string& path, const WriteOptions& options) {
  check_names(mesh.names, path);
  const Format format = format_of(path);
  warn_of_lost_types(mesh, format, path, options);
  switch (format) {
    case Format::kVtu:
      return write_vtu(mesh, path);
    case Format::kPvtu:
      throw InputError({path, 0}, "is for a mesh in pieces", "this mesh is in one piece; write a .vtu");
    case Format::kMsh:
      return write_msh(mesh, path, options.ascii);
    case Format::kHdf5:
      return write_hdf5(mesh, path);
    case Format::kSu2:
      return write_su2(mesh, path);
    case Format::kMfem:
      return write_mfem(mesh, path);
    case Format::kMfemParts:
      throw InputError({path, 0}, "is for a mesh on ranks", "this mesh is in one piece; write a .mesh");
    case Format::kFort14:
      return write_fort14(mesh, path, options);
    case Format::kTriangle:
      return write_triangle_format(mesh, without_extension(path), options.holes);
  }
}

Mesh read_mesh(const std::string& path, const ReadOptions& options) {
  switch (format_of(path)) {
    case Format::kVtu:
      return read_vtu(path);
    case Format::kPvtu:
      return read_pvtu(path, options);
    case Format::kMsh:
      return read_msh(path);
    case Format::kHdf5:
      return read_hdf5(path);
    case Format::kSu2:
      return read_su2(path);
    case Format::kMfem:
    case Format::kMfemParts:
      throw InputError({path, 0}, "is in a format that is written, but not read",
                       "keep the mesh in one of " + mesh_files_read());
    case Format::kFort14:
      return read_fort14(path);
    case Format::kTriangle:
      return read_triangle_format(without_extension(path));
  }
  return {};
}

bool is_mesh_file(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension != ".poly" && extension != ".node" && format_called(extension).has_value();
}

bool is_in_pieces(const std::string& path) {
  return format_of(path) == Format::kPvtu;
}

bool is_written_by_all(const std::string& path) {
  return is_in_pieces(path) || is_for_ranks(path) || format_of(path) == Format::kHdf5;
}

bool is_for_ranks(const std::string& path) {
  return format_of(path) == Format::kMfemParts;
}

std::vector<std::string> mesh_files(const std::string& path) {
  if (format_of(path) == Format::kHdf5) return {path, xdmf_path(path)};
  if (format_of(path) != Format::kTriangle) return {path};
  const std::string stem = without_extension(path);
  return {stem + ".node", stem + ".ele", stem + ".poly", stem + ".edge", stem + ".neigh"};
}

std::vector<std::string> files_to_read(const std::string& path, const ReadOptions& options) {
  if (format_of(path) == Format::kHdf5) return {path};
  std::vector<std::string> files = mesh_files(path);
  if (is_in_pieces(path))
    for (const std::string& piece : read_pvtu_header(path, options).pieces) files.push_back(piece);
  return files;
}

}  // namespace driftmesh
