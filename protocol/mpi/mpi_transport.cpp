#include "protocol/mpi/mpi_transport.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include "base/narrow.hpp"
#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {
namespace {

constexpr int kTag = 0;  // for all messages: no one else uses the communicator

// After this many empty polls in a row, a rank sleeps before it polls again.
constexpr int kPatience = 2000;
constexpr std::chrono::microseconds kNap{20};

constexpr std::size_t kBroadcastPart = std::size_t{1} << 30;  // MPI counts with an int

/// Returns whether this call initialized MPI.
bool begin_mpi(int* argc, char*** argv) {
  int initialized = 0, provided = 0;
  MPI_Initialized(&initialized);
  if (initialized == 0) MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
  return initialized == 0;
}

/// A rank of Open MPI tells mpirun that it finalizes, and waits two seconds for the answer. If mpirun gets no processor
/// for longer, it learns of that and of the end of the process at the same time, and may take the latter for a crash: a
/// run that has done all its work would end with an error. So a rank that may not have been heard stays a little
/// longer.
void end_mpi() {
  constexpr std::chrono::seconds kAnswer{2}, kHearing{2};
  const auto start = std::chrono::steady_clock::now();
  MPI_Finalize();
  if (MpiSession::launched_as() && std::chrono::steady_clock::now() - start >= kAnswer)
    std::this_thread::sleep_for(kHearing);
}

}  // namespace

MpiSession::MpiSession() : began_(begin_mpi(nullptr, nullptr)) {}

MpiSession::MpiSession(int& argc, char**& argv) : began_(begin_mpi(&argc, &argv)) {}

MpiSession::~MpiSession() {
  if (began_) end_mpi();
}

int MpiSession::world() {
  return MPI_Comm_c2f(MPI_COMM_WORLD);
}

std::optional<Rank> MpiSession::launched_as() {
  // Open MPI, MPICH and derivatives, Slurm.
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (const char* rank = std::getenv(name)) return Rank{std::atoi(rank)};
  return std::nullopt;
}

std::string MpiSession::library() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string all(text, to_index(length));
  return all.substr(0, all.find_first_of(",\n"));
}

std::string MpiSession::host() {
  char text[MPI_MAX_PROCESSOR_NAME];
  int length = 0;
  MPI_Get_processor_name(text, &length);
  return {text, to_index(length)};
}

int MpiSession::ranks_on_this_machine(int communicator) {
  MPI_Comm machine = MPI_COMM_NULL;
  int ranks = 1;
  MPI_Comm_split_type(MPI_Comm_f2c(communicator), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &ranks);
  MPI_Comm_free(&machine);
  return ranks;
}

void MpiSession::abort(const std::string& message, int code) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::fflush(stderr);
  int initialized = 0, finalized = 0;
  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  if (initialized != 0 && finalized == 0) MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

class MpiTransport::Impl {
 public:
  explicit Impl(int communicator) {
    MPI_Comm_dup(MPI_Comm_f2c(communicator), &communicator_);
    int rank = 0;
    MPI_Comm_rank(communicator_, &rank);
    rank_ = Rank{rank};
    MPI_Comm_size(communicator_, &ranks_);
  }

  [[nodiscard]] Rank rank() const { return rank_; }
  [[nodiscard]] std::int32_t ranks() const { return ranks_; }

  void send(Rank destination, Bytes bytes) {
    if (to_index(destination) >= to_index(ranks_))
      throw LimitError("rank " + to_string(rank_) + " sends to rank " + to_string(destination) + " of " +
                       std::to_string(ranks_));
    const int size = narrow<int>(bytes.size(), "bytes of one message");
    if (destination == rank_) {
      to_self_.push_back({rank_, std::move(bytes)});
      return;
    }
    if (++sent_since_look_ > 16 + sending_.size() / 2) forget_sent();
    sending_.push_back(std::move(bytes));
    requests_.emplace_back();
    MPI_Isend(sending_.back().data(), size, MPI_BYTE, to_int(destination), kTag, communicator_, &requests_.back());
  }

  std::optional<Received> poll() {
    auto message = next();
    if (message) idle_polls_ = 0;
    return message;
  }

  void idle() {
    forget_sent();
    if (++idle_polls_ < kPatience)
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(kNap);
  }

  Bytes broadcast(Bytes bytes) {
    auto size = static_cast<std::uint64_t>(bytes.size());
    MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator_);
    bytes.resize(size);
    for (std::size_t done = 0; done < size; done += kBroadcastPart) {
      const auto part = static_cast<int>(std::min<std::size_t>(kBroadcastPart, size - done));
      MPI_Bcast(bytes.data() + done, part, MPI_BYTE, 0, communicator_);
    }
    return bytes;
  }

  std::vector<Bytes> gather(const Bytes& bytes) {
    const int size = narrow<int>(bytes.size(), "bytes of a report");
    Parts parts(rank_ == Rank{0} ? ranks_ : 0);
    MPI_Gather(&size, 1, MPI_INT, parts.sizes.data(), 1, MPI_INT, 0, communicator_);
    parts.place();
    MPI_Gatherv(bytes.data(), size, MPI_BYTE, parts.bytes.data(), parts.sizes.data(), parts.begin.data(), MPI_BYTE, 0,
                communicator_);
    return parts.divided();
  }

  void close() {
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    requests_.clear();
    sending_.clear();
    if (const auto message = poll()) throw ProtocolError(message->source, "arrived after the end of the run");
    MPI_Comm_free(&communicator_);
  }

 private:
  // Contributions of several ranks, concatenated.
  struct Parts {
    std::vector<int> sizes, begin;
    Bytes bytes;

    explicit Parts(int count) : sizes(to_index(count)) {}
    // Allocates space once the sizes are known.
    void place() {
      std::size_t total = 0;
      for (const int size : sizes) {
        begin.push_back(narrow<int>(total, "bytes of all reports"));
        total += to_index(size);
      }
      static_cast<void>(narrow<int>(total, "bytes of all reports"));
      bytes.resize(total);
    }
    [[nodiscard]] std::vector<Bytes> divided() const {
      std::vector<Bytes> parts;
      for (std::size_t r = 0; r < sizes.size(); ++r)
        parts.emplace_back(bytes.begin() + begin[r], bytes.begin() + begin[r] + sizes[r]);
      return parts;
    }
  };

  // A message that has been announced and is being transferred: large ones take several polls.
  struct Incoming {
    Received message;
    MPI_Request request;
  };

  std::optional<Received> next() {
    if (!to_self_.empty()) {
      Received message = std::move(to_self_.front());
      to_self_.pop_front();
      return message;
    }
    if (auto message = next_complete()) return message;
    return next_announced();
  }

  std::optional<Received> next_complete() {
    for (auto incoming = incoming_.begin(); incoming != incoming_.end(); ++incoming) {
      int complete = 0;
      MPI_Test(&incoming->request, &complete, MPI_STATUS_IGNORE);
      if (complete == 0) continue;
      Received message = std::move(incoming->message);
      incoming_.erase(incoming);
      return message;
    }
    return std::nullopt;
  }

  // Starts to receive announced messages until one completes immediately.
  std::optional<Received> next_announced() {
    for (;;) {
      int announced = 0, size = 0;
      MPI_Message handle = MPI_MESSAGE_NULL;
      MPI_Status status;
      MPI_Improbe(MPI_ANY_SOURCE, kTag, communicator_, &announced, &handle, &status);
      if (announced == 0) return std::nullopt;
      MPI_Get_count(&status, MPI_BYTE, &size);
      Incoming incoming{{Rank{status.MPI_SOURCE}, Bytes(to_index(size))}, MPI_REQUEST_NULL};
      MPI_Imrecv(incoming.message.bytes.data(), size, MPI_BYTE, &handle, &incoming.request);
      int complete = 0;
      MPI_Test(&incoming.request, &complete, MPI_STATUS_IGNORE);
      if (complete != 0) return std::move(incoming.message);
      incoming_.push_back(std::move(incoming));
    }
  }

  // Frees the buffers of sent messages. A completed request becomes MPI_REQUEST_NULL.
  void forget_sent() {
    sent_since_look_ = 0;
    if (requests_.empty()) return;
    completed_.resize(requests_.size());
    int count = 0;
    MPI_Testsome(static_cast<int>(requests_.size()), requests_.data(), &count, completed_.data(), MPI_STATUSES_IGNORE);
    if (count == 0 || count == MPI_UNDEFINED) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      if (requests_[i] == MPI_REQUEST_NULL) continue;
      if (kept != i) {
        requests_[kept] = requests_[i];
        sending_[kept] = std::move(sending_[i]);  // the bytes themselves are not moved
      }
      ++kept;
    }
    requests_.resize(kept);
    sending_.resize(kept);
  }

  MPI_Comm communicator_ = MPI_COMM_NULL;
  Rank rank_{};
  int ranks_ = 0;
  std::deque<Received> to_self_;
  std::vector<Incoming> incoming_;
  std::vector<Bytes> sending_;  // parallel to requests_
  std::vector<MPI_Request> requests_;
  std::vector<int> completed_;
  std::size_t sent_since_look_ = 0;
  int idle_polls_ = 0;
};

MpiTransport::MpiTransport(int communicator) : impl_(std::make_unique<Impl>(communicator)) {}

// MPI may still read the buffers of messages that are being sent: leak them.
MpiTransport::~MpiTransport() {
  static_cast<void>(impl_.release());
}

Rank MpiTransport::rank() const {
  return impl_->rank();
}
std::int32_t MpiTransport::ranks() const {
  return impl_->ranks();
}
void MpiTransport::send(Rank destination, Bytes bytes) {
  impl_->send(destination, std::move(bytes));
}
std::optional<Received> MpiTransport::poll() {
  return impl_->poll();
}
void MpiTransport::idle() {
  impl_->idle();
}
double MpiTransport::now() const {
  return MPI_Wtime();
}
Bytes MpiTransport::broadcast(Bytes bytes) {
  return impl_->broadcast(std::move(bytes));
}
std::vector<Bytes> MpiTransport::gather(const Bytes& bytes) {
  return impl_->gather(bytes);
}
void MpiTransport::close() {
  impl_->close();
  impl_.reset();
}

}  // namespace driftmesh::protocol
