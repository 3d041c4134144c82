#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "distributed/exchange.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/ghosted_piece.hpp"

namespace driftmesh {

/// Adds a ring of ghost triangles to the piece of each rank. In one round, every rank tells every rank how many
/// triangles it has in which subdomain, from which their numbers in the whole mesh follow, and sends each neighbor the
/// triangles at the points that they share.
///
/// Throws ProtocolError, naming the sender, for triangles without points, and for subdomains that two ranks have.
class GhostLayer final : public Exchange {
 public:
  /// The piece outlives the object.
  explicit GhostLayer(const DistributedPiece& piece) : piece_(piece) {}

  [[nodiscard]] int rounds() const override { return 1; }
  [[nodiscard]] std::vector<Mail> send(int round) override;
  [[nodiscard]] std::vector<Rank> senders(int round) const override;
  void receive(int round, std::vector<Mail> mail) override;

  /// After the exchange, once.
  [[nodiscard]] GhostedPiece take() { return std::move(result_); }

 private:
  /// Triangles of one subdomain, which one rank has one after the other.
  struct Block {
    std::int64_t subdomain = 0;  // as wide as the other, so that messages have no padding
    std::int64_t triangles = 0;
  };
  /// What a neighbor sends: a part of its piece.
  struct Part {
    Rank rank{};
    Mesh mesh;
    std::vector<Rank> owners;           ///< one for each point
    std::vector<std::int64_t> offsets;  ///< numbers of its triangles in their subdomains
  };

  [[nodiscard]] std::vector<Block> own_blocks() const;
  [[nodiscard]] std::vector<std::int32_t> triangles_at(const std::vector<std::int32_t>& points) const;
  [[nodiscard]] Part part_of(const std::vector<std::int32_t>& triangles) const;
  [[nodiscard]] std::vector<Part> read(const std::vector<Mail>& mail);
  void begin_with_piece();
  void learn_blocks(Rank from, const std::vector<Block>& blocks);
  void number_subdomains();
  void add_points(const std::vector<Part>& parts);
  void add_triangles(const std::vector<Part>& parts);
  void add_edges(const std::vector<Part>& parts);
  [[nodiscard]] std::int32_t place_of(std::int64_t number) const;

  const DistributedPiece& piece_;
  std::map<Rank, std::vector<std::int32_t>> sent_;  // triangles
  std::map<std::int64_t, std::int64_t> first_;      // each subdomain's number of triangles; then of its first one
  GhostedPiece result_;
};

}  // namespace driftmesh
