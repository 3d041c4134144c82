#pragma once

#include <string>

#include "base/key_error.hpp"
#include "driftmesh/options.hpp"
#include "job/key.hpp"
#include "job/request.hpp"

namespace driftmesh {

/// Calls visit(key, member, value, place) for each option that the table of keys declares: its name there, its name as
/// a member of MeshOptions, its value, and its place in a request. `Options` is MeshOptions, const or not.
template <class Options, class Visit>
void visit_options(Options&& o, job::Request& r, const Visit& visit) {
  visit("input.snap", "snap", o.snap, r.input.snap);
  visit("input.hull", "hull", o.hull, r.input.hull);
  visit("input.simplify", "simplify", o.simplify, r.input.simplify);
  visit("input.close-channels", "close_channels", o.close_channels, r.input.close_channels);
  visit("input.holes", "holes", o.holes, r.input.holes);
  visit("input.strict", "strict", o.strict, r.input.strict);
  visit("bounds.angle", "min_angle", o.min_angle, r.bounds.angle);
  visit("bounds.area", "max_area", o.max_area, r.bounds.area);
  visit("bounds.triangles", "triangles", o.triangles, r.bounds.triangles);
  visit("bounds.region-areas", "region_areas", o.region_areas, r.bounds.region_areas);
  visit("sizing.across", "across", o.across, r.sizing.across);
  visit("sizing.resolution", "size_resolution", o.size_resolution, r.sizing.resolution);
  visit("sizing.courant-step", "courant.step", o.courant.step, r.sizing.courant_step);
  visit("sizing.courant", "courant.bound", o.courant.bound, r.sizing.courant);
  visit("sizing.courant-speed", "courant.speed", o.courant.speed, r.sizing.courant_speed);
  visit("sizing.courant-length", "courant.length", o.courant.length, r.sizing.courant_length);
  visit("input.rasters", "rasters", o.rasters, r.input.rasters);
  visit("output.depth", "depth", o.depth, r.output.depth);
  visit("run.threads", "threads", o.threads, r.run.threads);
  visit("limits.max-triangles", "max_triangles", o.max_triangles, r.limits.max_triangles);
  visit("limits.max-memory", "max_memory", o.max_memory, r.limits.max_memory);

  auto& s = o.subdomains;
  visit("decomposition.subdomains", "subdomains.count", s.count, r.decomposition.subdomains);
  visit("decomposition.separator-angle", "subdomains.separator_angle", s.separator_angle,
        r.decomposition.separator_angle);
  visit("decomposition.skew", "subdomains.skew", s.skew, r.decomposition.skew);
  visit("seed", "subdomains.seed", s.seed, r.seed);
  visit("run.presplit", "subdomains.presplit", s.presplit, r.run.presplit);
  visit("run.order", "subdomains.order", s.order, r.run.order);
  visit("run.slice", "subdomains.slice", s.slice, r.run.slice);
  visit("run.sleep", "subdomains.sleep", s.sleep, r.run.sleep);

  visit("mapping.method", "ranks.mapping", o.ranks.mapping, r.mapping.method);
  visit("mapping.speeds", "ranks.speeds", o.ranks.speeds, r.mapping.speeds);
  visit("mapping.by-area", "ranks.map_by_area", o.ranks.map_by_area, r.mapping.by_area);
  visit("run.silence", "ranks.silence", o.ranks.silence, r.patience.silence);
  visit("run.give-up", "ranks.give_up", o.ranks.give_up, r.patience.give_up);
  visit("run.aggregation", "ranks.aggregation", o.ranks.aggregation, r.run.aggregation);

  auto& b = o.balance;
  visit("balance.policy", "balance.policy", b.policy, r.balance.policy);
  visit("balance.parameters", "balance.parameters", b.parameters, r.balance.parameters);
  visit("balance.look", "balance.look", b.look, r.balance.look);
  visit("balance.gap", "balance.gap", b.gap, r.balance.gap);
  visit("balance.interval", "balance.interval", b.interval, r.balance.interval);
  visit("balance.gain", "balance.gain", b.gain, r.balance.gain);
}

/// The request equivalent to the options. Nothing is checked.
[[nodiscard]] job::Request request_of(const MeshOptions& options);

/// A member of the library's options.
struct LibraryName {
  std::string owner;  ///< "MeshOptions::"
  std::string member;
};

/// What the library calls a key, or an option that no key can hold: "progress".
[[nodiscard]] LibraryName library_name(const std::string& key);

/// The same as messages say it: "MeshOptions::max_area".
[[nodiscard]] std::string words_of_library(const std::string& key);

/// Returns the result of `work`; errors that name keys are in the words of the library.
template <class Work>
auto in_words_of_library(const Work& work) {
  try {
    return work();
  } catch (const NamesKeys& error) {
    error.throw_in(words_of_library);
    throw;  // not reached
  }
}

}  // namespace driftmesh
