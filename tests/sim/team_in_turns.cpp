#include "sim/team_in_turns.hpp"

#include <algorithm>

#include "base/key_text.hpp"

namespace driftmesh::sim {
namespace {

constexpr double kMessage = 0.001;  // seconds that a rank takes to send or receive one

class InTurns final : public protocol::Transport {
 public:
  InTurns(Post& post, int channel, Rank rank, std::int32_t ranks)
      : post_(post), channel_(channel), rank_(rank), ranks_(ranks) {}

  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return ranks_; }
  void send(Rank destination, Bytes bytes) override { post_.send(channel_, rank_, destination, std::move(bytes)); }
  std::optional<protocol::Received> poll() override { return post_.poll(channel_, rank_); }
  void idle() override { post_.wait(channel_, rank_); }
  [[nodiscard]] double now() const override { return post_.turns().now(); }

 private:
  Post& post_;
  int channel_;
  Rank rank_;
  std::int32_t ranks_;
};

class ChannelInTurns final : public job::Channel {
 public:
  explicit ChannelInTurns(std::unique_ptr<InTurns> transport) : transport_(std::move(transport)) {}
  [[nodiscard]] protocol::Transport& transport() override { return *transport_; }
  void close() override {}

 private:
  std::unique_ptr<InTurns> transport_;
};

std::unique_ptr<job::Channel> channel(Post& post, int number, Rank rank, std::int32_t ranks) {
  return std::make_unique<ChannelInTurns>(std::make_unique<InTurns>(post, number, rank, ranks));
}

}  // namespace

void Post::send(int channel, Rank from, Rank to, Bytes bytes) {
  turns_.spend(from, kMessage);
  boxes_[{channel, to}].push_back({turns_.now() + turns_.delay(from), {from, std::move(bytes)}});
  turns_.wake(to);
}

std::optional<protocol::Received> Post::poll(int channel, Rank to) {
  turns_.spend(to, kMessage);
  std::vector<Parcel>& box = boxes_[{channel, to}];
  std::vector<std::size_t> here;
  for (std::size_t i = 0; i < box.size(); ++i)
    if (box[i].arrives <= turns_.now()) here.push_back(i);
  if (here.empty()) return std::nullopt;
  const auto at = box.begin() + static_cast<std::ptrdiff_t>(here[turns_.below(here.size())]);
  protocol::Received received = std::move(at->content);
  box.erase(at);
  return received;
}

void Post::wait(int channel, Rank to) {
  const std::vector<Parcel>& box = boxes_[{channel, to}];
  const bool any = std::ranges::any_of(box, [&](const Parcel& one) { return one.arrives <= turns_.now(); });
  if (any)
    turns_.spend(to, 0);
  else
    turns_.wait(to);
}

TeamInTurns::TeamInTurns(Post& post, Rank rank, std::int32_t ranks, std::string& why)
    : post_(post),
      rank_(rank),
      ranks_(ranks),
      why_(why),
      control_(channel(post, channels_++, rank, ranks)),
      all_(control_->transport()) {}

Bytes TeamInTurns::broadcast(Bytes bytes) {
  std::vector<Mail> mail;
  if (leads())
    for (const Rank to : first_ids<Rank>(ranks_)) mail.push_back({to, bytes});
  return std::move(all_.deliver(std::move(mail), {Rank{0}}).front().bytes);
}

std::vector<Bytes> TeamInTurns::gather(const Bytes& bytes) {
  std::vector<Bytes> all;
  for (Mail& mail : all_.deliver({{Rank{0}, bytes}}, leads() ? all_ranks(ranks_) : std::vector<Rank>()))
    all.push_back(std::move(mail.bytes));
  return all;
}

std::unique_ptr<job::Channel> TeamInTurns::open() {
  return channel(post_, channels_++, rank_, ranks_);
}

void TeamInTurns::abort(const KeyText& message, int /*code*/) {
  if (why_.empty()) why_ = message.in(full_name);
  post_.turns().abort();
}

}  // namespace driftmesh::sim
