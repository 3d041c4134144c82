#include "job/mpi/mpi_team.hpp"

#include <utility>

namespace driftmesh::job {
namespace {

class MpiChannel final : public Channel {
 public:
  explicit MpiChannel(int communicator) : transport_(communicator) {}
  [[nodiscard]] protocol::Transport& transport() override { return transport_; }
  void close() override { transport_.close(); }

 private:
  protocol::MpiTransport transport_;
};

}  // namespace

MpiTeam::MpiTeam(int communicator, Words words)
    : communicator_(communicator),
      words_(std::move(words)),
      ranks_on_machine_(protocol::MpiSession::ranks_on_this_machine(communicator)),
      control_(communicator) {}

Bytes MpiTeam::broadcast(Bytes bytes) {
  return control_.broadcast(std::move(bytes));
}

std::vector<Bytes> MpiTeam::gather(const Bytes& bytes) {
  return control_.gather(bytes);
}

std::unique_ptr<Channel> MpiTeam::open() {
  return std::make_unique<MpiChannel>(communicator_);
}

void MpiTeam::abort(const KeyText& message, int code) {
  protocol::MpiSession::abort(message.in(words_), code);
}

}  // namespace driftmesh::job
