#include "distributed/ranks.hpp"

#include <utility>

#include "base/failure.hpp"
#include "distributed/rank_status.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// One round of mail whose senders are known.
class OneRound final : public Exchange {
 public:
  OneRound(std::vector<Mail> mail, std::vector<Rank> senders) : mail_(std::move(mail)), senders_(std::move(senders)) {}

  [[nodiscard]] int rounds() const override { return 1; }
  [[nodiscard]] std::vector<Mail> send(int /*round*/) override { return std::move(mail_); }
  [[nodiscard]] std::vector<Rank> senders(int /*round*/) const override { return senders_; }
  void receive(int /*round*/, std::vector<Mail> mail) override { mail_ = std::move(mail); }

  [[nodiscard]] std::vector<Mail> take() { return std::move(mail_); }

 private:
  std::vector<Mail> mail_;  // to others, then from others
  std::vector<Rank> senders_;
};

}  // namespace

std::vector<Mail> Ranks::deliver(std::vector<Mail> mail, std::vector<Rank> senders) {
  OneRound round(std::move(mail), std::move(senders));
  run(round);
  return round.take();
}

std::vector<Mail> Ranks::swap(std::vector<Mail> mail) {
  std::vector<Rank> others;
  for (const Mail& one : mail) others.push_back(one.rank);
  return deliver(std::move(mail), std::move(others));
}

std::vector<Bytes> Ranks::bytes_of_all(const Bytes& own) {
  std::vector<Mail> mail;
  for (const Rank to : first_ids<Rank>(ranks())) mail.push_back({to, own});
  std::vector<Bytes> all;
  for (Mail& from : swap(std::move(mail))) all.push_back(std::move(from.bytes));
  return all;
}

void Ranks::agree(const std::function<void()>& work) {
  if (alone()) return work();
  const std::vector<Mail> statuses = swap(status_to_all(ranks(), work));
  alike([&] { throw_first_failure(statuses); });
}

void RanksOfTransport::run(Exchange& exchange) {
  protocol::run_rank(transport_, [&] {
    const protocol::StepResult result = runner_.step(exchange);
    if (result == protocol::StepResult::kIdle) look_up();
    return result;
  });
}

void OneRank::run(Exchange& exchange) {
  const IdVector<Rank, Exchange*> alone{&exchange};
  exchange_directly(alone);
}

}  // namespace driftmesh
