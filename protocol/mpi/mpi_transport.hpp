#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/transport.hpp"

/// The only part of the protocol that knows MPI. Communicators are named by their Fortran handles (MPI_Comm_c2f), which
/// the MPI standard makes plain integers: whoever includes this needs no mpi.h.
namespace driftmesh::protocol {

/// MPI, from its initialization to its end. One object, made by the main thread before all others. If MPI has been
/// initialized already, by a library, it is left to who did that to end it.
class MpiSession {
 public:
  MpiSession();
  /// The same, for tests whose main function has its arguments at hand.
  MpiSession(int& argc, char**& argv);
  /// Finalizes MPI, which waits for all ranks. Not to be reached with a failure in hand: call abort instead.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] static int world();  ///< MPI_COMM_WORLD
  /// The rank as which mpirun or its like has started this process, if they did; known before MPI is initialized.
  [[nodiscard]] static std::optional<Rank> launched_as();
  /// Which MPI this is, and its version: "Open MPI v4.1.4". Works before MPI is initialized, too.
  [[nodiscard]] static std::string library();
  /// Ranks of the communicator that share this machine's memory. All of them call it together.
  [[nodiscard]] static int ranks_on_this_machine(int communicator);

  /// Prints `message` on stderr and stops all ranks; mpiexec exits with `code`. Works, as an exit of this process
  /// alone, without MPI too.
  [[noreturn]] static void abort(const std::string& message, int code = EXIT_FAILURE);

 private:
  bool began_ = false;
};

/// Messages between the ranks of an MPI communicator. It works on a duplicate of its own, so that it can neither take
/// messages of another library nor lose its own to one. No call waits for another rank but those that all ranks of the
/// communicator make together: construction, broadcast, gather, all_gather and close.
class MpiTransport final : public Transport {
 public:
  explicit MpiTransport(int communicator);
  /// Without close() before, gives up: what is being sent may or may not arrive. For errors only.
  ~MpiTransport() override;

  [[nodiscard]] Rank rank() const override;
  [[nodiscard]] std::int32_t ranks() const override;
  void send(Rank destination, Bytes bytes) override;
  std::optional<Received> poll() override;
  void idle() override;
  [[nodiscard]] double now() const override;

  /// The `bytes` of rank 0, on every rank. All ranks of the communicator call it together.
  [[nodiscard]] Bytes broadcast(Bytes bytes);
  /// On rank 0 the bytes of every rank; nothing elsewhere. All ranks call it together. Throws LimitError for more than
  /// 2 GiB in all: for reports, not for meshes.
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes);

  /// The bytes of every rank, on every rank. All ranks call it together. Throws LimitError for more than 2 GiB in all.
  [[nodiscard]] std::vector<Bytes> all_gather(const Bytes& bytes);
  /// The duplicate that it works on, for what all ranks do together.
  [[nodiscard]] int communicator() const;

  /// Ends it in good order: waits until all that was sent has been received. Throws ProtocolError if a message has
  /// arrived that nobody polled.
  void close();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftmesh::protocol
