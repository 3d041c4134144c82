#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/narrow.hpp"
#include "base/read_file.hpp"
#include "driftmesh/error.hpp"
#include "hdf5/hdf5_handle.hpp"
#include "hdf5/own_content.hpp"
#include "io/hdf5_format.hpp"
#include "io/read_checks.hpp"
#include "mesh/merge_pieces.hpp"
#include "pslg/names.hpp"

namespace driftmesh {
namespace {

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path)
      : path_(path),
        bytes_(std::filesystem::file_size(path)),
        file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (!file_.is_open()) fail("is not an HDF5 file, or is damaged", "was it written completely?");
  }

  Mesh read() {
    read_points();
    read_names_on_points();
    read_cells();
    read_data();
    for_each_name<std::int32_t>(
        "/tags/facets", [&](auto marker, const std::string& name) { add_marker_name(mesh_.names, marker, name); });
    for_each_name<double>("/tags/cells",
                          [&](auto region, const std::string& name) { add_region_name(mesh_.names, region, name); });
    return std::move(mesh_);
  }

  TriangleData read_triangle_data() const {
    const std::string on_cells = "/VTKHDF/CellData/";
    const std::uint64_t triangles = rows_of("/viz/topology/cells");
    const std::uint64_t cells = triangles + rows_of("/viz/topology/facets");
    TriangleData data;
    if (!has("/VTKHDF/CellData")) return data;
    for (const std::string& name : names_in("/VTKHDF/CellData")) {
      if (is_array_on_cells(name) || !fault_of_name(name).empty()) continue;
      const Array<double> table = array<double>(on_cells + name, cells, 0);
      for (std::size_t k = 0; k < table.columns; ++k) {
        std::vector<double> values;
        for (std::size_t t = 0; t < triangles; ++t) values.push_back(table.values[t * table.columns + k]);
        data.try_emplace(name_of_component(name, table.columns, k), std::move(values));
      }
    }
    return data;
  }

 private:
  template <class T>
  struct Array {
    std::vector<T> values;
    std::size_t columns = 1;
  };

  [[noreturn]] void fail(const std::string& what, const std::string& next = kDamaged) const {
    throw InputError({path_, 0}, what, next);
  }

  [[nodiscard]] bool has(const std::string& array) const {
    for (std::size_t end = array.find('/', 1);; end = array.find('/', end + 1)) {
      if (H5Lexists(file_.id(), array.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
      if (end == std::string::npos) return true;
    }
  }

  /// With any number of columns if `columns` is 0. An array of one dimension has one.
  template <class T>
  Array<T> array(const std::string& name, std::uint64_t rows, std::uint64_t columns) const {
    const Hdf5Handle set(has(name) ? H5Dopen(file_.id(), name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
    if (!set.is_open()) fail("has no array " + name, "driftmesh reads the .h5 files that it writes");
    const std::array<hsize_t, 2> extent = extent_of(set, name);
    if (extent[0] != rows || (columns != 0 && extent[1] != columns))
      fail("has an array " + name + " of " + std::to_string(extent[0]) + " x " + std::to_string(extent[1]) +
           " values, not " + std::to_string(rows) + " x " + (columns == 0 ? "any" : std::to_string(columns)));
    Array<T> result{std::vector<T>(extent[0] * extent[1]), extent[1]};
    if (!result.values.empty() &&
        H5Dread(set.id(), hdf5_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()) < 0)
      fail("has an array " + name + " that cannot be read");
    return result;
  }

  /// Rows and columns, for which there are bytes in the file.
  [[nodiscard]] std::array<hsize_t, 2> extent_of(const Hdf5Handle& set, const std::string& name) const {
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    std::array<hsize_t, 2> extent{0, 1};
    const int dimensions = H5Sget_simple_extent_ndims(space.id());
    const H5T_class_t kind = H5Tget_class(type.id());
    if (dimensions < 1 || dimensions > 2 || (kind != H5T_INTEGER && kind != H5T_FLOAT))
      fail("has an array " + name + " that is no table of numbers");
    H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
    const std::uint64_t most = bytes_ / H5Tget_size(type.id());
    const haddr_t place = H5Dget_offset(set.id());
    if (extent[0] == 0 || extent[1] == 0) return extent;
    if (place == HADDR_UNDEF)
      fail("has a compressed or chunked array " + name, "h5repack -l CONTI -f NONE FILE NEW.h5 changes that");
    if (extent[0] > most / extent[1] || place > bytes_ ||
        extent[0] * extent[1] * H5Tget_size(type.id()) > bytes_ - place)
      fail("ends before the array " + name + " does");
    return extent;
  }

  [[nodiscard]] std::uint64_t rows_of(const std::string& name) const {
    const Hdf5Handle set(has(name) ? H5Dopen(file_.id(), name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
    if (!set.is_open()) fail("has no array " + name, "driftmesh reads the .h5 files that it writes");
    return extent_of(set, name)[0];
  }

  void read_points() {
    const std::string name = "/geometry/vertices";
    const std::uint64_t rows = rows_of(name);
    (void)narrow<std::int32_t>(rows, "points");
    const Array<double> vertices = array<double>(name, rows, 2);
    mesh_.points.resize(rows);
    for (std::size_t v = 0; v < rows; ++v) mesh_.points[v] = {vertices.values[2 * v], vertices.values[2 * v + 1]};
  }

  void read_names_on_points() {
    std::map<std::int32_t, std::string> attributes;
    for_each_name<std::int32_t>("/geometry/vertices",
                                [&](auto number, std::string name) { attributes.emplace(number, std::move(name)); });
    for (const auto& [number, name] : attributes) {
      if (std::cmp_not_equal(number, mesh_.attribute_names.size()))
        fail("has names of attributes that are not numbered from 0 on");
      mesh_.attribute_names.push_back(name);
    }
    const Hdf5Handle geometry(H5Gopen(file_.id(), "/geometry", H5P_DEFAULT), H5Gclose);
    if (!geometry.is_open() || H5Aexists(geometry.id(), "coordinates") <= 0) return;
    const Hdf5Handle words(H5Aopen(geometry.id(), "coordinates", H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(words.id()), H5Tclose);
    const Hdf5Handle space(H5Aget_space(words.id()), H5Sclose);
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
        H5Sget_simple_extent_npoints(space.id()) != 1 || H5Tget_size(type.id()) > 1000)
      return;
    std::string text(H5Tget_size(type.id()), '\0');
    if (H5Aread(words.id(), type.id(), text.data()) < 0) return;
    text.resize(std::min(text.find('\0'), text.size()));  // without the padding
    if (fault_of_name(text).empty()) mesh_.coordinates = text;
  }

  /// A point that does not exist becomes one that check_read_mesh refuses.
  [[nodiscard]] static std::int32_t index(std::int64_t row) {
    return std::in_range<std::int32_t>(row) ? static_cast<std::int32_t>(row) : -1;
  }

  void read_cells() {
    const std::uint64_t triangles = rows_of("/viz/topology/cells");
    const std::uint64_t lines = rows_of("/viz/topology/facets");
    (void)narrow<std::int32_t>(triangles + lines, "cells");
    const Array<std::int64_t> cells = array<std::int64_t>("/viz/topology/cells", triangles, 3);
    for (std::size_t t = 0; t < triangles; ++t)
      mesh_.triangles.push_back(
          {index(cells.values[3 * t]), index(cells.values[3 * t + 1]), index(cells.values[3 * t + 2])});
    const Array<std::int64_t> facets = array<std::int64_t>("/viz/topology/facets", lines, 2);
    const Array<std::int32_t> markers = array<std::int32_t>("/tags/facets", lines, 1);
    for (std::size_t e = 0; e < lines; ++e)
      mesh_.edges.push_back({index(facets.values[2 * e]), index(facets.values[2 * e + 1]), markers.values[e]});
  }

  void read_data() {
    const std::string on_points = "/VTKHDF/PointData/", on_cells = "/VTKHDF/CellData/";
    const std::size_t points = mesh_.points.size();
    if (has(on_points + "marker")) mesh_.point_markers = array<std::int32_t>(on_points + "marker", points, 1).values;
    if (has(on_points + "global_number"))
      mesh_.numbers = array<std::int64_t>(on_points + "global_number", points, 1).values;
    const std::size_t width = mesh_.attribute_names.size();
    for (std::size_t k = 0; k < width; ++k) {
      const std::vector<double> values = array<double>(on_points + mesh_.attribute_names[k], points, 1).values;
      mesh_.attributes.resize(points * width);
      for (std::size_t v = 0; v < points; ++v) mesh_.attributes[v * width + k] = values[v];
    }
    mesh_.attributes_per_point = static_cast<std::int32_t>(width);
    if (width == 0 && has(on_points + "attribute")) {
      Array<double> attributes = array<double>(on_points + "attribute", points, 0);
      mesh_.attributes_per_point = narrow<std::int32_t>(attributes.columns, "attributes");
      mesh_.attributes = std::move(attributes.values);
    }
    of_triangles(on_cells + "region", mesh_.regions);
    of_triangles(on_cells + "subdomain", mesh_.subdomains);
    of_triangles(on_cells + "rank", mesh_.ranks);
  }

  /// The values on lines, which come last, say nothing new.
  template <class T>
  void of_triangles(const std::string& name, std::vector<T>& values) const {
    if (!has(name)) return;
    values = array<T>(name, mesh_.triangles.size() + mesh_.edges.size(), 1).values;
    values.resize(mesh_.triangles.size());
  }

  /// The names of what is in a group, sorted.
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const {
    const Hdf5Handle opened(H5Gopen(file_.id(), group.c_str(), H5P_DEFAULT), H5Gclose);
    H5G_info_t info{};
    if (!opened.is_open() || H5Gget_info(opened.id(), &info) < 0) fail("has no group " + group);
    std::vector<std::string> names;
    for (hsize_t k = 0; k < info.nlinks; ++k) {
      const auto name_at = [&](char* text, std::size_t size) {
        return H5Lget_name_by_idx(opened.id(), ".", H5_INDEX_NAME, H5_ITER_INC, k, text, size, H5P_DEFAULT);
      };
      std::string name(static_cast<std::size_t>(std::max<ssize_t>(0, name_at(nullptr, 0))), '\0');
      name_at(name.data(), name.size() + 1);
      names.push_back(std::move(name));
    }
    return names;
  }

  static std::string name_of(const Hdf5Handle& attribute) {
    std::string name(static_cast<std::size_t>(std::max<ssize_t>(0, H5Aget_name(attribute.id(), 0, nullptr))), '\0');
    H5Aget_name(attribute.id(), name.size() + 1, name.data());
    return name;
  }

  /// Calls visit(value, name) for each attribute of an array that is one number.
  template <class Value, class Visit>
  void for_each_name(const std::string& array, const Visit& visit) const {
    if (!has(array)) return;
    const Hdf5Handle set(H5Dopen(file_.id(), array.c_str(), H5P_DEFAULT), H5Dclose);
    const int count = H5Aget_num_attrs(set.id());
    for (int k = 0; k < count; ++k) {
      const Hdf5Handle attribute(
          H5Aopen_by_idx(set.id(), ".", H5_INDEX_NAME, H5_ITER_INC, static_cast<hsize_t>(k), H5P_DEFAULT, H5P_DEFAULT),
          H5Aclose);
      const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
      const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
      const H5T_class_t kind = H5Tget_class(type.id());
      Value value{};
      if ((kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Sget_simple_extent_npoints(space.id()) == 1 &&
          H5Aread(attribute.id(), hdf5_type<Value>(), &value) >= 0)
        visit(value, name_of(attribute));
    }
  }

  const std::string& path_;
  std::uint64_t bytes_;
  Hdf5Handle file_;
  Mesh mesh_;
};

/// In the order of the numbers, where ranks wrote the file.
Mesh in_order(Mesh mesh, const std::string& path) {
  if (mesh.numbers.empty()) return mesh;
  MergeFaults faults;
  try {
    const std::array<const Mesh*, 1> one{&mesh};
    mesh = merge_pieces(one, faults);
  } catch (const Error& error) {
    throw InputError({path, 0}, error.what(), kDamaged);
  }
  if (faults.count != 0) throw InputError({path, 0}, faults.first[0], kDamaged);
  return mesh;
}

/// `data`: those at triangles are put there, unless null.
Mesh read_mesh_and_data(const std::string& path, TriangleData* data) {
  const QuietHdf5 quiet;
  if (!std::filesystem::is_regular_file(path)) (void)read_file(path);  // says why not
  require_own_content(path);
  Hdf5Reader file(path);
  Mesh mesh = file.read();
  check_read_mesh(mesh, path);
  if (data != nullptr && mesh.numbers.empty()) *data = file.read_triangle_data();
  return in_order(std::move(mesh), path);
}

}  // namespace

Mesh read_hdf5(const std::string& path) {
  return read_mesh_and_data(path, nullptr);
}

Mesh read_hdf5(const std::string& path, TriangleData& data) {
  return read_mesh_and_data(path, &data);
}

}  // namespace driftmesh
