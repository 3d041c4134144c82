#pragma once

#include <memory>
#include <span>
#include <string>

#include "balancer/policy_interface/policy_list.hpp"
#include "decompose/decomposition.hpp"
#include "driftmesh/close_channels.hpp"
#include "driftmesh/pslg.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "job/rasters.hpp"
#include "job/request.hpp"
#include "job/watch.hpp"
#include "mesh/bounds.hpp"
#include "sizing/creeks.hpp"
#include "sizing/make_size_field.hpp"
#include "sizing/time_step.hpp"

namespace driftmesh::job {

/// Data that a caller has in memory, which replaces what a request names. Null: none. Pointers are not owning.
struct Given {
  const Pslg* input = nullptr;                   ///< as the user provides it; it is repaired first
  const SizeField* size = nullptr;               ///< the same function on every rank
  const Decomposition* decomposition = nullptr;  ///< made from the same input, after repair
  balancer::PolicyMaker policies{};              ///< for load balancing; equal on every rank
  InsertionRules rules{};                        ///< other than these only for one piece
};

/// The domain to be meshed.
struct Domain {
  Pslg pslg;                 ///< repaired
  std::string projection;    ///< see InputFile
  bool from_lonlat = false;  ///< likewise
  RepairReport repairs;
  SimplifyReport simplified;              ///< without its points
  ClosedChannels closed;                  ///< likewise
  std::vector<Creek> creeks;              ///< too narrow for what is asked for across them, the narrowest first
  Rasters rasters;                        ///< open
  std::shared_ptr<const SizeField> size;  ///< null: none is asked for
  std::shared_ptr<const BackgroundMesh> background;  ///< the one that the size field uses; null: none
  InsertionRules rules;
  std::shared_ptr<const TimeStep> step;  ///< null: none is asked for
};

/// Reads or generates the domain, repairs and simplifies it, applies the rule for holes, closes channels, and makes the
/// size field.
/// Throws InputError, FileError.
[[nodiscard]] Domain read_domain(const Request& request, const Given& given, Watch& watch);

/// Does to an input what read_domain does, without telling anybody: repairs and simplifies it, and closes channels.
/// Holes between nested rings are left for who judges a mesh to find, unless channels are closed: see holes_left.
/// `name` is for messages. Throws InputError.
RepairReport clean_input(const Request::Input& asked, const std::string& name, Pslg& pslg);

/// The rule for the holes of what clean_input() leaves.
[[nodiscard]] HoleRule holes_left(const Request::Input& asked);

/// The names that a request gives to markers and regions. Throws KeyError for what is no marker or no region.
[[nodiscard]] Names names_of(const Request::Input& asked);

/// Passes on warnings about the input, only the first of them if there are very many. Throws InputError instead if the
/// request is strict.
void warn(const Request& request, std::span<const std::string> warnings, Watch& watch);

/// The size field that the request asks for, or the given one if not null, for a domain with these points: the same on
/// every rank. `rasters`: those that the expression may name. Null if there is none. Throws InputError, FileError.
[[nodiscard]] SizeSource size_of(const Request::Sizing& sizing, const NamedRasters& rasters, const SizeField* given,
                                 const Pslg& pslg);

/// What a caller describes (a DescribedField), as check() judges it: as its sources give it, in this box. `input`: the
/// domain, which is not owned, or null.
[[nodiscard]] SizeSource exact_size_of(const SizeField& described, const Pslg* input, const Box& box);

/// The time step that the request asks for, with its raster of depths, which is open; null if there is none.
[[nodiscard]] std::shared_ptr<const TimeStep> step_of(const Request::Sizing& sizing, const Rasters& rasters);
[[nodiscard]] CourantRule courant_of(const Request::Sizing& sizing);

/// What the request asks for of the sizes of triangles in a domain inside `box`, and in this one, which is not owned.
[[nodiscard]] SizingOptions sizing_of(const Request::Sizing& sizing, const Box& box);
[[nodiscard]] SizingOptions sizing_of(const Request::Sizing& sizing, const Pslg& pslg);

/// Around the segments, or around the points if there are none.
[[nodiscard]] Box box_of(const Pslg& pslg);

/// The name of the domain: its file, the generated model, or "input" if a caller has it in memory.
[[nodiscard]] std::string input_name(const Request& request);

}  // namespace driftmesh::job
