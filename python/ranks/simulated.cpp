#include "driftmesh/simulated.hpp"

#include <pybind11/stl.h>

#include "api/simulated/cluster_request.hpp"
#include "python/arrays.hpp"
#include "python/options.hpp"
#include "python/ranks/ranks.hpp"
#include "python/table.hpp"

namespace driftmesh::python {
namespace {

SimulatedCluster cluster_from(const py::dict& given) {
  SimulatedCluster cluster;
  job::Request request;
  Given entries = entries_of(given);
  visit_cluster(cluster, request, [&](const char* key, const char* name, auto& member, const auto& place) {
    take_if_given(entries, name, key, member, request, place);
  });
  std::vector<std::string> names;
  visit_cluster(cluster, request,
                [&](const char*, const char* name, const auto&, const auto&) { names.emplace_back(name); });
  refuse_rest(entries, names);
  return cluster;
}

SimulatedRun run(const Pslg& input, const py::dict& cluster, const py::kwargs& options) {
  const SimulatedCluster simulated = cluster_from(cluster);
  return with_options(options, [&](const MeshOptions& values) { return simulate(input, values, simulated); });
}

py::array ranks_view(const std::vector<Rank>& ranks, py::handle owner) {
  return column_of(ranks, reinterpret_cast<const std::int32_t*>(ranks.data()), owner);
}

}  // namespace

void add_simulated(py::module_& module) {
  using Times = SimulatedRun::RankTimes;
  using Move = SimulatedRun::Move;
  py::class_<SimulatedRun> run_class(module, "SimulatedRun",
                                     "Results of a run on a simulated cluster, in virtual seconds.");
  py::class_<Move>(run_class, "Move", "A subdomain that moved from one rank to another.")
      .def_property_readonly(
          "subdomain", [](const Move& m) { return to_int(m.subdomain); }, "Its number.")
      .def_property_readonly(
          "source", [](const Move& m) { return to_int(m.from); }, "The rank that gave it away.")
      .def_property_readonly(
          "target", [](const Move& m) { return to_int(m.to); }, "The rank that got it.")
      .def_readonly("left", &Move::left, "When it was sent, in virtual seconds.")
      .def_readonly("arrived", &Move::arrived, "When it was unpacked, in virtual seconds.")
      .def_readonly("bytes", &Move::bytes, "Its size when packed.");
  py::class_<Times>(run_class, "RankTimes", "How a rank spent its time.")
      .def_readonly("computing", &Times::computing, "Seconds of refinement.")
      .def_readonly("sending", &Times::sending, "Seconds of sending messages.")
      .def_readonly("polling", &Times::polling, "Seconds of receiving messages.")
      .def_readonly("balancing", &Times::balancing, "Seconds of planning and moving subdomains.")
      .def_readonly("idle", &Times::idle, "Seconds without work.");
  run_class.def_readonly("seconds", &SimulatedRun::seconds, "Until the last rank knows that all work is done.")
      .def_readonly("ideal_seconds", &SimulatedRun::ideal_seconds, "If every rank had computed from start to end.")
      .def_readonly("triangles", &SimulatedRun::triangles, "Of the whole mesh.")
      .def_readonly("messages", &SimulatedRun::messages, "Number of messages between ranks.")
      .def_readonly("message_bytes", &SimulatedRun::message_bytes, "Size of all of them.")
      .def_readonly("moves", &SimulatedRun::moves, "In order of departure.")
      .def_readonly("ranks", &SimulatedRun::ranks, "The times of each rank.")
      .def_property_readonly(
          "speeds", [](const py::object& self) { return view(self.cast<const SimulatedRun&>().speeds, self); },
          "Triangles per second of each rank, shape (ranks,).")
      .def_property_readonly(
          "owners_before",
          [](const py::object& self) { return ranks_view(self.cast<const SimulatedRun&>().owners_before, self); },
          "Rank of each subdomain at the start, shape (subdomains,).")
      .def_property_readonly(
          "owners_after",
          [](const py::object& self) { return ranks_view(self.cast<const SimulatedRun&>().owners_after, self); },
          "Rank of each subdomain in the end, shape (subdomains,).");
  py::options options;
  options.disable_function_signatures();
  module.def(
      "simulate", &run, py::arg("input"), py::pos_only(), py::arg("cluster"),
      "simulate(input, /, cluster, **options) -> SimulatedRun\n\n"
      "Make a mesh on a simulated cluster: meshes and messages are real, time is not. The same arguments give the\n"
      "same result on every machine. Takes the options of mesh_distributed(); balance[\"own\"] is a policy in Python:\n"
      "an object with a method plan(load), or a function, that returns pairs of a subdomain and its new rank.\n\n"
      "cluster is a dictionary: {\"ranks\": 8}, or {\"rank_speeds\": [1e6, 2e6]} in triangles per second; also speed,\n"
      "latency and message_overhead in seconds, bandwidth in bytes per second, and scale.");
}

}  // namespace driftmesh::python
