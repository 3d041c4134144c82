#include "distributed/mesh_bytes.hpp"

#include <cstdint>
#include <type_traits>

#include "pslg/names.hpp"

namespace driftmesh {
namespace {

template <class Stream, class Weir>
void transfer_weir(Stream& stream, Weir& weir) {
  stream.value(weir.type);
  stream.array(weir.points);
  stream.array(weir.across);
  stream.array(weir.values);
}

template <class Stream, class Weirs>
void transfer_weirs(Stream& stream, Weirs& weirs) {
  auto count = static_cast<std::uint64_t>(weirs.size());
  stream.value(count);
  if constexpr (!std::is_const_v<Weirs>)
    for (std::uint64_t i = 0; i < count; ++i) transfer_weir(stream, weirs.emplace_back());
  else
    for (const Mesh::Weir& weir : weirs) transfer_weir(stream, weir);
}

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
  transfer_weirs(stream, mesh.weirs);
  if constexpr (std::is_same_v<Stream, ByteWriter>) {
    stream.text(mesh.coordinates);
    stream.value(std::uint64_t{mesh.attribute_names.size()});
    for (const std::string& name : mesh.attribute_names) stream.text(name);
  } else {
    mesh.coordinates = stream.text();
    for (auto left = stream.template value<std::uint64_t>(); left > 0; --left)
      mesh.attribute_names.push_back(stream.text());
  }
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
