#include "distributed/write_mfem.hpp"

#include <algorithm>
#include <utility>

#include "distributed/rank_status.hpp"
#include "driftmesh/id_vector.hpp"
#include "io/msh_groups.hpp"

namespace driftmesh {

WriteMfem::WriteMfem(const DistributedPiece& piece, std::string path)
    : piece_(piece),
      path_(std::move(path)),
      part_{.mesh = piece.mesh, .boundary = {}, .region_tags = {}, .marker_tags = {}} {
  find_rim();
  group_points();
}

std::vector<Mail> WriteMfem::send(int round) {
  if (round == 0) return describe();
  return status_to_all(piece_.ranks, [&] {
    if (round == 1)
      file_ = prepare_mfem(part_, mfem_part_path(path_, to_int(piece_.rank)));
    else
      file_->commit();
  });
}

std::vector<Rank> WriteMfem::senders(int /*round*/) const {
  return all_ranks(piece_.ranks);
}

void WriteMfem::receive(int round, std::vector<Mail> mail) {
  if (round == 0)
    learn(mail);
  else
    throw_first_failure(mail);
}

/// An edge that is met twice lies inside.
void WriteMfem::find_rim() {
  const std::vector<std::int64_t>& numbers = piece_.mesh.numbers;
  for (const auto& triangle : piece_.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      Edge edge{triangle[i], triangle[(i + 1) % 3]};
      if (numbers[to_index(edge[0])] > numbers[to_index(edge[1])]) std::swap(edge[0], edge[1]);
      const Ends ends{numbers[to_index(edge[0])], numbers[to_index(edge[1])]};
      if (const auto [met, is_new] = rim_.try_emplace(ends, edge); !is_new) rim_.erase(met);
    }
}

/// Points ascend by number within each group, so all ranks have the same order.
void WriteMfem::group_points() {
  std::map<std::int32_t, std::vector<std::int32_t>> others;  // the other ranks that have each shared point
  for (const DistributedPiece::Neighbor& neighbor : piece_.neighbors)
    for (const std::int32_t v : neighbor.shared) others[v].push_back(to_int(neighbor.rank));
  for (auto& [point, ranks] : others) {
    ranks.push_back(to_int(piece_.rank));
    std::ranges::sort(ranks);
    group_of(ranks).points.push_back(point);
  }
}

MfemGroup& WriteMfem::group_of(const std::vector<std::int32_t>& ranks) {
  return groups_.try_emplace(ranks, MfemGroup{.ranks = ranks, .points = {}}).first->second;
}

std::vector<WriteMfem::Ends> WriteMfem::rim_along(const DistributedPiece::Neighbor& with) const {
  const std::set<std::int32_t> shared(with.shared.begin(), with.shared.end());
  std::vector<Ends> along;
  for (const auto& [ends, edge] : rim_)
    if (shared.contains(edge[0]) && shared.contains(edge[1])) along.push_back(ends);
  return along;
}

std::vector<Mail> WriteMfem::describe() const {
  const std::set<double> regions(piece_.mesh.regions.begin(), piece_.mesh.regions.end());
  std::set<double> markers;
  for (const Mesh::Edge& edge : piece_.mesh.edges) markers.insert(edge.marker);
  std::vector<Mail> mail;
  for (const Rank to : all_ranks(piece_.ranks)) {
    const auto with = std::ranges::find(piece_.neighbors, to, &DistributedPiece::Neighbor::rank);
    ByteWriter writer;
    writer.array(std::vector<double>(regions.begin(), regions.end()));
    writer.array(std::vector<double>(markers.begin(), markers.end()));
    writer.array(with == piece_.neighbors.end() ? std::vector<Ends>{} : rim_along(*with));
    mail.push_back({to, writer.take()});
  }
  return mail;
}

/// An edge on the rims of two ranks lies between them.
void WriteMfem::learn(const std::vector<Mail>& mail) {
  std::set<double> all_regions, all_markers;
  for (const Mail& from : mail) {
    std::vector<double> regions, markers;
    std::vector<Ends> rim;
    read_mail(from, [&](ByteReader& reader) {
      reader.array(regions);
      reader.array(markers);
      reader.array(rim);
    });
    all_regions.insert(regions.begin(), regions.end());
    all_markers.insert(markers.begin(), markers.end());
    if (from.rank == piece_.rank) continue;
    const auto [low, high] = std::minmax({to_int(piece_.rank), to_int(from.rank)});
    for (const Ends& ends : rim)
      if (const auto own = rim_.find(ends); own != rim_.end()) {
        group_of({low, high}).edges.push_back(own->second);
        rim_.erase(own);
      }
  }
  part_.region_tags = tags_of_values(all_regions);
  part_.marker_tags = tags_of_values(all_markers);
  bound();
}

void WriteMfem::bound() {
  const std::vector<std::int64_t>& numbers = piece_.mesh.numbers;
  for (std::size_t e = 0; e < piece_.mesh.edges.size(); ++e) {
    const auto [low, high] =
        std::minmax(numbers[to_index(piece_.mesh.edges[e].a)], numbers[to_index(piece_.mesh.edges[e].b)]);
    if (rim_.contains({low, high})) part_.boundary.push_back(static_cast<std::int32_t>(e));
  }
  part_.groups.push_back({.ranks = {to_int(piece_.rank)}, .points = {}});
  for (auto& [ranks, group] : groups_) part_.groups.push_back(std::move(group));
}

}  // namespace driftmesh
