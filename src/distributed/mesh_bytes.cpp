#include "distributed/mesh_bytes.hpp"

#include "pslg/names.hpp"

namespace driftmesh {

Bytes mesh_to_bytes(const Mesh& mesh) {
  ByteWriter writer;
  writer.array(mesh.points);
  writer.array(mesh.triangles);
  writer.array(mesh.edges);
  writer.array(mesh.point_markers);
  writer.array(mesh.attributes);
  writer.value(mesh.attributes_per_point);
  writer.array(mesh.regions);
  writer.array(mesh.numbers);
  writer.array(mesh.subdomains);
  writer.array(mesh.ranks);
  transfer_names(writer, mesh.names);
  return writer.take();
}

Mesh mesh_of(const Mail& mail) {
  Mesh mesh;
  read_mail(mail, [&](ByteReader& reader) {
    reader.array(mesh.points);
    reader.array(mesh.triangles);
    reader.array(mesh.edges);
    reader.array(mesh.point_markers);
    reader.array(mesh.attributes);
    reader.value(mesh.attributes_per_point);
    reader.array(mesh.regions);
    reader.array(mesh.numbers);
    reader.array(mesh.subdomains);
    reader.array(mesh.ranks);
    transfer_names(reader, mesh.names);
  });
  return mesh;
}

}  // namespace driftmesh
