#include "mutants/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "decompose/decomposition_file.hpp"
#include "decompose/same_segments.hpp"
#include "driftmesh/decomposition.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/files.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box.hpp"
#include "geometry/predicates.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mutants/declared_mesh.hpp"
#include "mutants/declared_msh.hpp"
#include "mutants/declared_su2.hpp"
#include "mutants/declared_tables.hpp"
#include "mutants/declared_vtu.hpp"
#include "mutants/settings_check.hpp"
#include "sizing/make_size_field.hpp"
#include "support/varied_domain.hpp"
#include "verify/verify.hpp"

namespace driftmesh::mutants {
namespace {

constexpr std::size_t kLongestMessage = 4000;

std::string stem_of(const std::string& name) {
  return name.substr(0, name.rfind('.') + 1);
}

/// "" for a message that helps its reader.
std::string fault_of_message(const std::string& message, const std::string& stem) {
  if (message.size() < 10 || message.size() > kLongestMessage)
    return "a message of " + std::to_string(message.size()) + " bytes";
  if (std::ranges::any_of(message, [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7f; }))
    return "a message with control characters";
  return message.find(stem) == std::string::npos ? "a message that names no file" : "";
}

/// Runs both readers. `compare` returns how the read thing differs from the declared one.
template <class Read, class Declare, class Compare>
Verdict compared(const Sample& sample, const Read& read, const Declare& declare, const Compare& compare) {
  Verdict verdict;
  std::optional<decltype(declare())> declared;
  try {
    declared = declare();
    verdict.declared = true;
  } catch (const Undeclared& undeclared) {
    verdict.message = undeclared.what();
  }
  try {
    const auto found = read();
    verdict.accepted = true;
    verdict.failure = declared ? compare(found, *declared) : "accepted, but nothing is declared: " + verdict.message;
  } catch (const Undeclared& undeclared) {  // by the comparison
    verdict.failure = std::string("accepted, but nothing is declared: ") + undeclared.what();
  } catch (const Error& error) {
    verdict.message = error.what();
    verdict.failure = verdict.accepted
                          ? "accepted, but then: " + verdict.message
                          : fault_of_message(verdict.message, sample.main.substr(0, sample.main.rfind('.')));
  }
  return verdict;
}

/// Points, segments and markers as a mesh has them; then what only a domain has.
std::string difference_of_domains(const Pslg& read, const Pslg& declared) {
  const auto as_mesh = [](const Pslg& pslg) {
    Mesh mesh;
    mesh.points = pslg.points;
    mesh.points.insert(mesh.points.end(), pslg.holes.begin(), pslg.holes.end());
    mesh.point_markers = pslg.point_markers;
    mesh.attributes = pslg.attributes;
    mesh.attributes_per_point = pslg.attributes_per_point;
    for (const Pslg::Segment& s : pslg.segments) mesh.edges.push_back({s.a, s.b, s.marker});
    return mesh;
  };
  if (read.holes.size() != declared.holes.size()) return "another number of holes";
  if (read.regions != declared.regions) return "other regions";
  if (read.first_number != declared.first_number) return "another first number";
  return difference(as_mesh(read), as_mesh(declared));
}

Verdict judge_domain(const Sample& sample, const Files& files, const std::string& folder) {
  const std::string path = folder + "/" + sample.main;
  return compared(
      sample, [&] { return read_poly(path); }, [&] { return declared_domain(files, sample.main); },
      [&](Pslg read, const Pslg& declared) {
        const std::string found = difference_of_domains(read, declared);
        try {
          (void)repair(read, path);
        } catch (const InputError&) {
          // What it describes may have no area.
        }
        return found;
      });
}

Mesh declared_mesh(const Files& files, const std::string& name) {
  if (!files.contains(name) && !name.ends_with(".ele") && !name.ends_with(".node")) throw Undeclared("no file");
  Fields ignored;
  if (name.ends_with(".vtu")) return declared_vtu(files.at(name), ignored);
  if (name.ends_with(".pvtu")) return declared_pvtu(files, name);
  if (name.ends_with(".msh")) return declared_msh(files.at(name), ignored);
  if (name.ends_with(".su2")) return declared_su2(files.at(name));
  return declared_triangle_mesh(files, stem_of(name));
}

Verdict judge_mesh(const Sample& sample, const Files& files, const std::string& folder) {
  return compared(
      sample, [&] { return read_mesh(folder + "/" + sample.main); }, [&] { return declared_mesh(files, sample.main); },
      difference);
}

bool is_close(double a, double b) {
  return a == b || std::fabs(a - b) <= 1e-6 * std::fabs(b);
}

using BackgroundHandle = std::shared_ptr<const BackgroundFunction>;

/// How many triangles hold the point, by rounded arithmetic.
std::size_t count_at(const Point& p, const BackgroundMesh& mesh) {
  const auto is_left = [&](const Point& a, const Point& b) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0;
  };
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
    const auto [a, b, c] = mesh.corners(static_cast<std::int32_t>(t));
    count += is_left(a, b) && is_left(b, c) && is_left(c, a);
  }
  return count;
}

/// At the centroids of triangles that are neither slivers nor covered by others.
std::string difference_of_lengths(const BackgroundHandle& read, const DeclaredBackground& declared) {
  const BackgroundMesh& mesh = *read->mesh();
  for (std::size_t t = 0; t < declared.mesh.triangles.size(); ++t) {
    const auto index = static_cast<std::int32_t>(t);
    const auto [a, b, c] = mesh.corners(index);
    const Point centroid{a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3};
    const Box box = Box::of(std::array{a, b, c});
    const double width = box.high.x - box.low.x, height = box.high.y - box.low.y;
    const double area = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    if (!(area > 0.01 * width * width + 0.01 * height * height) || count_at(centroid, mesh) != 1) continue;
    double expected = 0;
    if (declared.areas.empty())
      for (const std::int32_t v : declared.mesh.triangles[t])
        expected += declared.lengths[static_cast<std::size_t>(v)] / 3;
    else
      expected = declared.areas[t] > 0 ? std::sqrt(declared.areas[t] * 4 / std::sqrt(3.0)) : INFINITY;
    if (!is_close(read->at(centroid), expected)) return "another length in triangle " + std::to_string(t);
  }
  return "";
}

std::string difference_of_backgrounds(const BackgroundHandle& read, const DeclaredBackground& declared) {
  Mesh found, expected = declared.mesh;
  found.points = read->mesh()->points();
  found.triangles = read->mesh()->triangles();
  for (auto& [a, b, c] : expected.triangles) {
    const auto at = [&](std::int32_t v) { return expected.points[static_cast<std::size_t>(v)]; };
    if (orient2d(at(a), at(b), at(c)) < 0) std::swap(b, c);
  }
  expected.regions.clear();
  const std::string other = difference(found, expected);
  return other.empty() ? difference_of_lengths(read, declared) : other;
}

Verdict judge_background(const Sample& sample, const Files& files, const std::string& folder) {
  return compared(
      sample, [&] { return read_background(folder + "/" + sample.main, std::nullopt); },
      [&] { return declared_background(files, stem_of(sample.main), sample.reading == Reading::kAreas); },
      difference_of_backgrounds);
}

std::string difference_of_decompositions(const Decomposition& read, const Decomposition& declared) {
  if (!(read.points == declared.points && read.origin == declared.origin)) return "other points";
  if (!(read.roots == declared.roots)) return "other roots";
  if (!(read.subdomains == declared.subdomains)) return "other subdomains";
  const bool same_points = read.point_begin == declared.point_begin && read.point_list == declared.point_list;
  return same_points ? "" : "other inner points";
}

/// What is wrong with the mesh that is made with a decomposition.
std::string fault_of_its_mesh(const Decomposition& decomposition) {
  MeshOptions options;
  options.max_area = kDecomposedArea;
  options.subdomains.given = std::make_shared<const Decomposition>(decomposition);
  VerifyOptions bounds;
  bounds.plain.area = options.max_area;
  bounds.min_angle = options.min_angle;
  const Pslg domain = testing::varied_domain();
  const VerifyReport report = verify(mesh(domain, options), domain, bounds);
  return report.accepted() ? "" : "a mesh that is not one of the domain";
}

Verdict judge_decomposition(const Sample& sample, const Files& files, const std::string& folder) {
  std::optional<std::string> fault;  // what is wrong with the mesh
  const auto read = [&] {
    const std::string path = folder + "/" + sample.main;
    Decomposition decomposition = read_decomposition(path, testing::varied_domain());
    Triangulation domain = triangulate(testing::varied_domain());
    prepare_corners(domain);
    require_same_segments(decomposition, domain, path);
    fault = fault_of_its_mesh(decomposition);
    return decomposition;
  };
  return compared(
      sample, read,
      [&] {
        if (!files.contains(sample.main)) throw Undeclared("no file");
        return declared_decomposition(files.at(sample.main));
      },
      [&](const Decomposition& found, const Decomposition& declared) {
        const std::string other = difference_of_decompositions(found, declared);
        return other.empty() ? *fault : other;
      });
}

/// Settings declare what was read from them, as far as check() finds no fault.
template <class Read, class Check>
Verdict judge_settings(const Sample& sample, const Files& files, const std::string& folder, const Read& read,
                       const Check& check) {
  Verdict verdict = compared(
      sample, [&] { return read(folder + "/" + sample.main); },
      [&] {
        if (!files.contains(sample.main)) throw Undeclared("no file");
        return std::string_view(files.at(sample.main));
      },
      [&](const auto& found, std::string_view text) { return check(found, text, folder); });
  verdict.declared = verdict.accepted;
  return verdict;
}

}  // namespace

Verdict judge(const Sample& sample, const Files& files, const std::string& folder) {
  switch (sample.reading) {
    case Reading::kDomain:
      return judge_domain(sample, files, folder);
    case Reading::kMesh:
      return judge_mesh(sample, files, folder);
    case Reading::kLengths:
    case Reading::kAreas:
      return judge_background(sample, files, folder);
    case Reading::kDecomposition:
      return judge_decomposition(sample, files, folder);
    case Reading::kSettings:
      return judge_settings(sample, files, folder, config::read_settings, check_settings);
    case Reading::kExperiment:
      return judge_settings(
          sample, files, folder, [](const std::string& path) { return config::read_experiment(path, {}); },
          check_experiment);
  }
  return {};
}

}  // namespace driftmesh::mutants
