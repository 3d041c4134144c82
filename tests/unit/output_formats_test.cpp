// All rows of the table of formats: each format keeps what its row says and nothing else, tells what gets lost, and
// survives damage.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "io/boundary_types.hpp"
#include "io/fort14_format.hpp"
#include "io/mesh_file.hpp"
#include "mesh/mesh_edges.hpp"
#include "support/damage.hpp"
#include "support/error_text.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "support/round_trip.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;
using namespace driftmesh::test;
using testing::error_text;
using testing::mentions;

namespace {

// ---- What of a mesh belongs to which part, in a form to compare ----

using Ends = std::array<std::int32_t, 2>;

std::map<Ends, std::int32_t> segments(const Mesh& mesh, bool inside) {
  std::set<std::int32_t> chosen;
  for (std::size_t e = 0; inside && e < mesh.edges.size(); ++e) chosen.insert(static_cast<std::int32_t>(e));
  for (const std::int32_t e : boundary_edges(mesh)) inside ? (void)chosen.erase(e) : (void)chosen.insert(e);
  std::map<Ends, std::int32_t> markers;
  for (const std::int32_t e : chosen) {
    const Mesh::Edge& edge = mesh.edges[static_cast<std::size_t>(e)];
    markers[{std::min(edge.a, edge.b), std::max(edge.a, edge.b)}] = edge.marker;
  }
  return markers;
}

std::map<Ends, std::int32_t> boundary_segments(const Mesh& mesh) {
  return segments(mesh, false);
}
std::map<Ends, std::int32_t> inner_segments(const Mesh& mesh) {
  return segments(mesh, true);
}

/// Weirs apart, which have a part of their own.
std::map<Ends, std::int32_t> types_of_boundary(const Mesh& mesh) {
  std::map<Ends, std::int32_t> types;
  for (const auto& [ends, marker] : boundary_segments(mesh))
    if (const auto name = mesh.names.markers.find(marker); name != mesh.names.markers.end())
      if (const auto type = type_named(name->second); type && !weir_columns(*type)) types[ends] = *type;
  return types;
}

std::map<std::int32_t, std::string> names_of_boundary(const Mesh& mesh) {
  std::map<std::int32_t, std::string> names;
  for (const auto& [ends, marker] : boundary_segments(mesh))
    if (const auto name = mesh.names.markers.find(marker); name != mesh.names.markers.end())
      if (!type_named(name->second)) names.insert(*name);
  return names;
}

std::vector<double> attributes(const Mesh& mesh, bool first) {
  std::vector<double> values;
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i)
    if ((i % static_cast<std::size_t>(mesh.attributes_per_point) == 0) == first) values.push_back(mesh.attributes[i]);
  return values;
}

struct Part {
  MeshParts bit;
  std::function<bool(const Mesh&, const Mesh&)> same;
  std::string lost;     ///< what a warning says, or nothing if there is none
  MeshParts instead{};  ///< parts that take its place
};

template <class Of>
Part part(MeshParts bit, Of of, std::string lost = "", MeshParts instead = 0) {
  return {bit, [of](const Mesh& a, const Mesh& b) { return std::invoke(of, a) == std::invoke(of, b); }, std::move(lost),
          instead};
}

std::vector<Part> parts() {
  return {part(kPointMarkers, &Mesh::point_markers),
          part(
              kFirstAttribute, [](const Mesh& mesh) { return attributes(mesh, true); }, "the first attribute"),
          part(
              kOtherAttributes, [](const Mesh& mesh) { return attributes(mesh, false); }, "the other attributes"),
          part(kMarkers, boundary_segments, "segments of the boundary", kBoundaryTypes),
          part(kInnerSegments, inner_segments, "segments inside of the domain"),
          part(kOrderOfSegments, &Mesh::edges),
          part(kRegions, &Mesh::regions, "regions"),
          part(kMarkerNames, names_of_boundary, "names of markers"),
          part(
              kRegionNames, [](const Mesh& mesh) { return mesh.names.regions; }, "names of regions"),
          part(kBoundaryTypes, types_of_boundary, "types of boundaries"),
          part(kWeirs, &Mesh::weirs, "heights and coefficients of weirs"),
          part(kSubdomains, [](const Mesh& mesh) { return std::pair(mesh.subdomains, mesh.ranks); })};
}

// ---- Meshes that have all parts between them ----

Mesh full_mesh(std::uint32_t seed) {
  Mesh mesh = in_subdomains(RandomMesh(seed, 6, 5).mesh(), kSubdomains);
  mesh.names.markers = {{1, "open"}, {2, "ibtype 52"}, {5, "in let, 50%"}, {-3, "<quay>"}};
  mesh.names.regions = {{7, "land & sea"}, {-1.25, "reef"}};
  return mesh;
}

/// A strip with a weir along its upper side and another that is open at one end, as a grid of ADCIRC has them.
Mesh mesh_with_weirs() {
  return parse_fort14("weirs.14",
                      "t\n4 8\n1 0 0 2\n2 1 0 2\n3 1 1 2\n4 0 1 2\n5 0 2 2\n6 1 2 2\n7 1 3 2\n8 0 3 2\n"
                      "1 3 1 2 3\n2 3 1 3 4\n3 3 5 6 7\n4 3 5 7 8\n"
                      "1\n2\n2\n1\n2\n3\n8\n2 24\n3 6 2.5 1 0.9\n4 5 2.5 1 1\n2 23\n7 1.5 1\n8 1.25 1\n2 52\n2\n3\n");
}

struct Told {
  Mesh read;
  std::vector<std::string> lost;
};

/// The mesh after it has been written and read, and what was said about it.
Told through(const MeshFormat& format, const Mesh& mesh, const std::string& path) {
  Told told;
  const std::string start = path + ": has no place for ";
  const auto warn = [&](const std::string& text) {
    if (!text.starts_with(start)) return;
    for (std::size_t at = start.size(); at < text.size();) {
      const std::size_t end = std::min(text.find("; ", at), text.size());
      told.lost.push_back(text.substr(at, end - at));
      at = end + 2;
    }
  };
  write_mesh(mesh, path, {.warn = warn});
  if (format.is_read()) told.read = read_mesh(path);
  return told;
}

/// Calls visit(format, path of a file) for each format that write_mesh writes.
template <class Visit>
void for_each_written(const Visit& visit) {
  const TemporaryFolder folder;
  for (const MeshFormat& format : mesh_formats()) {
    if (format.write == nullptr) continue;
    const std::string path = folder.path() / ("mesh" + std::string(format.extensions.front()));
    CAPTURE(path);
    visit(format, path);
  }
}

}  // namespace

TEST_CASE("a format keeps of a mesh what its row says, not more and not less, and tells what gets lost") {
  std::vector<Mesh> meshes{mesh_with_weirs()};
  for (std::uint32_t seed = 1; seed <= 8; ++seed) meshes.push_back(full_mesh(seed));
  REQUIRE(meshes[0].weirs.size() == 2);
  for (const Part& part : parts())
    REQUIRE(std::ranges::any_of(meshes, [&](const Mesh& m) { return !part.same(m, {}); }));
  for_each_written([&](const MeshFormat& format, const std::string& path) {
    MeshParts kept = kAllParts;
    for (const Mesh& mesh : meshes) {
      const Told told = through(format, mesh, path);
      std::size_t lost = 0;
      for (const Part& part : parts()) {
        if (!part.same(told.read, mesh)) kept &= ~part.bit;
        if (part.lost.empty() || part.same(mesh, {}) || (format.keeps & (part.bit | part.instead)) != 0) continue;
        CAPTURE(part.lost);
        CHECK(++lost <= told.lost.size());
        CHECK(std::ranges::count_if(told.lost, [&](const auto& text) { return text.find(part.lost) != text.npos; }) >
              0);
      }
      CHECK(told.lost.size() == lost);
      if (!format.is_read()) continue;
      CHECK(told.read.points == mesh.points);
      CHECK(told.read.triangles == mesh.triangles);
      if ((format.keeps & (kMarkers | kBoundaryTypes)) != 0)
        for (const auto& [ends, marker] : boundary_segments(mesh)) CHECK(boundary_segments(told.read).contains(ends));
    }
    if (format.is_read()) CHECK(kept == format.keeps);
  });
}

TEST_CASE(
    "data at triangles come back bit by bit where a format has a place for them, and others say that they are lost") {
  std::size_t with_place = 0;
  for_each_written([&](const MeshFormat& format, const std::string& path) {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
      const Mesh mesh = full_mesh(seed);
      std::mt19937_64 random(seed);
      TriangleData data{{"q", {}}, {"dry & wet 50%", {}}, {"attribute 1", {}}};
      for (auto& named : data)
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
          named.second.push_back(
              std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), random() % 400 - 200.0));
      data["q"].front() = -0.0;
      data["q"].back() = 5e-324;
      std::string said;
      for (const bool ascii : {false, true}) {
        write_mesh(mesh, data, path, {.ascii = ascii, .warn = [&](const std::string& text) { said += text; }});
        CHECK((said.find("data at triangles") == std::string::npos) == (format.write_with_data != nullptr));
        if (!format.is_read()) continue;
        TriangleData read;
        const Mesh with_data = read_mesh(path, {}, read);
        CHECK(read == (format.write_with_data != nullptr ? data : TriangleData{}));
        write_mesh(mesh, path, {.ascii = ascii});
        check_same_mesh(with_data, read_mesh(path));
        with_place += read.empty() ? 0 : 1;
        static_cast<void>(read_mesh(path, {}, read));
        CHECK(read.empty());
      }
    }
  });
  CHECK(with_place == 3 * 8 * 2);
}

TEST_CASE("what keeps everything of a domain reads back bit by bit") {
  for_each_written([](const MeshFormat& format, const std::string& path) {
    if ((format.keeps & kDomainParts) == kDomainParts) check_random_meshes_read_back(path, format.keeps);
  });
}

TEST_CASE("an empty mesh and points alone survive") {
  for_each_written([](const MeshFormat& format, const std::string& path) {
    if (format.parse != nullptr || path.ends_with(".h5")) check_meshes_without_triangles_read_back(path);
  });
}

TEST_CASE("what is cut off or damaged is refused, or is a mesh") {
  const auto read = [](const MeshFormat& format, const std::string& bytes, DamageCount& count) {
    try {
      const Mesh mesh = format.parse("damaged", bytes);
      const auto exists = [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < mesh.points.size(); };
      for (const auto& triangle : mesh.triangles) REQUIRE(std::ranges::all_of(triangle, exists));
      for (const Mesh::Edge& edge : mesh.edges) REQUIRE((exists(edge.a) && exists(edge.b)));
      ++count.accepted;
    } catch (const Error& error) {
      CHECK(std::string(error.what()).starts_with("damaged"));
      ++count.refused;
    }
  };
  for_each_written([&](const MeshFormat& format, const std::string& path) {
    if (format.parse == nullptr) return;
    write_mesh(RandomMesh(4, 2, 2).mesh(), path);
    const std::string whole = file_bytes(path);
    DamageCount cut, damaged;
    for (std::size_t size = 0; size < whole.size(); ++size) read(format, whole.substr(0, size), cut);
    for_each_flipped(whole, 3000, 99, [&](const std::string& bytes) { read(format, bytes, damaged); });
    CHECK(cut.refused > 10 * cut.accepted);  // cut off in a comment, or between sections
    CHECK(damaged.refused > 500);
    CHECK(damaged.accepted > 0);  // coordinates and markers may change unseen
  });
}

TEST_CASE("the table of formats is consistent") {
  std::set<std::string_view> extensions;
  for (const MeshFormat& format : mesh_formats()) {
    REQUIRE(!format.extensions.empty());
    CAPTURE(std::string(format.extensions.front()));
    for (const std::string_view extension : format.extensions) {
      CHECK(extensions.insert(extension).second);
      const std::string refusal = error_text<InputError>([&] { (void)format_of("-" + std::string(extension)); });
      CHECK(mentions(refusal, "several files") == (format.files != nullptr));
    }
    const bool is_whole = format.write != nullptr, is_parsed = format.parse != nullptr;
    CHECK(!(is_parsed && format.read != nullptr));
    CHECK(is_whole == (format.in_pieces == PieceWriters::kNobody));
    CHECK(is_whole == format.whole.empty());
    if (!is_whole) CHECK_NOTHROW(require_whole("m" + std::string(format.whole)));
  }
}

TEST_CASE("the table in docs/file-formats.md has every extension, and says what reads back") {
  std::map<std::string, std::string> reads_back;  // by extensions
  std::ifstream docs(DRIFTMESH_SOURCE_DIR "/docs/file-formats.md");
  for (std::string line; std::getline(docs, line) && !line.starts_with("\"Everything\"");) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() == 5) reads_back[cells[1]] = cells[4];
  }
  for (const MeshFormat& format : mesh_formats()) {
    std::string extensions = " ";
    for (const std::string_view extension : format.extensions) extensions.append("`").append(extension).append("` ");
    CAPTURE(extensions);
    REQUIRE(reads_back.contains(extensions));
    const std::string& said = reads_back.at(extensions);
    CHECK((said == " everything ") == ((format.keeps & kDomainParts) == kDomainParts && format.is_read()));
    CHECK((said == " is not read ") == !format.is_read());
  }
}

TEST_CASE("names of markers that occur nowhere stay") {
  const TemporaryFolder folder;
  Mesh mesh;
  mesh.names.markers[-77] = "occurs nowhere";
  for (const char* const name : {"m.vtu", "m.h5"}) {
    write_mesh(mesh, folder.path() / name);
    check_same_mesh(read_mesh(folder.path() / name), mesh);
  }
}
