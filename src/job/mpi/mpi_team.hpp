#pragma once

#include <memory>
#include <string>
#include <vector>

#include "job/team.hpp"
#include "protocol/mpi/mpi_transport.hpp"

namespace driftmesh::job {

/// The ranks of an MPI communicator, named by its Fortran handle; MPI has been initialized. Construction and close()
/// are collective. `words`: those of a message that ends the job.
class MpiTeam final : public Team {
 public:
  explicit MpiTeam(int communicator, Words words = full_name);

  [[nodiscard]] Rank rank() const override { return control_.rank(); }
  [[nodiscard]] std::int32_t ranks() const override { return control_.ranks(); }
  [[nodiscard]] std::string host() const override { return protocol::MpiSession::host(); }
  [[nodiscard]] int ranks_on_machine() const override { return ranks_on_machine_; }
  [[nodiscard]] Bytes broadcast(Bytes bytes) override;
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes) override;
  [[nodiscard]] std::unique_ptr<Channel> open() override;
  [[noreturn]] void abort(const KeyText& message, int code) override;

  /// Shuts down cleanly. Without it, pending messages of other ranks are not waited for.
  void close() { control_.close(); }

 private:
  int communicator_;
  Words words_;
  int ranks_on_machine_;
  protocol::MpiTransport control_;  // for messages between runs
};

}  // namespace driftmesh::job
