#include "job/checkpoints.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/failure.hpp"
#include "base/key_error.hpp"
#include "base/stopwatch.hpp"
#include "base/temporary_files.hpp"
#include "distributed/packed_parts.hpp"
#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "job/fence.hpp"
#include "job/memory.hpp"

namespace driftmesh::job {
namespace {

std::exception_ptr caught(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error&) {
    return std::current_exception();
  }
  return nullptr;
}

std::exception_ptr told_to_end() {
  return std::make_exception_ptr(LimitError("stopped by SIGTERM before all bounds were met. No mesh was written"));
}

/// What all have said.
struct Heard {
  std::vector<AtFence> all;
  std::int64_t triangles = 0;
  Failure why;  ///< what the first says that wants to end
};

Heard heard(const std::vector<Bytes>& letters) {
  Heard heard;
  for (const Bytes& letter : letters) {
    ByteReader reader(letter);
    AtFence& one = heard.all.emplace_back();
    one.rests = reader.value<std::uint8_t>() != 0;
    reader.value(one.wish);
    heard.triangles += reader.value<std::int64_t>();
    Failure why = Failure::read(reader);
    if (heard.why.kind == Failure::Kind::kNothing) heard.why = std::move(why);
  }
  return heard;
}

}  // namespace

Checkpoints::Checkpoints(Rules rules, Ranks& ranks, std::function<std::map<std::string, Bytes>()> heads,
                         std::function<void(std::int64_t)> check_all, Watch& watch)
    : rules_(std::move(rules)),
      ranks_(ranks),
      heads_(std::move(heads)),
      check_all_(std::move(check_all)),
      watch_(watch),
      last_fence_(ranks_.now()),
      last_save_(last_fence_) {
  if (ranks_.rank() == Rank{0}) remove_remains_beside(rules_.path);  // those the run has left that goes on here
}

bool Checkpoints::halts() const {
  if (ends_ || NotedSignals::told_to_end() || NotedSignals::requested()) return true;
  return ranks_.alone() ? is_due() : ranks_.now() - last_fence_ >= rules_.fence_every;
}

bool Checkpoints::is_due() const {
  return ranks_.now() - last_save_ >= rules_.every;
}

void Checkpoints::end_for(std::exception_ptr why) {
  const std::lock_guard lock(alone_);
  if (!why_) why_ = std::move(why);
  ends_ = true;
}

Bytes Checkpoints::letter(bool rests, std::int64_t triangles) {
  if (NotedSignals::told_to_end()) end_for(told_to_end());
  AtFence::Wish wish = AtFence::Wish::kNothing;
  if (NotedSignals::requested() || (ranks_.rank() == Rank{0} && is_due())) wish = AtFence::Wish::kSave;
  if (why_) wish = AtFence::Wish::kEnd;
  ByteWriter writer;
  writer.value(static_cast<std::uint8_t>(rests ? 1 : 0));
  writer.value(wish);
  writer.value(triangles);
  failure_of(why_).write(writer);
  return writer.take();
}

bool Checkpoints::fence(bool rests, const RefinementInRounds& refinement) {
  Heard said = heard(ranks_.bytes_of_all(letter(rests, refinement.triangles())));
  NotedSignals::have_met();
  std::exception_ptr why = caught([&] {
    if (said.why.kind != Failure::Kind::kNothing) raise(said.why);
    check_all_(said.triangles);
  });
  if (why) said.all.front().wish = AtFence::Wish::kEnd;
  const AfterFence next = after_fence(said.all);
  std::string fault;
  if (next.save) fault = save(refinement);
  if (next.end) ranks_.alike([&] { end(why, fault); });
  if (!fault.empty() && ranks_.rank() == Rank{0} && !std::exchange(warned_, true))
    watch_.warn("no checkpoint was written: " + fault);
  last_fence_ = ranks_.now();
  return next.round_is_over;
}

/// Returns why it could not be written, or nothing.
std::string Checkpoints::save(const RefinementInRounds& refinement) {
  const Stopwatch took;
  std::map<std::string, Bytes> heads;
  std::map<SubdomainId, std::uint64_t> sizes;
  PackedParts parts([&](SubdomainId part) { return refinement.halted(part); },
                    std::min(PackedParts::kMostRoom, room_under_cap() / 4));
  std::uint64_t bytes = 0;
  const auto look_up = [&] {
    if (rules_.saving) rules_.saving();
  };
  look_up();
  const std::exception_ptr fault = caught([&] {
    ranks_.agree([&] {
      if (ranks_.rank() == Rank{0}) heads = heads_();
      for (const SubdomainId s : refinement.here()) {
        look_up();
        sizes[s] = parts.size(s);
      }
    });
    bytes = write_parts(
        rules_.path, kCheckpointFile, heads, rules_.subdomains, sizes,
        [&](SubdomainId s) {
          look_up();
          return parts.take(s);
        },
        ranks_);
  });
  NotedSignals::forget_request();
  last_save_ = ranks_.now();
  record_.seconds += took.seconds();
  if (fault) {
    ranks_.recovered();
    return text_of(failure_of(fault)).in(full_name);
  }
  ++record_.count;
  record_.bytes = bytes;
  return "";
}

void Checkpoints::end(const std::exception_ptr& why, const std::string& fault) {
  const KeyText text = text_of(failure_of(why));
  if (!fault.empty()) throw Keyed<LimitError>(KeyText::of("{}. Nor was a checkpoint written: {}", text, fault));
  throw Keyed<LimitError>(KeyText::of("{}; all that was done is in {}: go on with driftmesh mesh {run.resume} {}", text,
                                      rules_.path, rules_.path));
}

}  // namespace driftmesh::job
