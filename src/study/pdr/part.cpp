#include "study/pdr/part.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace driftmesh::pdr {
namespace {

bool ends_turn(int round) {
  return round % Lattice::kColors == Lattice::kColors - 1;
}

/// The fields in one order for both directions: `stream` is a ByteWriter with a const change, or a ByteReader.
template <class Stream, class AnyChange>
void transfer(Stream& stream, AnyChange& change) {
  stream.value(change.root);
  if (change.root != kNone) return stream.value(change.path);
  for (auto* p : {&change.point, &change.from, &change.to}) stream.value(*p);
}

}  // namespace

Part::Part(Rank rank, std::int32_t ranks, Triangulation started, const Lattice& lattice, const QualityBounds& bounds,
           std::function<void()> worked)
    : rank_(rank),
      ranks_(ranks),
      mesh_(std::move(started)),
      lattice_(lattice),
      cells_(mesh_, bounds, lattice_),
      worked_(std::move(worked)) {
  const auto near = lattice.neighbors_of(rank);
  neighbors_.assign(near.begin(), near.end());
}

std::vector<Mail> Part::send(int round) {
  const auto all = cells_.refine(rank_, round % Lattice::kColors);
  worked_();
  changed_ |= !all.empty();
  std::map<Rank, std::vector<Change>> heard;
  for (const Rank r : senders(round)) heard[r];
  for (const auto& [cell, changes] : all)
    for (const Rank r : lattice_.followers_of(cell))
      heard.at(r).insert(heard.at(r).end(), changes.begin(), changes.end());
  std::vector<Mail> mail;
  for (const auto& [rank, changes] : heard) {
    ByteWriter writer;
    writer.value(changed_);
    writer.number(std::uint64_t{changes.size()});
    for (const Change& change : changes) transfer(writer, change);
    mail.push_back({rank, writer.take()});
    told_ += static_cast<std::int64_t>(changes.size());
  }
  return mail;
}

/// At the end of a turn, everybody hears whether anything was done.
std::vector<Rank> Part::senders(int round) const {
  if (!ends_turn(round)) return neighbors_;
  std::vector<Rank> others = all_ranks(ranks_);
  std::erase(others, rank_);
  return others;
}

void Part::receive(int round, std::vector<Mail> mail) {
  std::vector<Change> changes;
  bool others_changed = false;
  for (const Mail& one : mail)
    read_mail(one, [&](ByteReader& reader) {
      others_changed |= reader.value<std::uint8_t>() != 0;
      for (auto left = reader.number<std::uint64_t>(); left > 0; --left) transfer(reader, changes.emplace_back());
    });
  cells_.repeat(changes);
  worked_();
  if (!ends_turn(round)) return;
  if (changed_ || others_changed) rounds_ += Lattice::kColors;
  changed_ = false;
}

job::MeshFacts Part::keep_own(const QualityBounds& bounds) {
  for (const TriangleId t : ids_of(mesh_.triangles))
    if (mesh_.triangles[t].alive() && lattice_.owner_of(cells_.cell_of(t)) != rank_) mesh_.remove_triangle(t);
  job::MeshFacts facts;
  job::add_part(facts, mesh_, bounds, true);
  job::add_counters(facts, cells_.own_counters());
  const auto owns = [&](VertexId v) { return lattice_.owner_of(lattice_.cell_of(mesh_.points[v])) == rank_; };
  facts.vertices =
      std::ranges::count_if(ids_of(mesh_.points), [&](VertexId v) { return mesh_.origin[v] != kDeleted && owns(v); });
  facts.subsegments =
      std::ranges::count_if(mesh_.subsegments, [&](const Subsegment& s) { return s.is_leaf() && owns(s.vertex[0]); });
  return facts;
}

}  // namespace driftmesh::pdr
