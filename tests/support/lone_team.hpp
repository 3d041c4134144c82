#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/key_error.hpp"
#include "job/team.hpp"

namespace driftmesh::testing {

/// This process alone, without channels.
class LoneTeam final : public job::Team {
 public:
  [[nodiscard]] Rank rank() const override { return Rank{0}; }
  [[nodiscard]] std::int32_t ranks() const override { return 1; }
  [[nodiscard]] std::string host() const override { return "here"; }
  [[nodiscard]] int ranks_on_machine() const override { return 1; }
  [[nodiscard]] Bytes broadcast(Bytes bytes) override { return bytes; }
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes) override { return {bytes}; }
  [[nodiscard]] std::unique_ptr<job::Channel> open() override { return nullptr; }
  [[noreturn]] void abort(const KeyText& message, int) override { throw Keyed<Error>(message); }
};

}  // namespace driftmesh::testing
