#include "app/report_frames.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <utility>

#include "app/mesh_input.hpp"
#include "app/run_files.hpp"
#include "base/words.hpp"
#include "driftmesh/error.hpp"
#include "io/mesh_file.hpp"
#include "io/pvd_file.hpp"
#include "patch/point_data.hpp"

namespace driftmesh::app {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// A path with * for each number, and the numbers, each as its length and digits, so that they compare as numbers do.
struct NumberedName {
  std::string pattern;
  std::vector<std::pair<std::size_t, std::string>> numbers;
};

NumberedName numbered(const std::string& path) {
  NumberedName name;
  for (std::size_t at = 0; at < path.size();) {
    if (!is_digit(path[at])) {
      name.pattern += path[at++];
      continue;
    }
    std::string digits;
    for (; at < path.size() && is_digit(path[at]); ++at)
      if (!digits.empty() || path[at] != '0') digits += path[at];
    name.pattern += '*';
    name.numbers.emplace_back(digits.size(), digits);
  }
  return name;
}

std::string file_name(const std::string& path) {
  return fs::path(path).filename().string();
}

/// Sorts files whose names differ in numbers alone, and gives the name of all.
void order(FrameFiles& frames) {
  const std::string pattern = numbered(frames.files.front().path).pattern;
  frames.name = file_name(frames.files.front().path);
  if (frames.files.size() == 1) return;
  if (!std::ranges::all_of(frames.files, [&](const auto& file) { return numbered(file.path).pattern == pattern; })) {
    frames.name += " and " + grouped(static_cast<std::int64_t>(frames.files.size()) - 1) + " more";
    return;
  }
  std::ranges::stable_sort(frames.files, {}, [](const auto& file) { return numbered(file.path).numbers; });
  frames.name = file_name(pattern);
}

/// Data of a frame, at its points or triangles.
struct Data {
  std::vector<patch::NamedField> at_points;
  TriangleData at_triangles;

  [[nodiscard]] std::vector<double>* find(const std::string& name, bool points) {
    if (!points) {
      const auto found = at_triangles.find(name);
      return found == at_triangles.end() ? nullptr : &found->second;
    }
    const auto found = std::ranges::find(at_points, name, &patch::NamedField::name);
    return found == at_points.end() ? nullptr : &found->field.values;
  }

  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& [name, field] : at_points) all.insert(name);
    for (const auto& [name, values] : at_triangles) all.insert(name);
    return all;
  }
};

/// "'u', 'v'"
std::string list_of(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "'" : ", '") + name + "'";
  return list;
}

/// The field that is meant.
std::string chosen(const std::string& wanted, const Data& data, const std::string& path) {
  const std::set<std::string> names = data.names();
  if (names.empty())
    throw InputError({path, 0}, "has no data at points or triangles", "name meshes with the field that is to be shown");
  if (!wanted.empty()) {
    if (!names.contains(wanted))
      throw InputError({path, 0}, "has no field '" + wanted + "'", "it has " + list_of(names));
    return wanted;
  }
  if (names.size() > 1) throw InputError({path, 0}, "has the fields " + list_of(names), "choose one with --field");
  return *names.begin();
}

std::string at(bool points) {
  return points ? "at points" : "at triangles";
}

Mesh read_frame(const std::string& path, const ReadOptions& options, Data& data) {
  Mesh mesh = read_any_mesh(path, options, data.at_triangles);
  if (mesh.triangles.empty()) throw InputError({path, 0}, "has no triangles", "name meshes");
  if (!mesh.numbers.empty()) throw InputError({path, 0}, "is a piece of a mesh", "name the .pvtu that it belongs to");
  data.at_points = patch::take_point_data(mesh);
  return mesh;
}

}  // namespace

bool holds_frames(const std::string& path) {
  return fs::path(path).extension() == ".pvd" || is_mesh_file(path);
}

FrameFiles list_frames(const std::vector<std::string>& paths, FileRegistry& registry, const ReadOptions& options) {
  FrameFiles frames;
  bool has_times = false;
  for (const std::string& path : paths) {
    if (fs::path(path).extension() != ".pvd") {
      frames.files.push_back({path});
      continue;
    }
    has_times = true;
    registry.reads(path, "RUN");
    for (const PvdMesh& mesh : read_pvd(path, options)) frames.files.push_back({mesh.path, mesh.time});
  }
  if (has_times)
    frames.name = file_name(paths.front());
  else
    order(frames);
  for (const auto& file : frames.files) register_mesh_input(registry, file.path, "RUN", options);
  return frames;
}

PackedFrames pack_frames(const FrameFiles& frames, const std::string& field, std::size_t most_triangles,
                         const ReadOptions& options) {
  std::optional<PackedFrames> packed;
  std::string name;
  bool at_points = false;
  for (const auto& [path, time] : frames.files) {
    Data data;
    const Mesh mesh = read_frame(path, options, data);
    if (!packed) {
      name = chosen(field, data, path);
      at_points = data.find(name, true) != nullptr;
      packed.emplace(frames.name, name, at_points);
    }
    const std::vector<double>* const values = data.find(name, at_points);
    if (values == nullptr && data.find(name, !at_points) != nullptr)
      throw InputError({path, 0}, "has '" + name + "' " + at(!at_points) + ", and frames before it " + at(at_points),
                       "write it at the same place in all frames");
    if (values == nullptr)
      throw InputError({path, 0}, "has no field '" + name + "', which frames before it have",
                       "name frames that have it");
    packed->add(mesh, *values, time);
    if (packed->triangles() > most_triangles)
      throw InputError({path, 0},
                       "with the frames before it, " + grouped(static_cast<std::int64_t>(packed->triangles())) +
                           " triangles, and a page shows at most " + grouped(static_cast<std::int64_t>(most_triangles)),
                       "name fewer frames, such as every second one");
  }
  return std::move(*packed);
}

}  // namespace driftmesh::app
