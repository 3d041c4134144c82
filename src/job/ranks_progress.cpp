#include "job/ranks_progress.hpp"

#include <numeric>

#include "driftmesh/id_vector.hpp"

namespace driftmesh::job {
namespace {

constexpr double kEvery = 0.2;  // seconds
constexpr Rank kListener{0};

/// What a rank tells.
struct Count {
  std::int64_t triangles = 0;
  bool is_done = false;
};

Bytes bytes_of(const Count& count) {
  ByteWriter writer;
  writer.value(count.triangles);
  writer.value(count.is_done);
  return writer.take();
}

}  // namespace

RanksProgress::RanksProgress(Team& team)
    : channel_(team.open()), triangles_(to_index(team.ranks()), 0), last_(channel_->transport().now()) {}

bool RanksProgress::tell(std::int64_t own) {
  protocol::Transport& transport = channel_->transport();
  const double now = transport.now();
  if (now - last_ < kEvery) return false;
  last_ = now;
  triangles_[to_index(transport.rank())] = own;
  if (transport.rank() == kListener) {
    hear();
    return true;
  }
  transport.send(kListener, bytes_of({own, false}));
  return false;
}

bool RanksProgress::hear() {
  bool any = false;
  while (const auto received = channel_->transport().poll()) {
    ByteReader reader(received->bytes);
    triangles_[to_index(received->source)] = reader.value<std::int64_t>();
    done_ += reader.value<bool>() ? 1 : 0;
    any = true;
  }
  return any;
}

std::int64_t RanksProgress::triangles() const {
  return std::accumulate(triangles_.begin(), triangles_.end(), std::int64_t{0});
}

void RanksProgress::close(std::int64_t own, const std::function<void()>& show) {
  protocol::Transport& transport = channel_->transport();
  if (transport.rank() == kListener) {
    triangles_[to_index(kListener)] = own;
    while (done_ + 1 < transport.ranks()) {
      if (hear())
        show();
      else
        transport.idle();
    }
  } else {
    transport.send(kListener, bytes_of({own, true}));
  }
  channel_->close();
}

}  // namespace driftmesh::job
