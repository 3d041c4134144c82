#include "mutants/mesh_judge.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "driftmesh/check.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "oracles/mesh_faults.hpp"
#include "verify/verify.hpp"

namespace driftmesh::mutants {
namespace {

/// Collects the triangles of one piece, and what they need.
class PieceMaker {
 public:
  explicit PieceMaker(const Mesh& whole) : whole_(whole), place_(whole.points.size(), -1) {
    piece_.attributes_per_point = whole.attributes_per_point;
  }

  void add_triangle(std::size_t t) {
    const auto& [a, b, c] = whole_.triangles[t];
    const std::int32_t first = point(a), second = point(b), third = point(c);
    piece_.triangles.push_back({first, second, third});
    if (!whole_.regions.empty()) piece_.regions.push_back(whole_.regions[t]);
    if (!whole_.subdomains.empty()) piece_.subdomains.push_back(whole_.subdomains[t]);
    if (!whole_.ranks.empty()) piece_.ranks.push_back(whole_.ranks[t]);
  }
  void add_edge(const Mesh::Edge& edge) {
    const std::int32_t a = point(edge.a), b = point(edge.b);
    piece_.edges.push_back({a, b, edge.marker});
  }
  std::int32_t point(std::int32_t vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    if (place_[v] >= 0) return place_[v];
    place_[v] = static_cast<std::int32_t>(piece_.points.size());
    piece_.points.push_back(whole_.points[v]);
    piece_.numbers.push_back(vertex);
    if (!whole_.point_markers.empty()) piece_.point_markers.push_back(whole_.point_markers[v]);
    const auto width = static_cast<std::size_t>(whole_.attributes_per_point);
    for (std::size_t i = 0; i < width; ++i) piece_.attributes.push_back(whole_.attributes[v * width + i]);
    return place_[v];
  }
  [[nodiscard]] bool has(std::int32_t vertex) const { return place_[static_cast<std::size_t>(vertex)] >= 0; }
  [[nodiscard]] Mesh take() { return std::move(piece_); }

 private:
  const Mesh& whole_;
  std::vector<std::int32_t> place_;
  Mesh piece_;
};

/// In rows of triangles, or scattered.
std::vector<Mesh> pieces_of(const Mesh& whole, std::uint64_t seed) {
  const std::size_t count = 1 + seed % 4;
  std::vector<PieceMaker> makers(count, PieceMaker(whole));
  for (std::size_t t = 0; t < whole.triangles.size(); ++t)
    makers[seed % 3 == 0 ? t % count : t * count / whole.triangles.size()].add_triangle(t);
  for (std::size_t s = 0; s < whole.edges.size(); ++s) {
    const Mesh::Edge& edge = whole.edges[s];
    const auto home =
        std::ranges::find_if(makers, [&](const PieceMaker& maker) { return maker.has(edge.a) && maker.has(edge.b); });
    (home == makers.end() ? makers.front() : *home).add_edge(edge);
  }
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(whole.points.size()); ++v)
    if (std::ranges::none_of(makers, [&](const PieceMaker& maker) { return maker.has(v); })) makers.front().point(v);
  std::vector<Mesh> pieces;
  for (PieceMaker& maker : makers) pieces.push_back(maker.take());
  return pieces;
}

/// What a check says, of the truth.
class Comparison {
 public:
  explicit Comparison(MeshVerdict& verdict) : verdict_(verdict) {}

  void expect(const char* check, bool accepted, const std::string& said, const oracles::Fault& truth) {
    if (accepted == truth.what.empty() || !truth.certain || !verdict_.failure.empty()) return;
    verdict_.failure =
        std::string(check) + (accepted ? " accepts a mesh, but: " + truth.what : " rejects a good mesh: " + said);
  }
  void expect(const char* check, const VerifyReport& report, const oracles::Fault& truth) {
    expect(check, report.accepted(), first_message(report), truth);
  }

 private:
  static std::string first_message(const VerifyReport& report) {
    for (const Flaw flaw : first_ids<Flaw>(kFlawCount))
      if (report.findings.count(flaw) > 0)
        return std::string(flaw_name(flaw)) + ": " + report.findings.messages(flaw).front();
    return "";
  }

  MeshVerdict& verdict_;
};

/// Judges what is read, which need not be what was written: most of a mesh is counterclockwise then, and tiny
/// coordinates are 0. A refusal is right for what is wrong.
void check_file(const MeshSample& sample, const Mesh& mesh, const std::string& path, const VerifyOptions& options,
                Comparison& compare) {
  try {
    write_mesh(mesh, path);
    const Mesh read = read_mesh(path);
    compare.expect("verify of a file", verify(read, sample.input, options),
                   oracles::fault_of(read, sample.input, sample.mesh));
  } catch (const Error& error) {
    compare.expect("a reader", false, error.what(), oracles::fault_of(mesh, sample.input, sample.mesh));
  }
}

}  // namespace

MeshVerdict judge(const MeshSample& sample, const Mesh& mesh, std::uint64_t seed, const std::string& folder) {
  MeshVerdict verdict;
  Comparison compare(verdict);
  const oracles::Fault alone = oracles::fault_of(mesh), truth = oracles::fault_of(mesh, sample.input, sample.mesh);
  verdict.fault = truth.what;
  VerifyOptions options{.plain = {.region_areas = false}, .threads = 1 + seed % 3};
  compare.expect("verify by itself", verify(mesh, options), alone);
  const VerifyReport whole = verify(mesh, sample.input, options);
  compare.expect("verify", whole, truth);
  verdict.accepted = whole.accepted();

  MeshOptions asked{.min_angle = 0, .region_areas = false, .threads = 1};
  const CheckReport report = check(mesh, sample.input, asked);
  compare.expect("check", report.accepted, report.verdict, truth);
  if (!truth.what.empty()) {  // good ones may miss these bounds
    asked = {
        .min_angle = 25, .max_area = 1, .size = [](const Point& p) { return 0.5 + p.x * p.x; }, .size_resolution = 50};
    const CheckReport bounded = check(mesh, sample.input, asked);
    compare.expect("check with bounds", bounded.accepted, bounded.verdict, truth);
  }
  if (truth.in_arrays) return verdict;

  const std::vector<Mesh> pieces = pieces_of(mesh, seed);
  compare.expect("verify_pieces by themselves", verify_pieces(pieces, nullptr, options), alone);
  compare.expect("verify_pieces", verify_pieces(pieces, &sample.input, options), truth);
  if (seed % 8 != 0) return verdict;  // files wait for the disk
  constexpr std::array kFiles{"/mesh.vtu", "/mesh.ele", "/mesh.msh"};
  std::filesystem::create_directories(folder);
  check_file(sample, mesh, folder + kFiles[seed / 8 % 3], options, compare);
  return verdict;
}

}  // namespace driftmesh::mutants
