#include "mutants/corpus.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "driftmesh/decomposition.hpp"
#include "driftmesh/files.hpp"
#include "io/pvtu_format.hpp"
#include "mutants/declared_msh.hpp"
#include "mutants/vtu_encodings.hpp"
#include "support/random_mesh.hpp"
#include "support/varied_domain.hpp"

namespace driftmesh::mutants {
namespace {

namespace fs = std::filesystem;
using test::RandomMesh;
using test::RandomMeshParts;

Mesh with_subdomains(Mesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.subdomains.push_back(static_cast<std::int32_t>(t * t % 7));
    mesh.ranks.push_back(mesh.subdomains.back() % 3);
  }
  return mesh;
}

/// With all that a mesh can have; and with nothing but triangles.
Mesh full_mesh() {
  return with_subdomains(RandomMesh(5, 3, 3).mesh());
}
Mesh plain_mesh() {
  return RandomMesh(6, 2, 1, {false, false, false, 0}).mesh();
}

/// The domain of full_mesh and one point that it shares with no segment, with something in every section.
Pslg domain() {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {3, 0.5}, {3, 2.5}};
  pslg.point_markers = {1, 1, 1, 1, 2, 2, 2, 2, 0, -7};
  pslg.attributes_per_point = 2;
  for (std::size_t i = 0; i < 2 * pslg.points.size(); ++i) pslg.attributes.push_back(0.1 * static_cast<double>(i) - 1);
  pslg.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}, {4, 5, 5}, {5, 6, 5}, {6, 7, 5}, {7, 4, 5}, {8, 9, -2}};
  pslg.holes = {{1.5, 1.5}, {10, 10}};
  pslg.regions = {{{0.5, 0.5}, 3, 0.01}, {{3.5, 1}, -1.5, -1}};
  return pslg;
}

/// The part of a mesh with every third triangle.
Mesh piece_of(const Mesh& whole, std::size_t k) {
  Mesh piece;
  std::vector<std::int32_t> place(whole.points.size(), -1);
  piece.attributes_per_point = whole.attributes_per_point;
  const auto local = [&](std::int32_t vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    if (place[v] >= 0) return place[v];
    place[v] = static_cast<std::int32_t>(piece.points.size());
    piece.points.push_back(whole.points[v]);
    piece.numbers.push_back(vertex);
    piece.point_markers.push_back(whole.point_markers[v]);
    const auto width = static_cast<std::size_t>(whole.attributes_per_point);
    for (std::size_t i = 0; i < width; ++i) piece.attributes.push_back(whole.attributes[v * width + i]);
    return place[v];
  };
  for (std::size_t t = k; t < whole.triangles.size(); t += 3) {
    const auto& [a, b, c] = whole.triangles[t];
    piece.triangles.push_back({local(a), local(b), local(c)});
    piece.regions.push_back(whole.regions[t]);
    piece.subdomains.push_back(whole.subdomains[t]);
    piece.ranks.push_back(static_cast<std::int32_t>(k));
  }
  for (const Mesh::Edge& edge : whole.edges)
    if (place[static_cast<std::size_t>(edge.a)] >= 0 && place[static_cast<std::size_t>(edge.b)] >= 0)
      piece.edges.push_back({local(edge.a), local(edge.b), edge.marker});
  return piece;
}

void write_pieces(const Mesh& whole, const std::string& path) {
  VtuArrays arrays;
  for (std::int32_t k = 0; k < 3; ++k) {
    const Mesh piece = piece_of(whole, static_cast<std::size_t>(k));
    arrays = arrays_of(piece);
    prepare_vtu(piece, arrays, pvtu_piece_path(path, k))->commit();
  }
  write_pvtu(path, 3, arrays);
}

/// As Gmsh writes it: tags with gaps, entities without groups and with several, a point element, parametric nodes.
const char* const kMshByHand = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "inlet"
2 3 "fluid"
$EndPhysicalNames
$Entities
1 3 1 0
1 0 0 0 0
1 0 0 0 1 0 0 2 7 8 2 1 -1
2 1 0 0 1 1 0 1 9 0
3 0 0 0 1 1 0 0 0
1 0 0 0 1 1 0 1 3 3 1 2 3
$EndEntities
$Nodes
3 4 1 12
0 1 0 1
1
0 0 0
1 1 1 1
5
1 0 0 0.5
2 1 0 2
10
12
1 1 0
0 1 0
$EndNodes
$Elements
5 6 1 20
0 1 15 1
1 1
1 1 1 1
2 1 5
1 2 1 1
3 5 10
1 3 1 1
4 12 1
2 1 2 2
20 1 5 10
9 1 10 12
$EndElements
)";

class CorpusMaker {
 public:
  explicit CorpusMaker(std::string folder) : folder_(std::move(folder)) {}

  std::vector<Sample> make() {
    add_domains();
    add_meshes();
    add_foreign_meshes();
    add_background();
    add_decompositions();
    add_settings();
    return std::move(samples_);
  }

 private:
  /// What `write` writes to the file of this name, and what comes with it.
  void add(const std::string& name, Reading reading, const std::string& main,
           const std::function<void(const std::string&)>& write) {
    const fs::path folder = fs::path(folder_) / name;
    fs::create_directories(folder);
    write((folder / main).string());
    samples_.push_back({name, reading, files_in(folder.string()), main});
    fs::remove_all(folder);
  }
  void add(const std::string& name, Reading reading, const std::string& main, Files files) {
    samples_.push_back({name, reading, std::move(files), main});
  }

  void add_domains() {
    const auto write = [](const Pslg& pslg) { return [pslg](const std::string& path) { write_poly(pslg, path); }; };
    add("poly", Reading::kDomain, "domain.poly", write(domain()));
    Pslg from_zero = domain();
    from_zero.first_number = 0;
    from_zero.point_markers.clear();
    from_zero.regions.clear();
    add("poly-from-0", Reading::kDomain, "domain.poly", write(from_zero));
    add("poly-by-hand", Reading::kDomain, "domain.poly",
        Files{{"domain.poly",
               "# A square in two parts.\r\n\r\n 6 2 0 0 0\t# vertices\n1 0 0\n2 1.5e0 +0\n3 2 0 0\n4 2 2\n5 1.5 2\n6 "
               "0 2\n"
               "# segments\n7 1\n1 1 2 1\n2 2 3 1\n5 3 4 2\n4 4 5 3\n3 5 6 3\n6 6 1 4\n7 2 5 -1000000\n0\n2\n"
               "1 .5 1 10\n2 1.75 1. 20 1e-2 # the finer one\n"}});
    add("poly-and-node", Reading::kDomain, "domain.poly",
        Files{{"domain.node", "4 2 1 1\n0 0 0 5 1\n1 3 0 6 1\n2 3 3 7 2\n3 0 3 8 2\n"},
              {"domain.poly", "0 2 1 1\n5 1\n0 0 1 1\n1 1 2 1\n2 2 3 2\n3 3 0 2\n4 0 2 -1000000\n1\n1 2 1\n"}});
    add("points", Reading::kDomain, "points.node",
        Files{{"points.node", "5 2 0 1\n1 0 0 0\n2 1 0 0\n3 1 1 3\n4 0 1 0\n5 .25 .5 9\n"}});
  }

  void add_meshes() {
    const auto write = [](const Mesh& mesh) {
      return [mesh](const std::string& path) { write_mesh(mesh, path, {.holes = {{0.5, 0.5}}}); };
    };
    for (const char* const main : {"mesh.ele", "mesh.vtu", "mesh.msh"}) {
      const std::string format = fs::path(main).extension().string().substr(1);
      add(format + "-full", Reading::kMesh, main, write(full_mesh()));
      add(format + "-plain", Reading::kMesh, main, write(plain_mesh()));
      if (format != "msh") continue;
      for (const char* const name : {"msh-full", "msh-plain"}) add_as_text(name);
    }
    Mesh boundary = RandomMesh(7, 3, 2, {false, false, true, 0}).mesh();
    boundary.names.markers = {{5, "in let"}, {-3, "50% (of) it"}, {1, "inlet"}};
    add("su2", Reading::kMesh, "mesh.su2", write(boundary));
    add_encoded("vtu-full-base64", {.base64 = true});
    add_encoded("vtu-full-zlib", {.compressed = true});
    add_encoded("vtu-full-zlib-base64", {.compressed = true, .base64 = true});
    Files edges = find("ele-full").files;  // the constrained edges are in the .edge
    edges.erase("mesh.poly");
    add("edge", Reading::kMesh, "mesh.node", edges);
    add("pvtu", Reading::kMesh, "mesh.pvtu", [](const std::string& path) { write_pieces(full_mesh(), path); });
  }

  [[nodiscard]] const Sample& find(const std::string& name) const {
    return *std::ranges::find(samples_, name, &Sample::name);
  }
  void add_encoded(const std::string& name, const VtuEncoding& encoding) {
    add(name, Reading::kMesh, "mesh.vtu", Files{{"mesh.vtu", vtu_as(find("vtu-full").files.at("mesh.vtu"), encoding)}});
  }
  void add_as_text(const std::string& name) {
    const Sample& binary = find(name);
    add(name + "-text", Reading::kMesh, binary.main, Files{{binary.main, msh_as_text(binary.files.at(binary.main))}});
  }

  /// As other programs write them.
  void add_foreign_meshes() {
    const Files files = files_in(DRIFTMESH_SOURCE_DIR "/tests/fuzz/corpus/read_mesh");
    for (const char* const name : {"ascii.vtu", "inline.vtu", "zlib-base64.vtu", "zlib-inline.vtu", "zlib-raw.vtu",
                                   "piece.vtu", "text.msh", "subdomains.msh", "foil.su2"})
      add(name, Reading::kMesh, name, Files{{name, files.at(name)}});
    add("ele-by-hand", Reading::kMesh, "mesh.ele",
        Files{{"mesh.node", "6 2\n0 0 0\n1 2 0\n2 0 2\n3 1 1\n4 0 1\n5 1 0\n"},
              {"mesh.ele", "# triangles of six points\n1 6 2\n0 0 2 1 3 5 4 9 8.5\n"},
              {"mesh.edge", "3 1\n0 0 1 1\n1 1 2 0\n2 2 0 5\n"}});
    add("msh-by-hand", Reading::kMesh, "mesh.msh", Files{{"mesh.msh", kMshByHand}});
  }

  void add_background() {
    const Files files{{"sizes.node", "5 2 2 0\n1 0 0 0.5 7\n2 4 0 .25 7\n3 4 4 1e-1 7\n4 0 4 0.5 7\n5 2 2 1 7\n"},
                      {"sizes.ele", "4 3 0\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 5 4 1\n"},
                      {"sizes.area", "4\n1 0.5\n2 .25\n3 -1\n4 1e-3\n"}};
    Files without_areas = files;
    without_areas.erase("sizes.area");
    add("sizes", Reading::kLengths, "sizes.node", without_areas);
    add("areas", Reading::kAreas, "sizes.area", files);
  }

  void add_decompositions() {
    for (const std::int32_t count : {2, 7})
      add("decomposition-" + std::to_string(count), Reading::kDecomposition, "cut.txt", [&](const std::string& path) {
        MeshOptions options;
        options.max_area = kDecomposedArea;
        options.subdomains.count = count;
        save_decomposition(*cut_domain(testing::varied_domain(), options), testing::varied_domain(), path);
      });
  }

  void add_settings() {
    add("settings", Reading::kSettings, "run.yaml",
        Files{{"run.yaml",
               "# What driftmesh mesh reads.\ninput: bay.poly\nangle: 25\nsize: 20 + 0.1 * abs(x)\nno-region-areas: "
               "true\n"
               "max-memory: 2G\noutput: [bay.vtu, bay.msh]\n"}});
    add("settings-in-sections", Reading::kSettings, "run.yaml",
        Files{{"run.yaml",
               "input:\n  generate: bay\n  parameters: {resolution: 300}\nbounds:\n  angle: 25\n  area: 5k\nsizing:\n"
               "  gradation: 0.25\n  max: 1e3\ndecomposition:\n  subdomains: 12\n  skew: 0.5\nrun:\n  sleep: true\n"
               "  order: largest\nseed: 7\n"}});
    Files configs = files_in(DRIFTMESH_SOURCE_DIR "/configs");
    configs.merge(files_in(DRIFTMESH_SOURCE_DIR "/configs/paper"));
    for (const char* const name :  // those that generate no large domain, as reading does, too
         {"fig-7.yaml", "corner-refinement.yaml", "migration-stress.yaml", "policies.yaml", "two-ranks.yaml"})
      add(name, Reading::kExperiment, name, Files{{name, configs.at(name)}});
  }

  std::string folder_;
  std::vector<Sample> samples_;
};

}  // namespace

std::vector<Sample> make_corpus(const std::string& folder) {
  return CorpusMaker(folder).make();
}

void write_files(const Files& files, const std::string& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const auto& [name, bytes] : files)
    std::ofstream(fs::path(folder) / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

Files files_in(const std::string& folder) {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(stream), {}};
  }
  return files;
}

}  // namespace driftmesh::mutants
