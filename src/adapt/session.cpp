#include "adapt/session.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

#include "adapt/demand.hpp"
#include "adapt/error_lengths.hpp"
#include "adapt/join.hpp"
#include "adapt/lineage.hpp"
#include "adapt/of_all_parts.hpp"
#include "adapt/parcel.hpp"
#include "adapt/recast.hpp"
#include "base/bytes.hpp"
#include "base/formatted.hpp"
#include "base/in_turns.hpp"
#include "base/key_error.hpp"
#include "base/stopwatch.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {
namespace {

void require_sound(const AdaptiveOptions& options) {
  const auto require = [](bool sound, const char* key, double value, const KeyText& rule) {
    if (!sound) throw Keyed<Error>(KeyText::of("{} is {}; it must be {}", KeyText::key(key), value, rule));
  };
  require(options.shortest >= 0, "adaptive.shortest", options.shortest, "at least 0");
  require(options.longest > 0 && options.longest >= options.shortest, "adaptive.longest", options.longest,
          KeyText::of("positive, and not below {adaptive.shortest}, which is {}", options.shortest));
  require(options.gradation >= 0, "adaptive.gradation", options.gradation, "at least 0");
  require(options.coarsening >= 0 && options.coarsening < 1, "adaptive.coarsening", options.coarsening,
          "at least 0, and below 1");
  require(options.most_triangles >= 0, "adaptive.most_triangles", options.most_triangles, "at least 0");
}

Fields fields_without_values(const Fields& fields) {
  Fields all;
  for (const auto& [name, field] : fields) all[name] = {field.place, field.how, field.components, {}};
  return all;
}

/// Which of the sessions that rank 0 has made this one is.
std::int64_t number_of_rank_0(Ranks& ranks) {
  static std::atomic<std::int64_t> sessions = 0;
  ByteWriter own;
  own.value(++sessions);
  return ByteReader(ranks.bytes_of_all(own.take()).front()).value<std::int64_t>();
}

/// What all ranks say which say anything; empty if none does. `differ`: the error where `one` of rank r is not `other`
/// of rank q.
template <class Differ>
Bytes same_on_all(const Bytes& own, Ranks& ranks, const Differ& differ) {
  const std::vector<Bytes> of_ranks = ranks.bytes_of_all(own);
  const auto said = [](const Bytes& bytes) { return !bytes.empty(); };
  const auto known = std::ranges::find_if(of_ranks, said);
  if (known == of_ranks.end()) return {};
  ranks.agree([&] {
    const auto other =
        std::find_if(known, of_ranks.end(), [&](const Bytes& bytes) { return said(bytes) && bytes != *known; });
    if (other != of_ranks.end())
      throw Error(differ(*known, known - of_ranks.begin(), *other, other - of_ranks.begin()));
  });
  return *known;
}

/// The number that all ranks have which have any.
std::size_t same_components(const std::string& name, std::size_t own, Ranks& ranks) {
  const auto number_from = [](const Bytes& bytes) { return ByteReader(bytes).value<std::uint64_t>(); };
  ByteWriter writer;
  if (own > 0) writer.value(std::uint64_t{own});
  const Bytes same =
      same_on_all(writer.take(), ranks, [&](const Bytes& one, std::ptrdiff_t r, const Bytes& other, std::ptrdiff_t q) {
        return formatted(
            "attach: field '{}' has {} values at each place on rank {}, and {} on rank {}; give the same "
            "number on each rank",
            name, number_from(one), r, number_from(other), q);
      });
  return same.empty() ? 0 : static_cast<std::size_t>(number_from(same));
}

/// The shape that all ranks give which have any values. It is known to fit them.
std::vector<std::int64_t> same_shape(const std::string& name, const std::vector<std::int64_t>& own, bool any,
                                     Ranks& ranks) {
  const auto shape_from = [](const Bytes& bytes) {
    std::vector<std::int64_t> shape;
    ByteReader(bytes).array(shape);
    return shape;
  };
  ByteWriter writer;
  if (any) writer.array(own);
  const Bytes same =
      same_on_all(writer.take(), ranks, [&](const Bytes& one, std::ptrdiff_t r, const Bytes& other, std::ptrdiff_t q) {
        return formatted(
            "attach: field '{}' has values of shape {} at each place on rank {}, and of shape {} on "
            "rank {}; give the same shape on each rank",
            name, shape_text(shape_from(one)), r, shape_text(shape_from(other)), q);
      });
  return same.empty() ? std::vector<std::int64_t>() : shape_from(same);
}

std::string words_of(FieldPlace place, Transfer how) {
  return std::string("at ") + adapt::words_of(place) +
         (how == Transfer::kConserve ? ", conserving" : ", by interpolation");
}

IdVector<SubdomainId, SubdomainId> numbers_of(const Parts& parts) {
  const auto numbers = ids_of(parts);
  return {numbers.begin(), numbers.end()};
}

/// What stayed since an earlier mesh, if `made` knows what stayed since `earlier`.
void since(const Holding& earlier, Holding& made) {
  const auto follow = [](std::vector<std::int32_t>& stayed, const std::vector<std::int32_t>& before) {
    for (std::int32_t& number : stayed)
      if (number >= 0) number = before[to_index(number)];
  };
  follow(made.stayed.points, earlier.stayed.points);
  follow(made.stayed.triangles, earlier.stayed.triangles);
}

/// Times of stages one after the other.
class Stages {
 public:
  /// Adds the time of the stage to `seconds`, and begins the next one.
  void end(double& seconds) {
    seconds += watch_.seconds();
    watch_ = {};
  }

 private:
  Stopwatch watch_;
};

}  // namespace

Session::Session(Start start, const AdaptiveOptions& options, std::function<void(Mesh&)> finish, const Means& means)
    : plan_(std::move(start.plan)), pslg_(std::move(start.pslg)), options_(options), finish_(std::move(finish)) {
  means.ranks.agree([&] { require_sound(options); });
  number_ = number_of_rank_0(means.ranks);
  Parts parts(plan_.decomposition.size());
  for (auto& [s, mesh] : start.parts)
    parts[s] =
        first_part(std::move(mesh), plan_.bounds, start.lengths.empty() ? Lengths() : std::move(start.lengths.at(s)));
  shares_ = static_cast<std::int32_t>(plan_.decomposition.size());
  descendants_ = {numbers_of(parts), numbers_of(parts)};
  present_ = assembled(plan_.decomposition, std::move(parts), means.ranks);
}

Session::Session(Saved saved, std::function<void(Mesh&)> finish, const Means& means)
    : plan_(std::move(saved.head.plan)),
      pslg_(std::move(saved.head.pslg)),
      options_(saved.head.options),
      finish_(std::move(finish)),
      shapes_(std::move(saved.head.shapes)) {
  number_ = number_of_rank_0(means.ranks);
  report_.generation = saved.head.generation;
  Parts parts(plan_.decomposition.size());
  for (const auto& [s, parcel] : saved.parcels) parts[s] = parcel.part;
  shares_ = saved.head.shares;
  descendants_ = {numbers_of(parts), numbers_of(parts)};
  present_ = assembled(plan_.decomposition, std::move(parts), means.ranks);
  fields_ = without_values(saved.head.fields, present_.piece);
  means.ranks.agree([&] {
    for (const auto& [s, parcel] : saved.parcels) set_values_on(present_, s, parcel.values, fields_);
  });
}

void Session::save(const std::string& path, Bytes more, const Means& means) {
  require_same_call("save, to '" + path + "'", means.ranks);
  means.ranks.agree([&] {
    if (path.empty()) throw Error("save: the name of the file is empty; give one, such as 'mesh.h5'");
  });
  take_from_owners(fields_, present_.piece, means.ranks);
  SavedHead head{.plan = plan_,
                 .shares = shares_,
                 .pslg = pslg_,
                 .options = options_,
                 .generation = report_.generation,
                 .fields = fields_without_values(fields_),
                 .more = std::move(more),
                 .shapes = shapes_};
  adapt::save(path, head,
              {.here = present_.here,
               .size = [&](SubdomainId s) { return packed_size(present_, s, fields_); },
               .pack = [&](SubdomainId s) { return pack(present_, s, fields_); }},
              means.ranks);
}

Generation Session::assembled(const Decomposition& decomposition, Parts parts, Ranks& ranks) const {
  Generation made = assemble(decomposition, pslg_, std::move(parts), ranks);
  ranks.agree([&] { finish_(made.piece.mesh); });
  return made;
}

void Session::require_same_call(const std::string& call, Ranks& ranks) const {
  if (ranks.alone()) return;
  ByteWriter own;
  own.text(call);
  own.value(number_);
  own.value(report_.generation);
  const std::vector<Bytes> calls = ranks.bytes_of_all(own.take());
  ranks.agree([&] {
    for (const Rank r : first_ids<Rank>(calls.size())) {
      if (calls[to_index(r)] == calls.front()) continue;
      ByteReader first(calls.front()), other(calls[to_index(r)]);
      const std::string of_first = first.text(), of_other = other.text();
      throw Error("the ranks do not make the same call: rank 0 calls " + of_first + ", and rank " + to_string(r) +
                  " calls " + of_other + (of_first == of_other ? " of another adaptive mesh" : "") +
                  "; call the same function of the same object on all ranks, in the same order");
    }
  });
}

void Session::adapt(std::span<const double> lengths, const Means& means, const Hooks& hooks) {
  require_same_call("adapt, with lengths", means.ranks);
  advance([&] { return fit_lengths(present_, plan_.bounds, options_, lengths, means.threads, means.ranks); }, means,
          hooks);
}

void Session::adapt(const SizeField& size, const Means& means, const Hooks& hooks) {
  require_same_call("adapt, with a size", means.ranks);
  FittedField field(size, options_);
  advance([&] { return fit_field(present_, plan_.bounds, options_, field, means.threads, means.ranks); }, means, hooks);
}

std::vector<double> Session::lengths_from_error(std::span<const double> indicators, double target, double order,
                                                const Means& means) const {
  require_same_call(formatted("lengths_from_error, with target {} and order {}", target, order), means.ranks);
  return adapt::lengths_from_error(present_, indicators, target, order, means.ranks);
}

IdVector<SubdomainId, Demand> Session::demands_of(const Wanted& wanted, std::int32_t threads, Ranks& ranks) const {
  IdVector<SubdomainId, Demand> own(present_.parts.size());
  ranks.agree([&] {
    in_turns(present_.here.size(), to_index(threads), [&](std::size_t i) {
      const SubdomainId s = present_.here[i];
      const Part& part = present_.parts[s];
      own[s] = demand_of(part.mesh->mesh, plan_.bounds, wanted.lengths[s], wanted.between, part.made_for.get());
    });
  });
  return of_all_parts(ranks, present_, [&](SubdomainId s) { return own[s]; });
}

void Session::advance(const std::function<Wanted()>& want, const Means& means, const Hooks& hooks) {
  Ranks& ranks = means.ranks;
  const std::int32_t threads = means.threads;
  const Stopwatch all;
  AdaptReport report{.generation = report_.generation + 1};
  Stages stages;
  ranks.agree([&] {
    for (const auto& [name, field] : fields_) require_summable(name, field, &present_.piece);
  });
  const Wanted wanted = want();
  report.scale = wanted.scale;
  const IdVector<SubdomainId, Demand> demands = demands_of(wanted, threads, ranks);
  take_from_owners(fields_, present_.piece, ranks);
  stages.end(report.lengths);

  const Basis before{plan_, {present_, fields_, stayed_}, wanted, demands};
  const auto assemble_parts = [&](const Decomposition& decomposition, Parts parts) {
    return assembled(decomposition, std::move(parts), ranks);
  };
  std::optional<Joined> joined = join_light(before, shares_, assemble_parts, ranks);
  const Basis basis = joined ? joined->basis() : before;
  const Generation& from = basis.present.generation;
  report.joined = static_cast<std::int32_t>(present_.parts.size() - from.parts.size());
  if (joined) joined->present.generation.piece = {};
  stages.end(report.join);

  const IdVector<SubdomainId, Fate> fates =
      fates_of(basis, joined ? joined->several : std::vector<SubdomainId>(), ranks);
  for (const Fate fate : fates)
    ++(fate == Fate::kKeep ? report.kept : fate == Fate::kMend ? report.mended : report.remade);
  Parts parts = regenerate(basis.plan, from, basis.wanted, basis.demands, fates, threads, ranks, hooks);
  stages.end(report.refine);

  const Dividing dividing{basis.plan, shares_, from, basis.wanted, threads, hooks};
  std::optional<Divided> divided = divide_heavy(parts, dividing, ranks);
  if (divided) parts = std::move(divided->parts);
  stages.end(report.divide);

  Unfinished next{
      .from = basis.present,
      .parts = std::move(parts),
      .decomposition = basis.plan.decomposition,
      .cut = divided ? std::optional(std::move(divided->cut)) : std::nullopt,
      .descendants = {joined ? std::move(joined->whole) : numbers_of(present_.parts), numbers_of(from.parts)}};
  if (next.cut) next.descendants.whole_of = std::move(next.cut->whole_of);
  report.moved = joined ? joined->moved : 0;
  // Nobody looks at the old piece any more: it goes before the new one comes.
  DistributedPiece old = std::exchange(present_.piece, {});
  if (!keeps_old_) old = {};
  Holding made;
  try {
    made = finished(next, means, report);
  } catch (...) {
    present_.piece = keeps_old_ ? std::move(old) : assembled(plan_.decomposition, present_.parts, ranks).piece;
    throw;
  }
  if (joined) since(joined->present, made);

  if (keeps_old_) old_ = std::move(old);
  if (joined) plan_ = std::move(joined->plan);
  if (next.cut) set_decomposition(std::move(next.cut->divided), next.descendants.whole_of);
  descendants_ = std::move(next.descendants);
  present_ = std::move(made.generation);
  stayed_ = std::move(made.stayed);
  fields_ = std::move(made.fields);
  spent_ = {};
  report.seconds = all.seconds();
  report_ = report;
}

/// Puts it together, gives it fields, divides what is to be divided, and places it.
Holding Session::finished(Unfinished& next, const Means& means, AdaptReport& report) const {
  Ranks& ranks = means.ranks;
  Stages stages;
  const Decomposition& whole = next.cut ? next.cut->with_separators : next.decomposition;
  Holding made{assembled(whole, std::move(next.parts), ranks), {}, {}};
  stages.end(report.assemble);

  const Held& from = next.from;
  made.fields = carried(from.fields, Lineage(from.generation, made.generation, means.threads, ranks), made.stayed);
  stages.end(report.transfer);

  const Decomposition& decomposition = next.cut ? next.cut->divided : next.decomposition;
  if (next.cut) {
    made.generation.piece = {};
    made = recast(
        made, {}, decomposition, next.descendants.whole_of,
        [&](Parts of_next) { return assembled(decomposition, std::move(of_next), ranks); }, ranks);
  }
  report.divided = static_cast<std::int32_t>(decomposition.size() - from.generation.parts.size());
  stages.end(report.assemble);

  made = placed(std::move(made), decomposition, next.descendants, means, report);
  stages.end(report.balance);
  return made;
}

IdVector<SubdomainId, Fate> Session::fates_of(const Basis& basis, const std::vector<SubdomainId>& joined,
                                              Ranks& ranks) const {
  const Generation& from = basis.present.generation;
  IdVector<SubdomainId, Fate> fates = of_all_parts(
      ranks, from, [&](SubdomainId s) { return fate_of(from.parts[s], basis.demands[s], options_.coarsening); });
  for (const SubdomainId s : joined) fates[s] = Fate::kRemake;
  return fates;
}

std::vector<std::vector<std::int32_t>> Session::parents() const {
  std::vector<std::vector<std::int32_t>> of_whole(descendants_.whole.size()), all;
  for (const SubdomainId s : ids_of(descendants_.whole)) of_whole[to_index(descendants_.whole[s])].push_back(to_int(s));
  for (const SubdomainId whole : descendants_.whole_of) all.push_back(of_whole[to_index(whole)]);
  return all;
}

void Session::keep_old(bool keep) {
  keeps_old_ = keep;
  if (!keep) old_.reset();
}

const DistributedPiece& Session::old_piece() const {
  if (!old_) throw Error("there is no old mesh; call keep_old() before adapt()");
  return *old_;
}

void Session::set_decomposition(Decomposition decomposition, const IdVector<SubdomainId, SubdomainId>& whole_of) {
  plan_.decomposition = std::move(decomposition);
  for (const SubdomainId s : ids_of(whole_of))
    if (to_index(s) >= plan_.owners.size()) plan_.owners.push_back(plan_.owners[whole_of[s]]);
}

/// On other ranks where that makes up for an imbalance.
Holding Session::placed(Holding made, const Decomposition& decomposition, const Descendants& descendants,
                        const Means& means, AdaptReport& report) const {
  Ranks& ranks = means.ranks;
  if (ranks.alone() || !means.place) return made;
  const Loads loads = loads_of(present_, made.generation, descendants, made.fields, spent_, ranks);
  const std::vector<Rank> own = means.place(loads, made.generation, decomposition);
  const IdVector<SubdomainId, Rank> now = made.generation.holders;
  const IdVector<SubdomainId, Rank> holders = of_all_parts(ranks, made.generation, [&](SubdomainId s) {
    const auto i = std::ranges::lower_bound(made.generation.here, s) - made.generation.here.begin();
    return own.empty() ? now[s] : own.at(static_cast<std::size_t>(i));
  });
  const bool any = holders != now;
  for (const SubdomainId s : ids_of(holders)) report.moved += holders[s] != now[s] ? 1 : 0;
  if (any)
    made = moved(
        made, holders, [&](Parts parts) { return assembled(decomposition, std::move(parts), ranks); }, ranks);
  report.imbalance = imbalance(loads, holders);
  return made;
}

void Session::attach(const std::string& name, std::vector<double> values, FieldPlace place, Transfer how,
                     const Means& means, std::vector<std::int64_t> shape) {
  require_same_call("attach, with field '" + name + "' " + words_of(place, how), means.ranks);
  Field field;
  means.ranks.agree([&] {
    field = make_field(present_.piece.mesh, name, std::move(values), place, how);
    if (!shape.empty() && field.components > 0) require_shape(name, shape, field.components);
  });
  const bool any = field.components > 0;
  field.components = same_components(name, field.components, means.ranks);
  shape = same_shape(name, shape, any, means.ranks);
  fields_[name] = std::move(field);
  shapes_.erase(name);
  if (!shape.empty()) shapes_[name] = std::move(shape);
}

Field& Session::find_field(const std::string& name) {
  const auto found = fields_.find(name);
  if (found == fields_.end()) throw Error("there is no field '" + name + "'; attach it first");
  return found->second;
}

void Session::detach(const std::string& name, const Means& means) {
  require_same_call("detach, with field '" + name + "'", means.ranks);
  means.ranks.agree([&] { (void)find_field(name); });
  fields_.erase(name);
  shapes_.erase(name);
}

std::vector<std::int64_t> Session::shape(const std::string& name) {
  const std::size_t components = find_field(name).components;
  if (const auto known = shapes_.find(name); known != shapes_.end()) return known->second;
  if (components == 1) return {};
  return {static_cast<std::int64_t>(components)};
}

std::span<double> Session::field(const std::string& name) {
  return find_field(name).values;
}

}  // namespace driftmesh::adapt
