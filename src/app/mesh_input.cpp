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

/// The components of a field at points.
void add_columns(const std::string& name, const adapt::Field& field, std::vector<patch::NamedField>& columns) {
  for (std::size_t k = 0; k < field.components; ++k) {
    patch::NamedField& column = columns.emplace_back();
    column.name = field.components == 1 ? name : name + "_" + std::to_string(k);
    for (std::size_t i = k; i < field.values.size(); i += field.components)
      column.field.values.push_back(field.values[i]);
  }
}

/// Behind what the mesh has at its points.
void give_fields(Mesh& mesh, const adapt::Fields& fields, const std::string& path) {
  std::vector<patch::NamedField> columns;
  for (const auto& [name, field] : fields) {
    if (field.place == FieldPlace::kPoints)
      add_columns(name, field, columns);
    else
      std::cerr << "warning: " << path << ": field '" << name << "' is left out, since it is not at points\n";
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
  if (!is_saved_session(path)) return read_mesh(path, options);
  MeshInput input = read_session(path, true);
  give_fields(input.mesh, input.session->fields, path);
  return std::move(input.mesh);
}

}  // namespace driftmesh::app
