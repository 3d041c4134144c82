#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <sstream>

#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "support/damage.hpp"
#include "support/error_text.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;
using namespace driftmesh::test;

namespace {

// An independent reader of VTU, line by line: the raw bytes of each array by "section/name".
class VtuOracle {
 public:
  explicit VtuOracle(const std::string& path) : bytes_(file_bytes(path)) {
    const std::size_t appended = bytes_.find("<AppendedData encoding=\"raw\">");
    REQUIRE(appended != std::string::npos);
    begin_ = bytes_.find('_', appended) + 1;
    header = bytes_.substr(0, begin_);
    std::string section;
    std::uint64_t expected_offset = 0;
    std::istringstream lines(header);
    for (std::string line; std::getline(lines, line);) {
      line.erase(0, line.find_first_not_of(' '));
      for (const char* name : {"PointData", "CellData", "Points", "Cells"})
        if (line == std::string("<").append(name).append(">")) section = name;
      if (!line.starts_with("<DataArray ")) continue;
      CHECK(value_of(line, "format") == "appended");
      const std::uint64_t offset = std::stoull(value_of(line, "offset"));
      CHECK(offset == expected_offset);
      const std::string name = section + "/" + value_of(line, "Name");
      types[name] = value_of(line, "type");
      arrays[name] = array_at(offset);
      expected_offset = offset + 8 + arrays[name].size();
    }
    CHECK(bytes_.substr(begin_ + expected_offset) == "\n  </AppendedData>\n</VTKFile>\n");
  }

  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::string& data = arrays.at(name);
    REQUIRE(data.size() % sizeof(T) == 0);
    std::vector<T> result(data.size() / sizeof(T));
    if (!data.empty()) std::memcpy(result.data(), data.data(), data.size());
    return result;
  }

  std::string header;
  std::map<std::string, std::string> arrays;
  std::map<std::string, std::string> types;

 private:
  static std::string value_of(const std::string& line, const std::string& key) {
    const std::size_t begin = line.find(std::string(" ").append(key).append("=\""));
    REQUIRE(begin != std::string::npos);
    const std::size_t value = begin + key.size() + 3;
    return line.substr(value, line.find('"', value) - value);
  }

  std::string array_at(std::uint64_t offset) const {
    std::uint64_t length = 0;
    REQUIRE(begin_ + offset + 8 <= bytes_.size());
    std::memcpy(&length, bytes_.data() + begin_ + offset, 8);
    REQUIRE(begin_ + offset + 8 + length <= bytes_.size());
    return bytes_.substr(begin_ + offset + 8, length);
  }

  std::string bytes_;
  std::size_t begin_ = 0;
};

std::string message_of(const std::string& path) {
  return error_text<InputError>([&] { (void)read_mesh(path); });
}

}  // namespace

TEST_CASE("a .vtu has the arrays that VTK expects at the offsets in its header") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  const RandomMesh random(17, 6, 5);
  const Mesh& mesh = random.mesh();
  REQUIRE(mesh.edges.size() > 20);
  write_mesh(mesh, path);
  const VtuOracle file(path);
  const std::size_t triangles = mesh.triangles.size();
  const std::size_t cells = triangles + mesh.edges.size();

  CHECK(file.header.find("header_type=\"UInt64\"") != std::string::npos);
  CHECK(file.header.find("NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
                         std::to_string(cells) + "\"") != std::string::npos);
  const std::map<std::string, std::string> expected_types = {
      {"PointData/marker", "Int32"}, {"PointData/attribute", "Float64"},
      {"CellData/marker", "Int32"},  {"CellData/region", "Float64"},
      {"Points/Points", "Float64"},  {"Cells/connectivity", "Int32"},
      {"Cells/offsets", "Int32"},    {"Cells/types", "UInt8"}};
  CHECK(file.types == expected_types);

  const auto xyz = file.values<double>("Points/Points");
  REQUIRE(xyz.size() == 3 * mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    CHECK(Point{xyz[3 * v], xyz[3 * v + 1]} == mesh.points[v]);
    CHECK(xyz[3 * v + 2] == 0);
  }
  const auto corners = file.values<std::int32_t>("Cells/connectivity");
  const auto offsets = file.values<std::int32_t>("Cells/offsets");
  const auto types = file.values<std::uint8_t>("Cells/types");
  const auto markers = file.values<std::int32_t>("CellData/marker");
  const auto regions = file.values<double>("CellData/region");
  REQUIRE(offsets.size() == cells);
  REQUIRE(types.size() == cells);
  REQUIRE(markers.size() == cells);
  REQUIRE(regions.size() == cells);
  REQUIRE(offsets.back() == static_cast<std::int32_t>(corners.size()));
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const bool is_line = cell >= triangles;
    const auto end = offsets[cell];
    CHECK(types[cell] == (is_line ? 3 : 5));
    if (is_line) {
      const Mesh::Edge& edge = mesh.edges[cell - triangles];
      CHECK(Mesh::Edge{corners[end - 2], corners[end - 1], markers[cell]} == edge);
      CHECK((regions[cell] == 7 || regions[cell] == -1.25));
    } else {
      CHECK(std::array{corners[end - 3], corners[end - 2], corners[end - 1]} == mesh.triangles[cell]);
      CHECK(markers[cell] == 0);
      CHECK(regions[cell] == mesh.regions[cell]);
    }
  }
}

TEST_CASE("a piece keeps the numbers of its points in .vtu") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "piece.vtu";
  Mesh mesh = RandomMesh(9, 4, 3).mesh();
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.numbers.push_back((std::int64_t{1} << 40) - 3 * static_cast<std::int64_t>(v));
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
}

TEST_CASE("a .vtu of an encoding that is not read is refused with what to do") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  write_mesh(RandomMesh(5, 2, 2).mesh(), path);
  const std::string whole = file_bytes(path);
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string changed = whole;
    const std::size_t at = changed.find(from);
    REQUIRE(at != std::string::npos);
    replace_file(path, changed.replace(at, from.size(), to));
    return message_of(path);
  };
  CHECK(refused("encoding=\"raw\"", "encoding=\"octal\"").find("'octal'; save it as") != std::string::npos);
  CHECK(refused("format=\"appended\"", "format=\"elsewhere\"").find("'elsewhere'; save it as") != std::string::npos);
  CHECK(refused("header_type", "compressor=\"vtkLZ4DataCompressor\" header_type")
            .find("compressed by vtkLZ4DataCompressor; save it as") != std::string::npos);
  CHECK(refused("LittleEndian", "BigEndian").find("big-endian; save it as") != std::string::npos);
  CHECK(refused("UnstructuredGrid", "PolyData").find("not of type UnstructuredGrid") != std::string::npos);
}

TEST_CASE("a .vtu with 32-bit lengths, as other programs write, is read") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  std::string data;
  const auto append = [&data](const auto& values) {
    const auto bytes = static_cast<std::uint32_t>(values.size() * sizeof(values[0]));
    data.append(reinterpret_cast<const char*>(&bytes), 4);
    data.append(reinterpret_cast<const char*>(values.data()), bytes);
  };
  append(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  append(std::vector<std::int64_t>{0, 1, 2});
  append(std::vector<std::int64_t>{3});
  append(std::vector<std::uint8_t>{5});
  replace_file(path,
               "<VTKFile type='UnstructuredGrid' version='0.1' byte_order='LittleEndian'>\r\n<!-- by <hand> -->\n"
               "<UnstructuredGrid><Piece NumberOfPoints='3' NumberOfCells='1'><Points>\n"
               "<DataArray type='Float32' NumberOfComponents='3' format='appended' offset='0'/></Points><Cells>\n"
               "<DataArray type='Int64' Name='connectivity' format='appended' offset='40'/>\n"
               "<DataArray type='Int64' Name='offsets' format='appended' offset='68'/>\n"
               "<DataArray type='UInt8' Name='types' format='appended' offset='80'/></Cells></Piece>\n"
               "</UnstructuredGrid><AppendedData encoding='raw'>_" +
                   data + "</AppendedData></VTKFile>");
  check_same_mesh(read_mesh(path), mesh);
}

TEST_CASE("integers of a .vtu that do not fit are refused, not wrapped, and so are points off the plane") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  const auto written = [&](const std::string& corners, const std::string& markers, const std::string& points,
                           const std::string& type = "Int64") {
    replace_file(path,
                 "<VTKFile type='UnstructuredGrid' version='1.0' byte_order='LittleEndian'><UnstructuredGrid>"
                 "<Piece NumberOfPoints='3' NumberOfCells='1'><PointData><DataArray type='Int64' Name='marker' "
                 "format='ascii'>" +
                     markers +
                     "</DataArray></PointData><Points><DataArray type='Float64' "
                     "NumberOfComponents='3' format='ascii'>" +
                     points +
                     "</DataArray></Points><Cells>"
                     "<DataArray type='" +
                     type + "' Name='connectivity' format='ascii'>" + corners +
                     "</DataArray>"
                     "<DataArray type='Int64' Name='offsets' format='ascii'>3</DataArray>"
                     "<DataArray type='UInt8' Name='types' format='ascii'>5</DataArray></Cells></Piece>"
                     "</UnstructuredGrid></VTKFile>");
  };
  const std::string flat = "0 0 5 1 0 5 0 1 5";
  written("0 1 2", "7 -8 2147483647", flat);
  const Mesh mesh = read_mesh(path);
  CHECK(mesh.point_markers == std::vector<std::int32_t>{7, -8, 2147483647});
  CHECK(mesh.points[1] == Point{1, 0});
  for (const char* const corners : {"0 1 4294967298", "0 1 -4294967294", "4294967296 1 2"}) {
    written(corners, "1 1 1", flat);
    CHECK(message_of(path).find("out of range") != std::string::npos);
  }
  for (const char* const markers : {"1 1 2147483648", "4294967296 0 0", "-2147483649 0 0"}) {
    written("0 1 2", markers, flat);
    CHECK(message_of(path).find("out of range") != std::string::npos);
  }
  written("0 1 18446744073709551615", "1 1 1", flat, "UInt64");
  CHECK(message_of(path) != "no error");
  for (const char* const points : {"0 0 5 1 0 5 0 1 4", "0 0 0 1 0 0 0 1 1e-9", "0 0 1 1 0 0 0 1 0"}) {
    written("0 1 2", "1 1 1", points);
    CHECK(message_of(path).find("not planar") != std::string::npos);
  }
  for (const char* const corners : {"0 1", "0 1 2 2", "0 1 2x"}) {
    written(corners, "1 1 1", flat);
    CHECK(message_of(path) != "no error");
  }
  written("0 1 2", "1 1", flat);
  CHECK(mentions(message_of(path), {"2", "3"}));
  written("0 1 2", "1 1 1 1", flat);
  CHECK(mentions(message_of(path), {"4", "3"}));
  written("0 1 2", "1 1 1x", flat);
  CHECK(mentions(message_of(path), {"text that is not Int64"}));
}

TEST_CASE("appended arrays of a .vtu lie side by side, and nothing else behind them") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  Mesh mesh = RandomMesh(5, 2, 2).mesh();
  write_mesh(mesh, path);
  const std::string whole = file_bytes(path);
  const auto message = [&](std::string bytes) {
    replace_file(path, bytes);
    return message_of(path);
  };
  CHECK(message(whole) == "no error");
  CHECK(mentions(message(whole + "more"), {"more behind </VTKFile>"}));
  CHECK(message(whole + " \n") == "no error");
  // The second array at the place of the first.
  const std::size_t second = whole.find("offset=\"", whole.find("offset=\"0\"") + 1);
  REQUIRE(second != std::string::npos);
  std::string same = whole;
  const std::size_t digits = whole.find('"', second + 8) - second - 8;
  same.replace(second + 8, digits, "0" + std::string(digits - 1, ' '));
  CHECK(message(same) != "no error");
  same.replace(second + 8, digits, std::string(digits - 1, '0') + "4");  // within the first
  CHECK(mentions(message(same), {"overlaps another one"}));
  std::string flat = whole;
  const std::size_t components = flat.find("NumberOfComponents=\"3\"", flat.find("<Points>"));
  REQUIRE(components != std::string::npos);
  CHECK(mentions(message(flat.replace(components, 22, "NumberOfComponents=\"2\"")), {"NumberOfComponents=\"3\""}));
}

TEST_CASE("data at the triangles of a .vtu: one for each component, lines apart") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.vtu";
  replace_file(path,
               "<VTKFile type='UnstructuredGrid' version='1.0' byte_order='LittleEndian'><UnstructuredGrid>"
               "<Piece NumberOfPoints='4' NumberOfCells='3'><CellData><DataArray type='Float64' Name='u' "
               "NumberOfComponents='2' format='ascii'>1 2 3 4 5 6</DataArray><DataArray type='Int8' Name='q' "
               "format='ascii'>7 8 9</DataArray></CellData><Points><DataArray type='Float64' NumberOfComponents='3' "
               "format='ascii'>0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points><Cells>"
               "<DataArray type='Int64' Name='connectivity' format='ascii'>0 1 2 0 1 0 2 3</DataArray>"
               "<DataArray type='Int64' Name='offsets' format='ascii'>3 5 8</DataArray>"
               "<DataArray type='UInt8' Name='types' format='ascii'>5 3 5</DataArray></Cells></Piece>"
               "</UnstructuredGrid></VTKFile>");
  TriangleData data;
  CHECK(read_mesh(path, {}, data).triangles.size() == 2);
  CHECK(data == TriangleData{{"u_0", {1, 5}}, {"u_1", {2, 6}}, {"q", {7, 9}}});
}
