#include "policy.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "table.hpp"

namespace driftmesh::python {

using balancer::LoadSnapshot;
using balancer::Move;

/// A snapshot and what is derived from it, as Python keeps it. One type for both modules, so it must have a name.
struct Load {
  LoadSnapshot snapshot;
  std::vector<double> speeds;
};

namespace {

std::int32_t entry(const py::handle& pair, std::size_t k) {
  return short_integer_from("a move", pair[py::int_(k)]);
}

/// The moves that Python's plan lists. ValueError for one that cannot be made.
std::vector<Move> moves_from(const py::object& plan, const LoadSnapshot& snapshot) {
  std::vector<Move> moves;
  if (plan.is_none()) return moves;
  std::set<std::int32_t> moved;
  for (const py::handle& pair : plan) {
    const auto subdomain = entry(pair, 0), rank = entry(pair, 1);
    const std::string move = "the move of subdomain " + std::to_string(subdomain) + " to rank " + std::to_string(rank);
    const balancer::SubdomainLoad* listed = balancer::find(snapshot, SubdomainId{subdomain});
    if (listed == nullptr) throw py::value_error(move + ": the load does not list this subdomain");
    if (rank < 0 || std::cmp_greater_equal(rank, snapshot.ranks.size())) throw py::value_error(move + ": no such rank");
    if (!moved.insert(subdomain).second) throw py::value_error(move + ": this subdomain was moved already");
    if (listed->owner != Rank{rank}) moves.push_back({SubdomainId{subdomain}, Rank{rank}});
  }
  return moves;
}

/// A view of one member of the subdomains or ranks, as numbers of type T.
template <class T, class Record, class Member>
py::array member_view(const std::vector<Record>& records, Member Record::*member, py::handle owner) {
  static_assert(sizeof(T) == sizeof(Member));
  const void* first = records.empty() ? nullptr : &(records.front().*member);
  return column_of(records, static_cast<const T*>(first), owner);
}

template <class T, class Member>
void add_of_subdomains(py::class_<Load>& to, const char* name, Member balancer::SubdomainLoad::*member,
                       const char* doc) {
  to.def_property_readonly(
      name,
      [member](const py::object& self) {
        return member_view<T>(self.cast<const Load&>().snapshot.subdomains, member, self);
      },
      doc);
}

void add_of_ranks(py::class_<Load>& to, const char* name, double balancer::RankLoad::*member, const char* doc) {
  to.def_property_readonly(
      name,
      [member](const py::object& self) {
        const std::vector<balancer::RankLoad>& ranks = self.cast<const Load&>().snapshot.ranks;
        return member_view<double>(ranks, member, self);
      },
      doc);
}

}  // namespace

std::shared_ptr<const balancer::Policy> policy_from(const py::object& given, Callbacks& callbacks) {
  const py::object plan = py::hasattr(given, "plan") ? given.attr("plan") : given;
  if (PyCallable_Check(plan.ptr()) == 0)
    throw py::type_error("balance.own takes an object with a method plan, or a callable, not " +
                         std::string(Py_TYPE(given.ptr())->tp_name));
  // The policy may be copied and destroyed by threads that do not hold the lock, so it holds no reference.
  const py::handle function = plan.inc_ref();
  const std::shared_ptr<void> reference(nullptr, [function](void*) {
    const py::gil_scoped_acquire lock;
    function.dec_ref();
  });
  return balancer::leader_policy([function, reference, &callbacks](const LoadSnapshot& snapshot) {
    return callbacks.ask([&] {
      const IdVector<Rank, double> speeds = balancer::assumed_speeds(snapshot.ranks);
      return moves_from(function(Load{snapshot, {speeds.begin(), speeds.end()}}), snapshot);
    });
  });
}

void add_load_class(py::module_& module) {
  using balancer::RankLoad;
  using balancer::SubdomainLoad;
  py::class_<Load> load(module, "Load",
                        "The load at one moment, as a policy sees it: arrays with an entry for each unfinished "
                        "subdomain, or for each rank. Work is in triangles, times are in seconds.");
  add_of_subdomains<std::int32_t>(load, "subdomains", &SubdomainLoad::id,
                                  "IDs of the unfinished subdomains, ascending, shape (subdomains,).");
  add_of_subdomains<std::int32_t>(load, "owners", &SubdomainLoad::owner,
                                  "Rank that has the subdomain, shape (subdomains,).");
  add_of_subdomains<double>(load, "remaining", &SubdomainLoad::remaining,
                            "Triangles still to be made in it, predicted, shape (subdomains,).");
  add_of_subdomains<std::uint64_t>(load, "bytes", &SubdomainLoad::bytes, "Bytes to move it, shape (subdomains,).");
  add_of_subdomains<std::int32_t>(load, "turns", &SubdomainLoad::turn,
                                  "Position in its owner's order of work, shape (subdomains,); 0 is being worked on.");
  add_of_subdomains<double>(load, "costs", &SubdomainLoad::cost,
                            "Seconds of both ranks to move it, shape (subdomains,).");
  add_of_subdomains<bool>(load, "fixed", &SubdomainLoad::fixed,
                          "Whether it stays where it is, whatever is planned, shape (subdomains,).");
  add_of_ranks(load, "rank_remaining", &RankLoad::remaining,
               "Triangles that each rank has still to make, shape (ranks,).");
  add_of_ranks(load, "rank_doubts", &RankLoad::doubt,
               "Relative standard deviation of the time for that, shape (ranks,).");
  add_of_ranks(load, "rank_free_memory", &RankLoad::free_memory,
               "Triangles for which each rank has memory besides those that it has and will make, shape (ranks,).");
  load.def_property_readonly(
      "rank_speeds", [](const py::object& self) { return view(self.cast<const Load&>().speeds, self); },
      "Triangles per second of each rank, as measured, shape (ranks,); the mean of the others where it is not known.");
  load.def(
      "neighbors",
      [](const Load& self, py::handle given) {
        const std::int32_t subdomain = short_integer_from("subdomain", given);
        const auto& all = self.snapshot.layout->subdomains;
        if (subdomain < 0 || std::cmp_greater_equal(subdomain, all.size())) throw py::index_error("no such subdomain");
        py::dict lengths;
        for (const balancer::Neighbor& n : all[SubdomainId{subdomain}].neighbors)
          lengths[py::int_(to_int(n.subdomain))] = n.length;
        return lengths;
      },
      py::arg("subdomain"), "The neighbors of a subdomain, with the length of the border to each.");
}

}  // namespace driftmesh::python
