#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "distributed/exchange.hpp"

namespace driftmesh {

/// An exchange whose work is done inside of `around`, which measures it, or charges for it in virtual time.
class ObservedExchange final : public Exchange {
 public:
  /// Calls its argument once.
  using Around = std::function<void(const std::function<void()>& act)>;

  /// `inner` must outlive this one.
  ObservedExchange(Exchange& inner, Around around) : inner_(inner), around_(std::move(around)) {}

  [[nodiscard]] int rounds() const override { return inner_.rounds(); }
  [[nodiscard]] std::vector<Rank> senders(int round) const override { return inner_.senders(round); }
  [[nodiscard]] std::vector<Mail> send(int round) override {
    std::vector<Mail> mail;
    around_([&] { mail = inner_.send(round); });
    return mail;
  }
  void receive(int round, std::vector<Mail> mail) override {
    around_([&] { inner_.receive(round, std::move(mail)); });
  }

 private:
  Exchange& inner_;
  Around around_;
};

}  // namespace driftmesh
