#include "io/mesh_file.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <utility>

#include "base/file_bytes.hpp"
#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "io/other_coordinates.hpp"
#include "io/short_openings.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

constexpr const char* kFormatOfStreams = ".vtu";

/// "a, b or c"
template <class Items>
std::string one_of(const Items& items) {
  std::string list;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) list += i + 1 < items.size() ? ", " : " or ";
    list += items[i];
  }
  return list;
}

template <class Wanted>
std::string list_of_extensions(const Wanted& wanted) {
  std::vector<std::string_view> list;
  for (const MeshFormat& format : mesh_formats())
    if (wanted(format)) list.insert(list.end(), format.extensions.begin(), format.extensions.end());
  return one_of(list);
}

/// The format whose extension the path ends in, the longer one where two would do (.medit.mesh); null if there is none.
const MeshFormat* format_named_by(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  const MeshFormat* found = nullptr;
  std::size_t length = 0;
  for (const MeshFormat& format : mesh_formats())
    for (const std::string_view extension : format.extensions)
      if (name.ends_with(extension) && name.size() > extension.size() && extension.size() > length)
        found = &format, length = extension.size();
  return found;
}

}  // namespace

const MeshFormat& format_of(const std::string& path) {
  if (path.empty())
    throw InputError({"a mesh file"}, "its name is empty",
                     "give it one with the extension of a format: " + mesh_files_written());
  const MeshFormat* const format = format_named_by(names_no_format(path) ? path + kFormatOfStreams : path);
  const std::string extension = std::filesystem::path(path).extension().string();
  if (format == nullptr)
    throw InputError({path, 0}, extension.empty() ? "has no extension" : "has an unknown extension '" + extension + "'",
                     "a mesh file is " + mesh_files_written());
  if (is_standard_stream(path) && format->files != nullptr)
    throw InputError({path, 0}, "means several files, but a standard stream is only one",
                     "use - with the extension of a single file, as in -.vtu, or name a file");
  return *format;
}

const std::string& mesh_files_read() {
  static const std::string list = list_of_extensions(std::mem_fn(&MeshFormat::is_read));
  return list;
}

const std::string& mesh_files_written() {
  static const std::string list = list_of_extensions([](const MeshFormat&) { return true; });
  return list;
}

const std::string& whole_mesh_files_written() {
  static const std::string list = list_of_extensions([](const MeshFormat& format) { return format.write != nullptr; });
  return list;
}

std::string mesh_files_with(bool MeshFormat::*something) {
  return list_of_extensions(std::mem_fn(something));
}

const std::string& mesh_files_described() {
  static const std::string list = [] {
    std::vector<std::string> formats;
    for (const MeshFormat& format : mesh_formats())
      formats.push_back(one_of(format.extensions) +
                        (format.remark.empty() ? "" : " (" + std::string(format.remark) + ")"));
    return one_of(formats);
  }();
  return list;
}

void require_whole(const std::string& path) {
  const MeshFormat& format = format_of(path);
  if (format.write == nullptr)
    throw InputError({path, 0}, "is for a mesh in pieces as it is made, and this one is whole",
                     "write a " + std::string(format.whole));
}

namespace {

void check_attribute_names(const Mesh& mesh, const std::string& path) {
  for (const std::string& name : mesh.attribute_names)
    if (const std::string fault =
            is_array_on_points(name) ? "is that of something else on points" : fault_of_name(name);
        !fault.empty())
      throw InputError({path, 0}, "the name '" + name + "' of an attribute " + fault, "choose another");
  if (!mesh.attribute_names.empty() && std::cmp_not_equal(mesh.attribute_names.size(), mesh.attributes_per_point))
    throw InputError({path, 0}, "has other numbers of attributes and of names for them", "name all of them, or none");
}

void check_triangle_names(const TriangleData& data, const std::string& path) {
  for (const auto& [name, values] : data)
    if (const std::string fault =
            is_array_on_cells(name) ? "is that of something else at triangles" : fault_of_name(name);
        !fault.empty())
      throw InputError({path, 0}, "the name '" + name + "' of data at triangles " + fault, "choose another");
}

/// In the coordinates of the file.
void write_as_is(const Mesh& mesh, const TriangleData& data, const std::string& path, const WriteOptions& options) {
  const MeshFormat& format = format_of(path);
  if (format.write_with_data != nullptr && !data.empty())
    format.write_with_data(mesh, data, path, options);
  else
    format.write(mesh, path, options);
}

/// `coordinates`: those of the file, empty for those of the mesh.
void write_changed(Mesh mesh, const TriangleData& data, const std::string& coordinates, const std::string& path,
                   const WriteOptions& options) {
  if (format_of(path).is_grid && options.open_from > 0) close_short_openings(mesh, options);
  Mesh holes;
  holes.points = options.holes;
  holes.coordinates = mesh.coordinates;
  change_coordinates(mesh, coordinates, path);
  change_coordinates(holes, coordinates, path);
  WriteOptions moved = options;
  moved.holes = std::move(holes.points);
  write_as_is(mesh, data, path, moved);
}

}  // namespace

void write_mesh(const Mesh& mesh, const TriangleData& data, const std::string& path, const WriteOptions& options) {
  check_names(mesh.names, path);
  check_attribute_names(mesh, path);
  check_triangle_names(data, path);
  require_whole(path);
  const MeshFormat& format = format_of(path);
  const std::string wanted = coordinates_wanted(mesh, path, options);
  if (!wanted.empty() || (format.is_grid && options.open_from > 0))
    write_changed(mesh, data, wanted, path, options);
  else
    write_as_is(mesh, data, path, options);
  if (!options.warn) return;
  if (const std::string lost = lost_parts(mesh, format.keeps); !lost.empty())
    options.warn(path + ": has no place for " + lost);
  if (format.write_with_data == nullptr && !data.empty()) options.warn(path + ": has no place for data at triangles");
}

void write_mesh(const Mesh& mesh, const std::string& path, const WriteOptions& options) {
  write_mesh(mesh, {}, path, options);
}

namespace {

[[noreturn]] void refuse_to_read(const std::string& path) {
  throw InputError({path, 0}, "is in a format that is written, but not read",
                   "keep the mesh in one of " + mesh_files_read());
}

/// `data`: those at triangles are put there, unless null.
Mesh read(const std::string& path, const ReadOptions& options, TriangleData* data) {
  const MeshFormat& format = format_of(path);
  Mesh mesh;
  if (data != nullptr && format.read_with_data != nullptr) {
    mesh = format.read_with_data(path, options, *data);
  } else if (format.read != nullptr) {
    mesh = format.read(path, options);
  } else if (format.parse != nullptr) {
    const FileBytes bytes(path, format.begins);
    mesh = data != nullptr && format.parse_with_data != nullptr ? format.parse_with_data(path, bytes.view(), *data)
                                                                : format.parse(path, bytes.view());
  } else {
    refuse_to_read(path);
  }
  return_to_plane(mesh, path);
  return mesh;
}

}  // namespace

Mesh read_mesh(const std::string& path, const ReadOptions& options) {
  return read(path, options, nullptr);
}

Mesh read_mesh(const std::string& path, const ReadOptions& options, TriangleData& data) {
  return read(path, options, &data);
}

bool is_mesh_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension != ".poly" && extension != ".node" && format_named_by(path) != nullptr;
}

bool is_in_pieces(const std::string& path) {
  return format_of(path).in_pieces == PieceWriters::kThreadsAndRanks;
}

bool is_for_ranks(const std::string& path) {
  return format_of(path).in_pieces == PieceWriters::kRanks;
}

std::vector<std::string> mesh_files(const std::string& path, std::int32_t pieces) {
  const MeshFormat& format = format_of(path);
  return format.files == nullptr ? std::vector<std::string>{path} : format.files(path, pieces);
}

std::vector<std::string> files_to_read(const std::string& path, const ReadOptions& options) {
  const MeshFormat& format = format_of(path);
  return format.files_read == nullptr ? mesh_files(path) : format.files_read(path, options);
}

}  // namespace driftmesh
