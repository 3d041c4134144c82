#include "app/mesh_input.hpp"

#include <cstdint>
#include <iostream>
#include <utility>
#include <vector>

#include "adapt/session.hpp"
#include "base/bytes.hpp"
#include "distributed/parts_file.hpp"
#include "distributed/ranks.hpp"
#include "io/mesh_file.hpp"
#include "job/domain.hpp"
#include "job/rasters.hpp"
#include "patch/point_data.hpp"

namespace driftmesh::app {
namespace {

MeshInput read_session(const std::string& path, bool with_depths) {
  OneRank alone;
  adapt::Saved saved = adapt::read_saved(path, alone);
  MeshInput input{{}, saved.head};
  ByteReader reader(saved.head.more);
  job::Rasters rasters = job::Rasters::read(reader);
  if (with_depths)
    open_all(rasters, job::box_of(saved.head.pslg), {});
  else
    rasters.depth.clear();
  const adapt::Session session(std::move(saved), [&](Mesh& mesh) { set_point_data(rasters, mesh); }, {alone});
  input.mesh = session.piece().mesh;
  input.mesh.numbers.clear();  // only for points of a piece
  input.mesh.ranks.clear();
  input.session->fields = session.fields();
  return input;
}

/// Calls visit(name, values) for each component of a field.
template <class Visit>
void visit_components(const std::string& name, const adapt::Field& field, const Visit& visit) {
  for (std::size_t k = 0; k < field.components; ++k) {
    std::vector<double> values;
    for (std::size_t i = k; i < field.values.size(); i += field.components) values.push_back(field.values[i]);
    visit(name_of_component(name, field.components, k), std::move(values));
  }
}

/// Behind what the mesh has at its points. `data`: null: those at triangles are left out.
void give_fields(Mesh& mesh, const adapt::Fields& fields, const std::string& path, TriangleData* data) {
  std::vector<patch::NamedField> columns;
  for (const auto& named : fields) {
    const adapt::Field& field = named.second;
    visit_components(named.first, field, [&](const std::string& name, std::vector<double> values) {
      if (field.place == FieldPlace::kPoints)
        columns.push_back({name, {.values = std::move(values)}});
      else if (field.place == FieldPlace::kTriangles && data != nullptr)
        data->try_emplace(name, std::move(values));
      else
        std::cerr << "warning: " << path << ": '" << name << "' at " << adapt::words_of(field.place)
                  << " is left out\n";
    });
  }
  if (columns.empty()) return;
  std::vector<patch::NamedField> own = patch::take_point_data(mesh);
  if (mesh.attribute_names.empty() && own.size() == 1) own.front().name = "attribute0";  // no name for one of several
  columns.insert(columns.begin(), own.begin(), own.end());
  std::vector<adapt::Field> values;
  mesh.attribute_names.clear();
  for (patch::NamedField& column : columns) {
    mesh.attribute_names.push_back(column.name);
    values.push_back(std::move(column.field));
  }
  mesh.attributes_per_point = static_cast<std::int32_t>(columns.size());
  patch::give_point_data(mesh, values);
}

Mesh read_with_fields(const std::string& path, TriangleData* data) {
  MeshInput input = read_session(path, true);
  give_fields(input.mesh, input.session->fields, path, data);
  return std::move(input.mesh);
}

}  // namespace

std::string mesh_inputs() {
  return mesh_files_read() + ", or a saved adaptive mesh";
}

bool is_saved_session(const std::string& path) {
  return is_parts_file(path, kAdaptiveMeshFile);
}

MeshInput read_to_check(const std::string& path, const ReadOptions& options) {
  return is_saved_session(path) ? read_session(path, false) : MeshInput{read_mesh(path, options)};
}

Mesh read_any_mesh(const std::string& path, const ReadOptions& options) {
  return is_saved_session(path) ? read_with_fields(path, nullptr) : read_mesh(path, options);
}

Mesh read_any_mesh(const std::string& path, const ReadOptions& options, TriangleData& data) {
  return is_saved_session(path) ? read_with_fields(path, &data) : read_mesh(path, options, data);
}

}  // namespace driftmesh::app
