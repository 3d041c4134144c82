#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "distributed/write_mfem.hpp"
#include "driftmesh/files.hpp"
#include "mesh/merge_pieces.hpp"
#include "property/cases.hpp"
#include "support/adversarial_network.hpp"
#include "support/distributed_case.hpp"
#include "support/exchange_over.hpp"
#include "temporary_folder.hpp"

// The files that ranks write for MFEM's ParMesh, read by the rules of its documentation and of what ParMesh does with
// them: what two ranks have in common must be listed by both, in the same order and direction.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Place = std::pair<double, double>;
using Side = std::pair<Place, Place>;  // the lower place first

Side side_of(Place a, Place b) {
  return a < b ? Side(a, b) : Side(b, a);
}

struct MfemFile {
  struct Element {
    int attribute = 0;
    std::vector<int> points;
  };
  struct Group {
    std::vector<int> ranks, points;
    std::vector<std::array<int, 2>> edges;
  };
  std::vector<Element> elements, boundary;
  std::vector<Place> points;
  std::vector<Group> groups;

  [[nodiscard]] Place at(int point) const { return points.at(static_cast<std::size_t>(point)); }
};

/// Reads words in the order in which MFEM does; '#' begins a comment.
class MfemReader {
 public:
  explicit MfemReader(const std::string& path) {
    std::ifstream file(path);
    REQUIRE_MESSAGE(file.good(), path);
    std::getline(file, title_);
    std::string all;
    for (std::string line; std::getline(file, line);) all += line.substr(0, line.find('#')) + '\n';
    words_.str(all);
  }

  MfemFile read(bool parallel) {
    CHECK(title_ == (parallel ? "MFEM mesh v1.2" : "MFEM mesh v1.0"));
    expect("dimension");
    CHECK(number() == 2);
    file_.elements = elements("elements", 2, 3);
    file_.boundary = elements("boundary", 1, 2);
    points();
    if (parallel) groups();
    std::string more;
    CHECK_FALSE(static_cast<bool>(words_ >> more));
    return std::move(file_);
  }

 private:
  void expect(const std::string& word) {
    std::string found;
    words_ >> found;
    REQUIRE(found == word);
  }
  int number() {
    int value = -1;
    REQUIRE(static_cast<bool>(words_ >> value));
    return value;
  }
  int point() {
    const int value = number();
    REQUIRE(value >= 0);
    REQUIRE(value < static_cast<int>(file_.points.size()));
    return value;
  }

  std::vector<MfemFile::Element> elements(const std::string& section, int geometry, int corners) {
    expect(section);
    std::vector<MfemFile::Element> all(static_cast<std::size_t>(number()));
    for (MfemFile::Element& element : all) {
      element.attribute = number();
      CHECK(element.attribute > 0);
      REQUIRE(number() == geometry);
      for (int i = 0; i < corners; ++i) element.points.push_back(number());
    }
    return all;
  }

  void points() {
    expect("vertices");
    file_.points.resize(static_cast<std::size_t>(number()));
    REQUIRE(number() == 2);
    for (Place& place : file_.points) REQUIRE(static_cast<bool>(words_ >> place.first >> place.second));
  }

  void groups() {
    expect("mfem_serial_mesh_end");
    expect("communication_groups");
    expect("number_of_groups");
    file_.groups.resize(static_cast<std::size_t>(number()));
    for (MfemFile::Group& group : file_.groups)
      for (int left = number(); left > 0; --left) group.ranks.push_back(number());
    expect("total_shared_vertices");
    const int all_points = number();
    expect("total_shared_edges");
    const int all_edges = number();
    int points = 0, edges = 0;
    for (std::size_t g = 1; g < file_.groups.size(); ++g) {
      MfemFile::Group& group = file_.groups[g];
      expect("shared_vertices");
      for (int left = number(); left > 0; --left, ++points) group.points.push_back(point());
      expect("shared_edges");
      for (int left = number(); left > 0; --left, ++edges) group.edges.push_back({point(), point()});
    }
    CHECK(points == all_points);
    CHECK(edges == all_edges);
    expect("mfem_mesh_end");
  }

  std::string title_;
  std::istringstream words_;
  MfemFile file_;
};

/// The sides of all triangles, and how many each has.
std::map<Side, int> sides_of(const MfemFile& file) {
  std::map<Side, int> sides;
  for (const MfemFile::Element& t : file.elements)
    for (std::size_t i = 0; i < 3; ++i) ++sides[side_of(file.at(t.points[i]), file.at(t.points[(i + 1) % 3]))];
  return sides;
}

/// Each side of the domain is a boundary element of one rank, with the tag of its marker.
void check_boundary(const std::vector<MfemFile>& files, const Mesh& whole, const std::map<double, int>& tag) {
  std::map<Side, int> triangles;
  std::map<Side, int> found, expected;
  for (const MfemFile& file : files) {
    for (const auto& [side, count] : sides_of(file)) triangles[side] += count;
    for (const MfemFile::Element& e : file.boundary)
      CHECK(found.emplace(side_of(file.at(e.points[0]), file.at(e.points[1])), e.attribute).second);
  }
  const auto place = [&](std::int32_t v) {
    const Point& p = whole.points[static_cast<std::size_t>(v)];
    return Place(p.x, p.y);
  };
  for (const Mesh::Edge& e : whole.edges)
    if (const Side side = side_of(place(e.a), place(e.b)); triangles.at(side) == 1) expected[side] = tag.at(e.marker);
  CHECK(found == expected);
  CHECK(expected.size() ==
        static_cast<std::size_t>(std::ranges::count(triangles, 1, [](const auto& entry) { return entry.second; })));
}

void check_elements(const std::vector<DistributedPiece>& pieces, const std::vector<MfemFile>& files,
                    const std::map<double, int>& tag) {
  for (std::size_t r = 0; r < files.size(); ++r) {
    const Mesh& mesh = pieces[r].mesh;
    REQUIRE(files[r].points.size() == mesh.points.size());
    REQUIRE(files[r].elements.size() == mesh.triangles.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      CHECK(files[r].points[v] == Place(mesh.points[v].x, mesh.points[v].y));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      CHECK(std::ranges::equal(files[r].elements[t].points, mesh.triangles[t]));
      CHECK(files[r].elements[t].attribute == (mesh.regions.empty() ? 1 : tag.at(mesh.regions[t])));
    }
  }
}

/// The ranks of each point and of each side, found by their places; groups must say the same.
void check_groups(const std::vector<MfemFile>& files) {
  std::map<Place, std::vector<int>> of_point;
  std::map<Side, std::vector<int>> of_side;
  for (int r = 0; r < static_cast<int>(files.size()); ++r) {
    for (const Place& place : files[static_cast<std::size_t>(r)].points) of_point[place].push_back(r);
    for (const auto& [side, count] : sides_of(files[static_cast<std::size_t>(r)])) of_side[side].push_back(r);
  }
  // By the ranks of a group, what each of these lists, by places.
  std::map<std::vector<int>, std::map<int, std::vector<Place>>> points;
  std::map<std::vector<int>, std::map<int, std::vector<std::pair<Place, Place>>>> edges;
  for (int r = 0; r < static_cast<int>(files.size()); ++r) {
    const MfemFile& file = files[static_cast<std::size_t>(r)];
    REQUIRE(!file.groups.empty());
    CHECK(file.groups[0].ranks == std::vector<int>{r});
    std::size_t listed_points = 0, listed_edges = 0;
    for (std::size_t g = 1; g < file.groups.size(); ++g) {
      const MfemFile::Group& group = file.groups[g];
      CHECK(std::ranges::is_sorted(group.ranks));
      CHECK(std::ranges::count(group.ranks, r) == 1);
      CHECK(points[group.ranks].emplace(r, std::vector<Place>{}).second);  // no group twice
      for (const int p : group.points) {
        CHECK(of_point.at(file.at(p)) == group.ranks);
        points[group.ranks][r].push_back(file.at(p));
      }
      for (const auto& [a, b] : group.edges) {
        CHECK(of_side.at(side_of(file.at(a), file.at(b))) == group.ranks);
        edges[group.ranks][r].emplace_back(file.at(a), file.at(b));
      }
      listed_points += group.points.size();
      listed_edges += group.edges.size();
    }
    const auto is_shared = [&](const auto& entry) {
      return entry.second.size() > 1 && std::ranges::count(entry.second, r) == 1;
    };
    CHECK(listed_points == static_cast<std::size_t>(std::ranges::count_if(of_point, is_shared)));
    CHECK(listed_edges == static_cast<std::size_t>(std::ranges::count_if(of_side, is_shared)));
  }
  const auto agree = [](const auto& groups) {
    for (const auto& [ranks, lists] : groups) {
      CHECK(lists.size() == ranks.size());
      for (const auto& [rank, list] : lists) CHECK(list == lists.begin()->second);
    }
  };
  agree(points);
  agree(edges);
}

/// The tag of each value as the documents say.
std::map<double, int> tags(const std::set<double>& values) {
  std::map<double, int> tag;
  int next = 1'000'001;
  for (const double value : values) {
    const bool is_tag = value >= 1 && value < 1'000'000 && value == static_cast<int>(value);
    tag[value] = is_tag ? static_cast<int>(value) : value == 0 ? 1'000'000 : next++;
  }
  return tag;
}

/// Regions and markers whose tags follow from those of all ranks.
void without_tags(std::vector<DistributedPiece>& pieces) {
  for (DistributedPiece& piece : pieces) {
    for (double& region : piece.mesh.regions) region += 0.5;
    for (Mesh::Edge& edge : piece.mesh.edges) edge.marker = -1 - edge.marker;
  }
}

}  // namespace

TEST_CASE("ranks write what a ParMesh needs: parts, boundary, and groups that agree") {
  std::size_t shared = 0, three = 0;
  const auto cases = static_cast<std::uint64_t>(case_count(40));
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    CAPTURE(seed);
    const TemporaryFolder folder;
    const std::string path = folder.path() / "bay.pmesh";
    const DistributedCase c = random_distributed_case(seed);
    const auto ranks = static_cast<std::int32_t>(1 + seed % 5);
    std::vector<DistributedPiece> pieces = c.pieces(ranks, random_owners(c.parts.size(), ranks, seed));
    if (seed % 2 == 1) without_tags(pieces);
    std::vector<std::unique_ptr<WriteMfem>> writers;
    IdVector<Rank, Exchange*> exchanges;
    for (const DistributedPiece& piece : pieces) writers.push_back(std::make_unique<WriteMfem>(piece, path));
    for (const auto& writer : writers) exchanges.push_back(writer.get());
    protocol::AdversarialNetwork network(ranks, protocol::Adversary::from_seed(seed));
    exchange_over(network, exchanges);

    std::vector<MfemFile> files;
    for (std::int32_t r = 0; r < ranks; ++r)
      files.push_back(MfemReader(folder.path() / ("bay.mesh.00000" + std::to_string(r))).read(true));
    MergeFaults faults;
    const Mesh whole = merge_pieces(meshes_of(pieces), faults);
    std::set<double> markers;
    for (const Mesh::Edge& e : whole.edges) markers.insert(e.marker);
    check_elements(pieces, files, tags({whole.regions.begin(), whole.regions.end()}));
    check_boundary(files, whole, tags(markers));
    check_groups(files);
    for (const MfemFile& file : files)
      for (const MfemFile::Group& group : file.groups) {
        shared += group.edges.size();
        three += group.ranks.size() > 2 ? group.points.size() : 0;
      }

    const std::string alone = folder.path() / "bay.mesh";
    write_mesh(whole, alone);
    const std::vector<MfemFile> one{MfemReader(alone).read(false)};
    check_boundary(one, whole, tags(markers));
    CHECK(one[0].elements.size() == whole.triangles.size());
  }
  MESSAGE(shared << " shared edges, " << three << " points of three ranks or more");
  CHECK(shared > 20 * cases);
  CHECK(three > cases / 4);
}
