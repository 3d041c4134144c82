#include "study/pdr/lattice_refinement.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace driftmesh::pdr {
namespace {

bool ends_turn(int round) {
  return round % Lattice::kColors == Lattice::kColors - 1;
}

void write(ByteWriter& writer, const Point& p) {
  writer.number(p.x);
  writer.number(p.y);
}

Point read_point(ByteReader& reader) {
  const auto x = reader.number<double>();
  const auto y = reader.number<double>();
  return {x, y};
}

void write(ByteWriter& writer, const Change& change) {
  writer.number(to_int(change.root));
  if (change.root != kNone) return writer.number(change.path);
  for (const Point* p : {&change.point, &change.from, &change.to}) write(writer, *p);
}

Change read_change(ByteReader& reader) {
  Change change;
  change.root = RootId{reader.number<std::int32_t>()};
  if (change.root != kNone)
    change.path = reader.number<dyadic::Path>();
  else
    for (Point* p : {&change.point, &change.from, &change.to}) *p = read_point(reader);
  return change;
}

}  // namespace

LatticeRefinement::LatticeRefinement(Rank rank, std::int32_t ranks, Triangulation& mesh, const QualityBounds& bounds,
                                     const Lattice& lattice)
    : rank_(rank),
      ranks_(ranks),
      lattice_(lattice),
      refiner_(mesh, bounds, lattice),
      neighbors_(lattice.neighbors_of(rank)) {}

std::vector<Mail> LatticeRefinement::send(int round) {
  std::map<Rank, std::vector<const Change*>> told;
  for (const Rank r : senders(round)) told[r];
  const auto all = refiner_.refine(rank_, round % Lattice::kColors);
  for (const auto& changes : all)
    for (const Rank r : lattice_.followers_of(changes.cell))
      for (const Change& change : changes.list) told.at(r).push_back(&change);
  changed_ |= !all.empty();
  std::vector<Mail> mail;
  for (const auto& [rank, changes] : told) {
    ByteWriter writer;
    writer.number(std::uint8_t{changed_});
    writer.number(std::uint64_t{changes.size()});
    for (const Change* change : changes) write(writer, *change);
    mail.push_back({rank, writer.take()});
    ++traffic_.messages;
    traffic_.bytes += static_cast<std::int64_t>(mail.back().bytes.size());
    traffic_.points += static_cast<std::int64_t>(changes.size());
  }
  return mail;
}

/// At the end of a turn, everybody hears whether anything was done.
std::vector<Rank> LatticeRefinement::senders(int round) const {
  if (!ends_turn(round)) return neighbors_;
  std::vector<Rank> others = all_ranks(ranks_);
  std::erase(others, rank_);
  return others;
}

void LatticeRefinement::receive(int round, std::vector<Mail> mail) {
  std::vector<Change> changes;
  bool others_changed = false;
  for (const Mail& one : mail)
    read_mail(one, [&](ByteReader& reader) {
      others_changed |= reader.number<std::uint8_t>() != 0;
      const auto count = reader.number<std::uint64_t>();
      for (std::uint64_t i = 0; i < count; ++i) changes.push_back(read_change(reader));
    });
  refiner_.repeat(changes);
  if (!ends_turn(round)) return;
  if (changed_ || others_changed) rounds_ += Lattice::kColors;
  changed_ = false;
}

}  // namespace driftmesh::pdr
