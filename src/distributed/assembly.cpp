#include "distributed/assembly.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/bytes.hpp"
#include "distributed/piece_builder.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {

namespace {

struct HeldEntry {
  SubdomainId subdomain{};
  Rank rank{};
  std::int64_t points = 0;
  std::int64_t triangles = 0;
};

void read_announcement(const Mail& mail, std::vector<HeldEntry>& entries) {
  read_mail(mail, [&](ByteReader& reader) {
    for (auto left = reader.value<std::uint32_t>(); left > 0; --left) {
      HeldEntry& entry = entries.emplace_back();
      entry.rank = mail.rank;
      reader.value(entry.subdomain);
      reader.value(entry.points);
      reader.value(entry.triangles);
    }
  });
}

void write_root(ByteWriter& writer, const NumberedRoot& r) {
  writer.value(r.root);
  writer.value(r.splits);
  writer.value(r.first_number);
}

std::vector<NumberedRoot> read_roots(const Mail& mail) {
  std::vector<NumberedRoot> roots;
  read_mail(mail, [&](ByteReader& reader) {
    for (auto left = reader.value<std::uint32_t>(); left > 0; --left) {
      NumberedRoot& r = roots.emplace_back();
      reader.value(r.root);
      reader.value(r.splits);
      reader.value(r.first_number);
    }
  });
  return roots;
}

[[noreturn]] void wrong_holders(SubdomainId subdomain, const std::vector<HeldEntry>& entries) {
  std::string ranks;
  for (const HeldEntry& entry : entries)
    if (entry.subdomain == subdomain) ranks += (ranks.empty() ? "" : " and ") + to_string(entry.rank);
  throw Error("subdomain " + to_string(subdomain) + " is held by " + (ranks.empty() ? "no rank" : "ranks " + ranks) +
              ": migration lost or duplicated it");
}

std::string root_words(const Decomposition& d, GlobalRootId r) {
  const Decomposition::Root& root = d.roots[r];
  return "root " + to_string(r) + " between subdomains " + to_string(root.left) + " and " + to_string(root.right);
}

std::string holds_words(Rank rank, const protocol::SplitDigest& splits) {
  return "rank " + to_string(rank) + " has " + std::to_string(splits.count) + " points on it";
}

[[noreturn]] void do_not_conform(const Decomposition& d, GlobalRootId r, Rank one, const protocol::SplitDigest& of_one,
                                 Rank other, const protocol::SplitDigest& of_other) {
  throw Error("the mesh does not conform at " + root_words(d, r) + ": " + holds_words(one, of_one) + ", " +
              holds_words(other, of_other) +
              (of_one.count == of_other.count ? ", not the same: SPLITs were lost" : ": SPLITs were lost"));
}

}  // namespace

PieceAssembly::PieceAssembly(Rank rank, std::int32_t ranks, const Decomposition& decomposition,
                             const HeldSubdomains& held)
    : PieceAssembly(rank, ranks, decomposition, held, take_census(decomposition, held)) {}

PieceAssembly::PieceAssembly(Rank rank, std::int32_t ranks, const Decomposition& decomposition, HeldSubdomains held,
                             std::vector<SubdomainCensus> census)
    : rank_(rank), ranks_(ranks), decomposition_(decomposition), held_(std::move(held)), census_(std::move(census)) {
  for (const SubdomainCensus& subdomain : census_)
    for (const SubdomainCensus::Root& root : subdomain.roots) roots_.push_back({root.root, root.splits, -1});
  const auto by_root = [](const NumberedRoot& a, const NumberedRoot& b) { return a.root < b.root; };
  std::sort(roots_.begin(), roots_.end(), by_root);
  const auto same = [](const NumberedRoot& a, const NumberedRoot& b) { return a.root == b.root; };
  compare_own_sides();
  roots_.erase(std::unique(roots_.begin(), roots_.end(), same), roots_.end());
}

/// Both sides of a root are adjacent in roots_.
void PieceAssembly::compare_own_sides() const {
  for (std::size_t k = 1; k < roots_.size(); ++k) {
    const NumberedRoot &one = roots_[k - 1], &other = roots_[k];
    if (one.root == other.root && !(one.splits == other.splits))
      do_not_conform(decomposition_, one.root, rank_, one.splits, rank_, other.splits);
  }
}

std::vector<Mail> PieceAssembly::send(int round) {
  return round == 0 ? announce() : describe_roots();
}

std::vector<Rank> PieceAssembly::senders(int round) const {
  return round == 0 ? all_ranks(ranks_) : neighbors_;
}

void PieceAssembly::receive(int round, std::vector<Mail> mail) {
  if (round == 0) {
    learn_subdomains(mail);
    number_owned_roots();
  } else {
    for (const Mail& message : mail) learn_roots(message);
  }
}

std::vector<Mail> PieceAssembly::announce() const {
  ByteWriter writer;
  writer.value(static_cast<std::uint32_t>(census_.size()));
  for (const SubdomainCensus& census : census_) {
    writer.value(census.id);
    writer.value(owned_points(decomposition_, census));
    writer.value(census.triangles);
  }
  const Bytes message = writer.take();
  std::vector<Mail> mail;
  for (const Rank to : first_ids<Rank>(ranks_)) mail.push_back({to, message});
  return mail;
}

void PieceAssembly::learn_subdomains(const std::vector<Mail>& mail) {
  std::vector<HeldEntry> entries;
  for (const Mail& message : mail) read_announcement(message, entries);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.subdomain < b.subdomain; });
  auto entry_of = entries.begin();
  for (const SubdomainId i : ids_of(decomposition_.subdomains)) {
    if (entry_of == entries.end()) wrong_holders(i, entries);
    if (entry_of->subdomain != i) wrong_holders(std::min(i, entry_of->subdomain), entries);
    ++entry_of;
  }
  if (entry_of != entries.end()) wrong_holders(entry_of->subdomain, entries);

  subdomains_.points = static_cast<std::int64_t>(decomposition_.points.size());
  for (const HeldEntry& entry : entries) {
    subdomains_.rank.push_back(entry.rank);
    subdomains_.first_number.push_back(subdomains_.points);
    subdomains_.points += entry.points;
    subdomains_.triangles += entry.triangles;
  }
}

void PieceAssembly::number_owned_roots() {
  for (const SubdomainCensus& census : census_) {
    std::int64_t next = subdomains_.first_number[census.id];
    for (const SubdomainCensus::Root& r : census.roots) {
      if (owner_of(decomposition_.roots[r.root]) != census.id) continue;
      find_root(roots_, r.root)->first_number = next;
      next += static_cast<std::int64_t>(r.splits.count);
    }
  }
}

std::vector<Mail> PieceAssembly::describe_roots() {
  std::map<Rank, std::vector<const NumberedRoot*>> shared;
  for (const NumberedRoot& r : roots_) {
    const Decomposition::Root& root = decomposition_.roots[r.root];
    for (const SubdomainId side : {root.left, root.right})
      if (side != kNoSubdomain && holder(side) != rank_) shared[holder(side)].push_back(&r);
  }
  std::vector<Mail> mail;
  for (const auto& [to, roots] : shared) {
    neighbors_.push_back(to);
    ByteWriter writer;
    writer.value(static_cast<std::uint32_t>(roots.size()));
    for (const NumberedRoot* r : roots) write_root(writer, *r);
    mail.push_back({to, writer.take()});
  }
  return mail;
}

void PieceAssembly::learn_roots(const Mail& mail) {
  for (const NumberedRoot& theirs : read_roots(mail)) {
    NumberedRoot* const own = find_root(roots_, theirs.root);
    if (own == nullptr)
      throw protocol::ProtocolError(mail.rank, "it describes root " + to_string(theirs.root) + ", which rank " +
                                                   to_string(rank_) +
                                                   " does not have; start all ranks with the same decomposition");
    if (!(theirs.splits == own->splits))
      do_not_conform(decomposition_, own->root, rank_, own->splits, mail.rank, theirs.splits);
    if (own->first_number < 0) own->first_number = theirs.first_number;
  }
}

DistributedPiece PieceAssembly::piece(const Pslg& pslg, PiecePlaces* places) const {
  DistributedPiece piece = PieceBuilder(rank_, decomposition_, subdomains_, roots_, census_).build(held_, pslg, places);
  piece.ranks = ranks_;
  return piece;
}

}  // namespace driftmesh
