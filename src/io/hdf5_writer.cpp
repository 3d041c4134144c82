#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <initializer_list>
#include <map>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include "base/atomic_file.hpp"
#include "base/write_at.hpp"
#include "base/write_behind.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "hdf5/hdf5_handle.hpp"
#include "io/hdf5_format.hpp"
#include "io/msh_groups.hpp"
#include "io/vtu_format.hpp"
#include "mesh/mesh_edges.hpp"

namespace driftmesh {
namespace {

constexpr hsize_t kPage = 4096;  // VTK begins an array on a page of its own

/// Makes the groups and arrays of a file, and writes what is small.
class Hdf5Maker {
 public:
  Hdf5Maker(const std::string& file, const std::string& path, const Hdf5Shape& shape)
      : path_(path), shape_(shape), file_(create(file), H5Fclose), places_made_(H5Pcreate(H5P_LINK_CREATE), H5Pclose) {
    check(file_.is_open());
    H5Pset_create_intermediate_group(places_made_.id(), 1);
  }

  Hdf5Places make() {
    make_grid();
    make_point_data();
    make_cell_data();
    make_topology();
    check(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) >= 0);
    return std::move(places_);
  }

 private:
  void check(bool done) const {
    if (!done) throw FileError(path_, "cannot write");
  }

  static hid_t create(const std::string& file) {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_alignment(access.id(), kPage, kPage);
    errno = 0;
    return H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id());
  }

  void make_grid() {
    const Hdf5Handle group(H5Gcreate(file_.id(), "/VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    check(group.is_open());
    const std::array<std::int64_t, 2> version{1, 0};
    const Hdf5Handle two(space({2}));
    const Hdf5Handle attribute(
        H5Acreate(group.id(), "Version", hdf5_type<std::int64_t>(), two.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(H5Awrite(attribute.id(), H5T_NATIVE_INT64, version.data()) >= 0);
    name(group, "Type", "UnstructuredGrid");
    const std::uint64_t corners = 3 * shape_.triangles + 2 * shape_.lines;
    number("/VTKHDF/NumberOfPoints", shape_.points);
    number("/VTKHDF/NumberOfCells", cells());
    number("/VTKHDF/NumberOfConnectivityIds", corners);
    array<double>("/VTKHDF/Points", {shape_.points, 3});
    array<std::int64_t>("/VTKHDF/Connectivity", {corners});
    array<std::int64_t>("/VTKHDF/Offsets", {cells() + 1});
    array<std::uint8_t>("/VTKHDF/Types", {cells()});
  }

  void make_point_data() {
    const Hdf5Handle group(H5Gcreate(file_.id(), "/VTKHDF/PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    check(group.is_open());
    if (shape_.arrays.numbers) name(group, "GlobalIds", "global_number");
    for_each_point_array(shape_.arrays, [&]<class T>(const T*, const std::string& called, std::int32_t components) {
      std::vector<hsize_t> extent{shape_.points};
      if (components > 1) extent.push_back(static_cast<hsize_t>(components));
      array<T>("/VTKHDF/PointData/" + called, extent);
    });
  }

  void make_cell_data() {
    const Hdf5Handle group(H5Gcreate(file_.id(), "/VTKHDF/CellData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    check(group.is_open());
    for_each_cell_array(shape_.arrays, [&]<class T>(const T*, const char* called) {
      array<T>(std::string("/VTKHDF/CellData/") + called, {cells()});
    });
    for (const std::string& called : shape_.data_names) array<double>("/VTKHDF/CellData/" + called, {cells()});
  }

  void make_topology() {
    array<double>("/geometry/vertices", {shape_.points, 2});
    array<std::int64_t>("/viz/topology/cells", {shape_.triangles, 3});
    array<std::int64_t>("/viz/topology/facets", {shape_.lines, 2});
    array<std::int32_t>("/tags/cells", {shape_.triangles});
    array<std::int32_t>("/tags/facets", {shape_.lines});
    name_values("/tags/cells", shape_.names.regions);
    name_values("/tags/facets", shape_.names.markers);
    std::map<std::int32_t, std::string> attributes;
    for (const std::string& name : shape_.arrays.attribute_names) attributes.emplace(attributes.size(), name);
    name_values("/geometry/vertices", attributes);
    if (shape_.coordinates.empty()) return;
    const Hdf5Handle geometry(H5Gopen(file_.id(), "/geometry", H5P_DEFAULT), H5Gclose);
    name(geometry, "coordinates", shape_.coordinates);
  }

  [[nodiscard]] std::uint64_t cells() const { return shape_.triangles + shape_.lines; }

  static Hdf5Handle space(const std::vector<hsize_t>& extent) {
    return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose};
  }

  void name(const Hdf5Handle& group, const char* called, std::string_view value) const {
    const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text.id(), value.size());
    H5Tset_strpad(text.id(), H5T_STR_NULLPAD);
    const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate(group.id(), called, text.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(H5Awrite(attribute.id(), text.id(), value.data()) >= 0);
  }

  /// Attributes of an array that are called as its values are.
  template <class Value>
  void name_values(const char* array, const std::map<Value, std::string>& names) const {
    const Hdf5Handle set(H5Dopen(file_.id(), array, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle how(H5Pcreate(H5P_ATTRIBUTE_CREATE), H5Pclose);
    H5Pset_char_encoding(how.id(), H5T_CSET_UTF8);
    const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
    for (const auto& [value, called] : names) {
      const Hdf5Handle attribute(
          H5Acreate(set.id(), called.c_str(), hdf5_type<Value>(), one.id(), how.id(), H5P_DEFAULT), H5Aclose);
      check(H5Awrite(attribute.id(), hdf5_type<Value>(), &value) >= 0);
    }
  }

  void number(const char* called, std::uint64_t value) const {
    const Hdf5Handle one(space({1}));
    const Hdf5Handle set(
        H5Dcreate(file_.id(), called, hdf5_type<std::int64_t>(), one.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    check(H5Dwrite(set.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0);
  }

  template <class T>
  void array(const std::string& called, const std::vector<hsize_t>& extent) {
    const Hdf5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_alloc_time(how.id(), H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(how.id(), H5D_FILL_TIME_NEVER);
    const Hdf5Handle rows(space(extent));
    const Hdf5Handle set(
        H5Dcreate(file_.id(), called.c_str(), hdf5_type<T>(), rows.id(), places_made_.id(), how.id(), H5P_DEFAULT),
        H5Dclose);
    check(set.is_open());
    if (const haddr_t place = H5Dget_offset(set.id()); place != HADDR_UNDEF) places_[called] = place;
  }

  const std::string& path_;
  const Hdf5Shape& shape_;
  Hdf5Handle file_;
  Hdf5Handle places_made_;  // groups on the way to an array are made with it
  Hdf5Places places_;
};

/// Writes rows of arrays, by blocks.
class RowWriter {
 public:
  RowWriter(const std::string& file, const std::string& path, const Hdf5Places& places)
      : path_(path), places_(places), file_(::open(file.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (file_ < 0) throw FileError(path_, "cannot write");
  }
  ~RowWriter() {
    if (file_ >= 0) ::close(file_);
  }
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;

  /// `count` rows from `first` on; fill(i, row) sets the columns of the i-th of them.
  template <class T, class Fill>
  void rows(const std::string& array, std::size_t columns, std::uint64_t first, std::size_t count, const Fill& fill) {
    rows<T>({array}, columns, first, count, fill);
  }

  /// The same rows of several arrays.
  template <class T, class Fill>
  void rows(std::initializer_list<std::string> arrays, std::size_t columns, std::uint64_t first, std::size_t count,
            const Fill& fill) {
    if (count == 0) return;
    std::vector<Place> places;
    for (const std::string& array : arrays) places.push_back({places_.at(array) + first * columns * sizeof(T), {}});
    std::vector<T> block;
    const std::size_t in_block = std::min(count, std::max<std::size_t>(1, kBytes / sizeof(T) / columns));
    block.resize(in_block * columns);
    for (std::size_t begin = 0; begin < count; begin += in_block) {
      const std::size_t now = std::min(in_block, count - begin);
      for (std::size_t i = 0; i < now; ++i) fill(begin + i, block.data() + i * columns);
      for (Place& place : places) write(std::as_bytes(std::span(block).first(now * columns)), place);
    }
  }

  void close() {
    if (::close(std::exchange(file_, -1)) != 0) throw FileError(path_, "cannot write");
  }

 private:
  static constexpr std::size_t kBytes = std::size_t{1} << 20;

  /// Where the next rows of an array go.
  struct Place {
    std::uint64_t next;
    WriteBehind behind;
  };

  void write(std::span<const std::byte> bytes, Place& place) const {
    write_at(file_, place.next, bytes, path_);
    place.behind.wrote(file_, place.next, bytes.size());
    place.next += bytes.size();
  }

  const std::string& path_;
  const Hdf5Places& places_;
  int file_;
};

/// The part of one process, array by array.
class Hdf5PartWriter {
 public:
  Hdf5PartWriter(RowWriter& out, const Hdf5Shape& shape, const Hdf5Part& part)
      : out_(out), shape_(shape), part_(part), mesh_(part.mesh) {}

  void write() {
    write_points();
    write_cells();
    write_cell_data();
    write_tags();
  }

 private:
  template <class T, class Fill>
  void points(const std::string& array, std::size_t columns, const Fill& fill) {
    out_.rows<T>(array, columns, part_.first_point, part_.points.size(),
                 [&](std::size_t i, T* row) { fill(to_index(part_.points[i]), row); });
  }
  template <class T, class Fill>
  void triangles(const std::string& array, std::size_t columns, const Fill& fill) {
    out_.rows<T>(array, columns, part_.first_triangle, mesh_.triangles.size(), fill);
  }
  /// `before`: rows of the array that are not of lines.
  template <class T, class Fill>
  void lines(const std::string& array, std::size_t columns, std::uint64_t before, const Fill& fill) {
    out_.rows<T>(array, columns, before + part_.first_line, part_.lines.size(),
                 [&](std::size_t i, T* row) { fill(to_index(part_.lines[i]), row); });
  }

  void write_points() {
    points<double>("/geometry/vertices", 2, [&](std::size_t v, double* row) {
      row[0] = mesh_.points[v].x;
      row[1] = mesh_.points[v].y;
    });
    points<double>("/VTKHDF/Points", 3, [&](std::size_t v, double* row) {
      row[0] = mesh_.points[v].x;
      row[1] = mesh_.points[v].y;
      row[2] = 0;
    });
    const std::string data = "/VTKHDF/PointData/";
    const VtuArrays& arrays = shape_.arrays;
    if (arrays.point_markers)
      points<std::int32_t>(data + "marker", 1, [&](auto v, auto* row) { *row = mesh_.point_markers[v]; });
    if (arrays.numbers)
      points<std::int64_t>(data + "global_number", 1, [&](auto v, auto* row) { *row = mesh_.numbers[v]; });
    const auto k = static_cast<std::size_t>(arrays.attributes);
    if (k > 0 && arrays.attribute_names.empty())
      points<double>(data + "attribute", k, [&](auto v, auto* row) {
        std::copy_n(mesh_.attributes.begin() + static_cast<std::ptrdiff_t>(v * k), k, row);
      });
    for (std::size_t i = 0; i < arrays.attribute_names.size(); ++i)
      points<double>(data + arrays.attribute_names[i], 1,
                     [&](auto v, auto* row) { *row = mesh_.attributes[v * k + i]; });
  }

  void corners_of_triangle(std::size_t t, std::int64_t* row) const {
    for (std::size_t i = 0; i < 3; ++i) row[i] = part_.row[mesh_.triangles[t][i]];
  }
  void ends_of_line(std::size_t e, std::int64_t* row) const {
    row[0] = part_.row[mesh_.edges[e].a];
    row[1] = part_.row[mesh_.edges[e].b];
  }

  void write_cells() {
    const auto corners = [&](auto t, auto* row) { corners_of_triangle(t, row); };
    const auto ends = [&](auto e, auto* row) { ends_of_line(e, row); };
    // For VTK triangles begin an array without rows, which is the same as one with rows of three; lines follow.
    const std::string one_after_the_other = "/VTKHDF/Connectivity";
    out_.rows<std::int64_t>({"/viz/topology/cells", one_after_the_other}, 3, part_.first_triangle,
                            mesh_.triangles.size(), corners);
    lines<std::int64_t>("/viz/topology/facets", 2, 0, ends);
    out_.rows<std::int64_t>(one_after_the_other, 1, 3 * shape_.triangles + 2 * part_.first_line, 2 * part_.lines.size(),
                            [&](auto i, auto* row) {
                              const Mesh::Edge& edge = mesh_.edges[part_.lines[i / 2]];
                              *row = part_.row[i % 2 == 0 ? edge.a : edge.b];
                            });
    out_.rows<std::int64_t>("/VTKHDF/Offsets", 1, 0, 1, [](auto, auto* row) { *row = 0; });  // whoever is last
    out_.rows<std::int64_t>(
        "/VTKHDF/Offsets", 1, part_.first_triangle + 1, mesh_.triangles.size(),
        [&](auto i, auto* row) { *row = static_cast<std::int64_t>(3 * (part_.first_triangle + i + 1)); });
    out_.rows<std::int64_t>("/VTKHDF/Offsets", 1, shape_.triangles + part_.first_line + 1, part_.lines.size(),
                            [&](auto i, auto* row) {
                              *row = static_cast<std::int64_t>(3 * shape_.triangles + 2 * (part_.first_line + i + 1));
                            });
    triangles<std::uint8_t>("/VTKHDF/Types", 1, [](auto, auto* row) { *row = kVtkTriangle; });
    lines<std::uint8_t>("/VTKHDF/Types", 1, shape_.triangles, [](auto, auto* row) { *row = kVtkLine; });
  }

  void write_cell_data() {
    const VtuArrays& arrays = shape_.arrays;
    const std::string data = "/VTKHDF/CellData/";
    if (arrays.cell_markers) {
      triangles<std::int32_t>(data + "marker", 1, [](auto, auto* row) { *row = 0; });
      lines<std::int32_t>(data + "marker", 1, shape_.triangles,
                          [&](auto e, auto* row) { *row = mesh_.edges[e].marker; });
    }
    if (!arrays.regions && !arrays.subdomains && !arrays.ranks && part_.data == nullptr) return;
    const auto at_edges = triangles_at_edges(mesh_, ConstrainedEdgeIndex(mesh_));
    const auto write = [&]<class T>(const std::string& name, const std::vector<T>& of_triangles) {
      triangles<T>(data + name, 1, [&](auto t, auto* row) { *row = of_triangles[t]; });
      lines<T>(data + name, 1, shape_.triangles, [&](auto e, auto* row) {
        const std::int32_t triangle = at_edges[e][0] >= 0 ? at_edges[e][0] : at_edges[e][1];
        *row = triangle >= 0 ? of_triangles[triangle] : T{0};
      });
    };
    if (arrays.regions) write("region", mesh_.regions);
    if (arrays.subdomains) write("subdomain", mesh_.subdomains);
    if (arrays.ranks) write("rank", mesh_.ranks);
    if (part_.data != nullptr)
      for (const auto& [name, values] : *part_.data) write(name, values);
  }

  void write_tags() {
    triangles<std::int32_t>("/tags/cells", 1, [&](auto t, auto* row) {
      *row = shape_.arrays.regions ? part_.tags.at(mesh_.regions[t]) : 1;
    });
    lines<std::int32_t>("/tags/facets", 1, 0, [&](auto e, auto* row) { *row = mesh_.edges[e].marker; });
  }

  RowWriter& out_;
  const Hdf5Shape& shape_;
  const Hdf5Part& part_;
  const Mesh& mesh_;
};

template <class Integer>
std::vector<Integer> numbered(std::size_t count) {
  std::vector<Integer> all(count);
  std::iota(all.begin(), all.end(), Integer{0});
  return all;
}

}  // namespace

Hdf5Places create_hdf5(const std::string& file, const std::string& path, const Hdf5Shape& shape) {
  const QuietHdf5 quiet;
  return Hdf5Maker(file, path, shape).make();
}

void write_hdf5_part(const std::string& file, const std::string& path, const Hdf5Shape& shape, const Hdf5Places& places,
                     const Hdf5Part& part) {
  RowWriter out(file, path, places);
  Hdf5PartWriter(out, shape, part).write();
  out.close();
}

void write_hdf5(const Mesh& mesh, const TriangleData& data, const std::string& path) {
  AtomicFile file(path);
  const std::string& name = file.name_meanwhile();
  Hdf5Shape shape{mesh.points.size(), mesh.triangles.size(), mesh.edges.size(), arrays_of(mesh),
                  mesh.names,         mesh.coordinates};
  for (const auto& named : data) shape.data_names.push_back(named.first);
  const Hdf5Part part{.mesh = mesh,
                      .points = numbered<std::int32_t>(mesh.points.size()),
                      .lines = numbered<std::int32_t>(mesh.edges.size()),
                      .row = numbered<std::int64_t>(mesh.points.size()),
                      .tags = tags_of_values({mesh.regions.begin(), mesh.regions.end()}),
                      .data = data.empty() ? nullptr : &data};
  const Hdf5Places places = create_hdf5(name, path, shape);
  write_hdf5_part(name, path, shape, places, part);
  file.commit();
  write_xdmf(path, shape);
}

}  // namespace driftmesh
