#include "adapt/move.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "adapt/parcel.hpp"
#include "base/bytes.hpp"

namespace driftmesh::adapt {
namespace {

/// Sends parts that leave, and returns those that arrive.
std::vector<Parcel> swap_parcels(const Generation& generation, const Fields& fields,
                                 const IdVector<SubdomainId, Rank>& holders, Ranks& ranks) {
  std::map<Rank, ByteWriter> to_others;
  std::set<Rank> senders;
  for (const SubdomainId s : ids_of(holders)) {
    if (holders[s] == generation.holders[s]) continue;
    if (generation.is_here(s)) to_others[holders[s]].array(pack(generation, s, fields));
    if (holders[s] == ranks.rank()) senders.insert(generation.holders[s]);
  }
  std::vector<Mail> mail;
  for (auto& [rank, writer] : to_others) mail.push_back({rank, writer.take()});
  std::vector<Parcel> parcels;
  for (const Mail& from : ranks.deliver(std::move(mail), {senders.begin(), senders.end()}))
    for (ByteReader reader(from.bytes); !reader.at_end();) {
      Bytes bytes;
      reader.array(bytes);
      parcels.push_back(unpack_parcel(bytes, Source::kThisRun));
    }
  return parcels;
}

/// Where what stayed since the last generation is now, for a part that has not moved.
void take_stayed(const Held& present, const Generation& next, SubdomainId s, Holding& to) {
  const Generation& now = present.generation;
  for (const VertexId v : ids_of(next.places[s]))
    if (next.places[s][v] != kNone && !present.stayed.points.empty())
      to.stayed.points[to_index(next.places[s][v])] = present.stayed.points[to_index(now.places[s][v])];
  if (!present.stayed.triangles.empty())
    std::copy_n(present.stayed.triangles.begin() + now.first_triangle[s], next.parts[s].mesh->mesh.live_triangles(),
                to.stayed.triangles.begin() + next.first_triangle[s]);
}

}  // namespace

Holding moved(const Held& present, const IdVector<SubdomainId, Rank>& holders,
              const std::function<Generation(Parts)>& assemble, Ranks& ranks) {
  std::vector<Parcel> parcels = swap_parcels(present.generation, present.fields, holders, ranks);
  Parts parts = present.generation.parts;
  for (const SubdomainId s : present.generation.here)
    if (holders[s] != ranks.rank()) parts[s] = {};
  for (const Parcel& parcel : parcels) parts[parcel.id] = parcel.part;
  Holding next{assemble(std::move(parts)), {}, {}};
  const Mesh& mesh = next.generation.piece.mesh;
  next.fields = without_values(present.fields, next.generation.piece);
  next.stayed.points.assign(present.stayed.points.empty() ? 0 : mesh.points.size(), -1);
  next.stayed.triangles.assign(present.stayed.triangles.empty() ? 0 : mesh.triangles.size(), -1);
  for (const Parcel& parcel : parcels) set_values_on(next.generation, parcel.id, parcel.values, next.fields);
  for (const SubdomainId s : next.generation.here) {
    if (!present.generation.is_here(s)) continue;
    set_values_on(next.generation, s, values_on(present.generation, s, present.fields), next.fields);
    take_stayed(present, next.generation, s, next);
  }
  return next;
}

}  // namespace driftmesh::adapt
