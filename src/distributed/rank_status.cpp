#include "distributed/rank_status.hpp"

#include <exception>
#include <utility>

namespace driftmesh {

Failure failure_in(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    return failure_of(std::current_exception());
  }
  return {};
}

std::vector<Mail> status_to_all(std::int32_t ranks, const std::function<void()>& work) {
  ByteWriter status;
  failure_in(work).write(status);
  std::vector<Mail> mail;
  for (const Rank to : first_ids<Rank>(ranks)) mail.push_back({to, status.bytes()});
  return mail;
}

void throw_first_failure(const std::vector<Mail>& statuses) {
  for (const Mail& mail : statuses) {
    Failure failure;
    read_mail(mail, [&](ByteReader& reader) { failure = Failure::read(reader); });
    if (failure.kind != Failure::Kind::kNothing) raise(met_by(mail.rank, std::move(failure)));
  }
}

}  // namespace driftmesh
