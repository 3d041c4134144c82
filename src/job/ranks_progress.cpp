#include "job/ranks_progress.hpp"

#include <array>
#include <ctime>
#include <numeric>
#include <utility>

#include "base/formatted.hpp"
#include "base/key_error.hpp"
#include "driftmesh/id_vector.hpp"

namespace driftmesh::job {
namespace {

constexpr double kEvery = 0.2;  // seconds
constexpr Rank kListener{0};

/// What a rank tells.
struct Told {
  std::int64_t triangles = 0;
  bool is_done = false;
  std::string doing;
};

Bytes bytes_of(const Told& told) {
  ByteWriter writer;
  writer.value(told.triangles);
  writer.value(told.is_done);
  writer.text(told.doing);
  return writer.take();
}

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
#ifdef _WIN32
  localtime_s(&parts, &now);
#else
  localtime_r(&now, &parts);
#endif
  std::array<char, 16> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%H:%M:%S", &parts)};
}

/// The host of each rank, on every rank. Collective.
std::vector<std::string> hosts_of(Team& team) {
  ByteWriter own;
  own.text(team.host());
  ByteWriter all;
  for (const Bytes& host : team.gather(own.take())) all.raw(host);
  const Bytes shared = team.broadcast(all.take());
  ByteReader reader(shared);
  std::vector<std::string> hosts;
  for (std::int32_t k = 0; k < team.ranks(); ++k) hosts.push_back(reader.text());
  return hosts;
}

}  // namespace

RanksProgress::RanksProgress(Team& team, const Request::Patience& patience, std::function<KeyText()> left)
    : channel_(team.open()),
      watched_{(to_int(team.rank()) + team.ranks() - 1) % team.ranks()},
      watcher_{(to_int(team.rank()) + 1) % team.ranks()},
      patience_(patience),
      left_(std::move(left)),
      triangles_(to_index(team.ranks()), 0),
      told_(channel_->transport().now()),
      heard_(told_),
      next_line_(patience.silence) {
  name_ = "rank " + to_string(watched_) + " on " + hosts_of(team)[to_index(watched_)];
}

void RanksProgress::note(const std::string& doing) {
  if (!doing_.starts_with(doing + " since ")) doing_ = doing + " since " + time_of_day();
}

void RanksProgress::tell_now(std::int64_t own, const std::string& doing) {
  const double now = channel_->transport().now();
  const std::string before = doing_;
  note(doing);
  if (doing_ == before && now - told_ < kEvery) return;
  told_ = heard_ = now;  // it has not listened itself
  send(own, false);
}

bool RanksProgress::tell(std::int64_t own, const std::string& doing) {
  protocol::Transport& transport = channel_->transport();
  note(doing);
  const double now = transport.now();
  if (now - told_ < kEvery) return false;
  hear();
  if (now - told_ > 2 * kEvery && now - told_ > patience_.silence / 2) heard_ = now;  // this rank was away itself
  told_ = now;
  send(own, false);
  return transport.rank() == kListener;
}

void RanksProgress::send(std::int64_t own, bool is_done) {
  protocol::Transport& transport = channel_->transport();
  triangles_[to_index(transport.rank())] = own;
  const Bytes bytes = bytes_of({own, is_done, doing_});
  transport.send(watcher_, bytes);
  if (transport.rank() != kListener && watcher_ != kListener) transport.send(kListener, bytes);
}

void RanksProgress::hear() {
  while (const auto received = channel_->transport().poll()) {
    ByteReader reader(received->bytes);
    triangles_[to_index(received->source)] = reader.value<std::int64_t>();
    const bool is_done = reader.value<bool>();
    done_ += is_done ? 1 : 0;
    if (received->source != watched_) continue;
    heard_ = channel_->transport().now();
    is_done_ = is_done_ || is_done;  // what was sent before may come after it
    watched_doing_ = reader.text();
  }
}

std::string RanksProgress::silence() {
  const double quiet = channel_->transport().now() - heard_;
  if (is_done_) return {};
  if (quiet < patience_.silence) {
    next_line_ = patience_.silence;
    return std::exchange(is_named_, false) ? name_ + " answers again" : std::string();
  }
  const std::string line = name_ + " has not answered for " + formatted("{:.0f}", quiet) + " s" +
                           (watched_doing_.empty() ? "" : ", " + watched_doing_);
  if (patience_.give_up > 0 && quiet >= patience_.give_up)
    throw Keyed<Error>(KeyText::of("{}; given up after {} s ({run.give-up}). {}", line,
                                   formatted("{:g}", patience_.give_up),
                                   left_ ? left_() : KeyText("Nothing was written")));
  if (quiet < next_line_) return {};
  next_line_ = 2 * quiet;
  is_named_ = true;
  return line + "; the others wait for it";
}

std::int64_t RanksProgress::triangles() const {
  return std::accumulate(triangles_.begin(), triangles_.end(), std::int64_t{0});
}

void RanksProgress::close(std::int64_t own, const std::function<void()>& news) {
  protocol::Transport& transport = channel_->transport();
  send(own, true);
  while (!is_done_ || (transport.rank() == kListener && done_ + 1 < transport.ranks())) {
    hear();
    news();
    transport.idle();
  }
  channel_->close();
}

}  // namespace driftmesh::job
