#include "distributed/mesh_bytes.hpp"

#include "pslg/names.hpp"

namespace driftmesh {
namespace {

// The fields in one order for both directions: `stream` is a ByteWriter with a const mesh, or a ByteReader.
template <class Stream, class M>
void transfer(Stream& stream, M& mesh) {
  stream.array(mesh.points);
  stream.array(mesh.triangles);
  stream.array(mesh.edges);
  stream.array(mesh.point_markers);
  stream.array(mesh.attributes);
  stream.value(mesh.attributes_per_point);
  stream.array(mesh.regions);
  stream.array(mesh.numbers);
  stream.array(mesh.subdomains);
  stream.array(mesh.ranks);
  transfer_names(stream, mesh.names);
}

}  // namespace

Bytes mesh_to_bytes(const Mesh& mesh) {
  ByteWriter writer;
  transfer(writer, mesh);
  return writer.take();
}

Mesh mesh_of(const Mail& mail) {
  Mesh mesh;
  read_mail(mail, [&](ByteReader& reader) { transfer(reader, mesh); });
  return mesh;
}

}  // namespace driftmesh
