#include "job/key_table.hpp"

#include <algorithm>
#include <utility>

#include "balancer/policy_interface/policy_list.hpp"
#include "decompose/decompose.hpp"
#include "io/mesh_file.hpp"
#include "job/key_words.hpp"
#include "mesh/bounds.hpp"
#include "pslg/generators.hpp"

namespace driftmesh::job {
namespace {

constexpr double kMaxRanks = 100'000;

/// Keys under one heading of the help, with the places and entry points that apply unless a key names its own.
struct Section {
  const char* group;
  Places places;
  EntryPoints entry_points;
  std::vector<Key> keys;
};

Section input_section() {
  const Names<HoleRule> hole_rules = {{HoleRule::kPoints, "points"}, {HoleRule::kNested, "nested"}};
  const Names<RasterOrder> raster_orders = {{RasterOrder::kGiven, "given"}, {RasterOrder::kFinest, "finest"}};
  return {
      "Input",
      kAnywhere,
      kMesh | kExperiment,
      {key("input.file", &R::input, &R::Input::file,
           "The domain: GeoJSON, a shapefile or another file that GDAL reads (.gpkg, .fgb, .gml, .kml, .gmt), "
           "Triangle's .poly (with its .node next to it), .node, or a mesh, whose outline it is",
           file(), option("input"), entry_points(kMesh | kDecompose | kExperiment)),
       key("input.generate", &R::input, &R::Input::generator,
           "Generate the domain instead of reading a file (see driftmesh generate --help)", option("generate", "KIND"),
           one_of(generator_names())),
       key("input.parameters", &R::input, &R::Input::parameters,
           "A parameter of the generated domain, such as resolution=300", option("generate-with", "NAME=VALUE")),
       key("input.layers", &R::input, &R::Input::layers,
           "Of a file with several layers those to read, with commas between their names", option("layers", "NAMES"),
           entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.degrees", &R::input, &R::Input::degrees,
           "The domain is in longitudes and latitudes though its file does not say so, as a .poly or a grid of another "
           "program",
           option("degrees"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.projection", &R::input, &R::Input::projection,
           "The plane for a domain in degrees: a zone, such as \"UTM zone 18N\", or \"stereographic at 0 90\" with the "
           "longitude and latitude of its center; auto: a zone where the domain fits, stereographic around its middle "
           "or a pole otherwise",
           option("projection", "NAME"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.rasters", &R::input, &R::Input::rasters,
           "A raster, by a name that size expressions and depths use, such as depth=bathymetry.asc: an ESRI ASCII "
           "grid (.asc), or what GDAL reads (GeoTIFF, netCDF). Several, with commas between them, are one: gaps and "
           "the "
           "outside of the first are filled from the next",
           of_files(), option("raster", "NAME=FILE"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       key("input.raster-blend", &R::input, &R::Input::raster_blend,
           "The width over which several rasters of one name are blended where one of them ends, in the units of the "
           "domain; at least a spacing of the upper one",
           from(0), option("raster-blend", "LENGTH"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       choice("input.raster-order", &R::input, &R::Input::raster_order, raster_orders,
              "Which of several rasters of one name counts where they overlap: given (the one that is named first) or "
              "finest (the one with the smallest spacing)",
              option("raster-order", "ORDER"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.contour", &R::input, &R::Input::contour,
           "Make the domain where a raster is above a level, instead of reading a file: depth=0, or below it: "
           "elevation<0. Sides of the raster are open sea (marker 3), the rest is land (1) and islands (2)",
           option("contour", "NAME=LEVEL"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.contour-box", &R::input, &R::Input::contour_box,
           "West, south, east and north limits of such a domain, in the coordinates of the raster",
           option("contour-box", "W,S,E,N"), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.contour-seeds", &R::input, &R::Input::contour_seeds,
           "Points in such a domain, in the coordinates of the raster: the parts around them are the domain, "
           "instead of the largest part",
           option("contour-seeds", "X,Y,..."), entry_points(kMesh | kDecompose | kCheck | kExperiment | kPlot)),
       key("input.snap", &R::input, &R::Input::snap,
           "Join vertices at most this far apart, and vertices with segments that near: closes gaps and slivers of the "
           "input. No vertex moves by more; the report has the largest move. 0: join nothing",
           from(0), option("snap", "LENGTH"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       key("input.hull", &R::input, &R::Input::hull,
           "Make the convex hull of all vertices the outline: its edges become segments with marker 1 where there are "
           "none",
           option("hull"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       key("input.simplify", &R::input, &R::Input::simplify,
           "Remove points of lines where these then move by at most this length, and rings that fit into a square "
           "with this side; lines never cross. 0: keep all",
           from(0), option("simplify", "LENGTH"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       key("input.close-channels", &R::input, &R::Input::close_channels,
           "Fill channels of the domain that are narrower than this width: creeks, straits, gaps between islands. "
           "After the other changes of the outline. 0: none",
           from(0), option("close-channels", "WIDTH"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       choice("input.holes", &R::input, &R::Input::holes, hole_rules,
              "What is a hole: points (areas with a hole point of the input), or nested (also every second ring of "
              "segments from the outside in, unless it has a region point)",
              option("holes", "RULE"), entry_points(kMeshers | kDecompose | kCheck | kPlot)),
       key("input.strict", &R::input, &R::Input::strict,
           "Whether warnings about the input are errors: flaws of polygons, segments outside the domain, regions that "
           "are not separated, rings that are neither holes nor regions; and triangles that do not allow the time step",
           option("strict"), entry_points(kMeshers | kDecompose)),
       key("input.marker-names", &R::input, &R::Input::marker_names,
           "What a marker of segments is called in files that can hold names, such as 5=inlet",
           option("marker-name", "MARKER=NAME"), entry_points(kMesh)),
       key("input.region-names", &R::input, &R::Input::region_names,
           "What a region is called in files that can hold names, such as 10=land",
           option("region-name", "REGION=NAME"), entry_points(kMesh))}};
}

Section triangle_section() {
  constexpr EntryPoints kAll = kMeshers | kDecompose | kCheck, kSizes = (kAll & ~kLibrary) | kPlot,
                        kSteps = kMesh | kDecompose | kCheck | kLibrary;
  const Names<CourantLength> courant_lengths = {{CourantLength::kEdge, "edge"}, {CourantLength::kAltitude, "altitude"}};
  return {
      "Triangles (lengths and areas in the units of the input)",
      kAnywhere,
      kAll,
      {key("bounds.angle", &R::bounds, &R::Bounds::angle,
           "Smallest angle, except where small angles of the input force smaller ones. Refinement is proven to "
           "terminate up to 25.6 degrees; in practice it does up to about 33",
           unit("degrees"), in(0, kMaxAngle), because("above that, refinement may not terminate"),
           option('q', "angle", "DEGREES"), entry_points(kMeshers)),
       key("bounds.area", &R::bounds, &R::Bounds::area, "Largest area of a triangle; 0: no bound", from(0),
           option('a', "area", "AREA")),
       key("bounds.triangles", &R::bounds, &R::Bounds::triangles,
           "Instead of an area: choose the one that gives about this many triangles", in(0, 1e12),
           option("triangles", "N"), entry_points(kMeshers | kDecompose)),
       key("bounds.triangles-per-rank", &R::bounds, &R::Bounds::triangles_per_rank, "Likewise, per rank", in(0, 1e10),
           option("triangles-per-rank", "N"), places(kMany), entry_points(kMesh | kExperiment)),
       key("bounds.region-areas", &R::bounds, &R::Bounds::region_areas,
           "Whether the area bounds of the input's regions apply", option("no-region-areas"),
           option_help("Ignore the area bounds of the input's regions")),
       key("sizing.size", &R::sizing, &R::Sizing::expression,
           "Target edge length as a function of x, y and the distance to the nearest segment with one of some "
           "markers: \"0.1 + 0.02*sqrt(x^2 + y^2)\", \"5 + 0.1*distance(1, 2)\"; distance() is that to the nearest of "
           "all segments, width() the local width of the domain. A raster's name is its value, and slope(name) the "
           "length of its gradient: \"max(20, "
           "3*sqrt(9.81*depth))\". driftmesh config --functions lists the functions",
           option("size", "EXPR"), entry_points(kSizes)),
       key("sizing.background", &R::sizing, &R::Sizing::background,
           "Target edge lengths from a background mesh: FILE.node and FILE.ele, with the length as the first "
           "attribute of each point, or FILE.area with an area bound for each triangle",
           file(), option("size-mesh", "FILE"), entry_points(kSizes)),
       key("sizing.tree", &R::sizing, &R::Sizing::tree,
           "Target edge lengths that were compiled and saved before, for the same domain, in place of all others",
           file(), option("size-tree", "FILE"), entry_points(kMesh | kDecompose | kExperiment | kPlot)),
       key("sizing.save-tree", &R::sizing, &R::Sizing::save_tree,
           "Save the target edge lengths, compiled for this domain, for --size-tree", output_file(),
           option("save-size-tree", "FILE"), entry_points(kMesh)),
       key("sizing.across", &R::sizing, &R::Sizing::across,
           "Layers of triangles across every channel, 0: any number. Edges get short enough for that, but not shorter "
           "than --size-min",
           in(0, 100), option("across", "N"), entry_points(kAll | kPlot)),
       key("sizing.gradation", &R::sizing, &R::Sizing::gradation,
           "Limit on the growth of target edge lengths per unit of distance; 0.2 to 0.3 works well; 0: no limit",
           from(0), option("gradation", "G"), entry_points(kSizes)),
       key("sizing.min", &R::sizing, &R::Sizing::shortest, "Lower limit on target edge lengths", from(0),
           option("size-min", "LENGTH"), entry_points(kSizes)),
       key("sizing.max", &R::sizing, &R::Sizing::longest, "Upper limit on target edge lengths; 0: no limit", from(0),
           option("size-max", "LENGTH"), entry_points(kSizes)),
       key("sizing.resolution", &R::sizing, &R::Sizing::resolution,
           "Where only values at points tell the size, they are taken on a grid of this many squares along the longer "
           "side of the domain: no feature that fills a square is missed",
           in(1, 100'000), option("size-resolution", "N"), entry_points(kAll | kPlot)),
       key("sizing.courant-step", &R::sizing, &R::Sizing::courant_step,
           "The time step that all triangles are to allow, before any bound on their size: dt (sqrt(g H) + u) / l is "
           "at most the Courant number, where H is the greatest depth in the triangle, at least 1 m. Takes "
           "coordinates and depths in meters; 0: none",
           unit("seconds"), from(0), option("courant-step", "DT"), entry_points(kSteps)),
       key("sizing.courant", &R::sizing, &R::Sizing::courant, "The largest Courant number with this time step",
           above(0), option("courant", "NUMBER"), entry_points(kSteps)),
       key("sizing.courant-speed", &R::sizing, &R::Sizing::courant_speed, "Speed u of a current that waves travel with",
           unit("m/s"), from(0), option("courant-speed", "U"), entry_points(kSteps)),
       choice("sizing.courant-length", &R::sizing, &R::Sizing::courant_length, courant_lengths,
              "The length l of a triangle: edge (its shortest edge) or altitude (its shortest altitude, for finite "
              "volumes)",
              option("courant-length", "LENGTH"), entry_points(kSteps))}};
}

Section limit_section() {
  return {"Limits",
          kAnywhere,
          kMeshers,
          {key("limits.max-triangles", &R::limits, &R::Limits::max_triangles,
               "Stop at this many triangles, or at once if far more are expected; the default limits only one piece",
               in(1, 1e15), option("max-triangles", "N")),
           key("limits.max-memory", &R::limits, &R::Limits::max_memory,
               "A ceiling for the memory of each process: 6G is 6 GiB; 0: 90 % of the machine's free memory",
               unit("bytes"), in(0, 1e18), option("max-memory", "SIZE")),
           key("limits.keep-incomplete", &R::limits, &R::Limits::keep_incomplete,
               "Write the incomplete mesh when a limit stops the work", option("keep-incomplete"), places(kOnePiece),
               entry_points(kMesh | kExperiment))}};
}

Section parts_section() {
  const Names<MappingMethod> mappings = {
      {MappingMethod::kGraph, "graph"}, {MappingMethod::kBlock, "block"}, {MappingMethod::kRoundRobin, "round-robin"}};
  const Names<Presplit> presplits = {{Presplit::kAuto, "auto"}, {Presplit::kOn, "on"}, {Presplit::kOff, "off"}};
  const Names<Method> methods = {{Method::kCoupled, "coupled"},
                                 {Method::kRounds, "rounds"},
                                 {Method::kDecoupled, "decoupled"},
                                 {Method::kPdr, "pdr"}};
  const Names<WorkOrder> orders = {
      {WorkOrder::kGiven, "given"}, {WorkOrder::kLargest, "largest"}, {WorkOrder::kBacklog, "backlog"}};
  return {
      "Subdomains and ranks",
      kCut,
      kMeshers,
      {key("decomposition.subdomains", &R::decomposition, &R::Decomposition::subdomains,
           "Number of subdomains, far more than ranks; also without mpirun; 1: one piece; 0: 20 per rank, or more so "
           "that each fits in cache",
           in(0, kMaxSubdomains), option('n', "subdomains", "N"), places(kAnywhere),
           entry_points(kMeshers | kDecompose)),
       key("decomposition.subdomains-per-rank", &R::decomposition, &R::Decomposition::subdomains_per_rank,
           "Likewise, per rank", in(0, 1e5), option("subdomains-per-rank", "N"), places(kMany),
           entry_points(kMesh | kExperiment)),
       key("decomposition.file", &R::decomposition, &R::Decomposition::file,
           "Use a decomposition made by driftmesh decompose", file(), option("decomposition", "FILE"),
           entry_points(kMesh | kExperiment)),
       key("decomposition.separator-angle", &R::decomposition, &R::Decomposition::separator_angle,
           "Smallest angle between separators and whatever they meet, where the domain allows it", unit("degrees"),
           in(0, kMaxSeparatorAngle), option("separator-angle", "DEGREES"), entry_points(kMeshers | kDecompose)),
       key("decomposition.skew", &R::decomposition, &R::Decomposition::skew,
           "0: equal work. Above: deliberately uneven subdomains, for experiments; each cut gives one side up to 1 + "
           "S times its fair share",
           in(0, kMaxSkew), option("split-skew", "S"), entry_points(kMeshers | kDecompose)),
       key("decomposition.forecast-error", &R::decomposition, &R::Decomposition::forecast_error,
           "To study balancing: multiplies the forecast of each subdomain's work by a random factor between 1/F and "
           "F, until work on the subdomain begins",
           in(1, 1e6), places(kMany), entry_points(kExperiment)),
       key("seed", &R::seed,
           "Random seed for uneven subdomains and wrong forecasts; each repetition of an experiment adds one", from(0),
           option("seed", "N"), entry_points(kMeshers | kDecompose)),
       choice("mapping.method", &R::mapping, &R::Mapping::method, mappings,
              "Initial mapping of subdomains to ranks: graph (equal work, short interfaces), block or round-robin",
              option("mapping", "HOW"), places(kMany)),
       key("mapping.speeds", &R::mapping, &R::Mapping::speeds,
           "Relative speed of each rank, if known: work is mapped in proportion", above(0), option("speeds", "S,S,..."),
           places(kMany)),
       key("mapping.by-speed", &R::mapping, &R::Mapping::by_speed,
           "Map work in proportion to the speeds of the cluster", option("map-by-speed"), places(kMany),
           entry_points(kMesh | kExperiment)),
       key("mapping.by-area", &R::mapping, &R::Mapping::by_area,
           "Map by area instead of expected work: an uneven start, for experiments", option("map-by-area"),
           places(kMany)),
       key("mapping.to-late-ranks", &R::mapping, &R::Mapping::to_late_ranks,
           "Map work also to simulated ranks that are not there at the start (cluster.changes); otherwise they get "
           "only what a policy gives them",
           places(kSimulated), entry_points(kExperiment)),
       key("mapping.file", &R::mapping, &R::Mapping::file,
           "Take the mapping from load balancing statistics of DARMA vt, as written by lb-statistics or by LBAF: the "
           "file of rank 0 (data.0.json)",
           file(), option("mapping-file", "FILE"), places(kMany), entry_points(kMesh | kExperiment)),
       choice("run.method", &R::run, &R::Run::method, methods,
              "How subdomains agree on the points between them: coupled (they tell each other at once), rounds (of "
              "driftmesh mesh alone: after each round of refinement, so that the mesh does not depend on the number of "
              "ranks), decoupled (all are made beforehand, and a run that needs more fails), or pdr (no subdomains: "
              "ranks refine the cells of a lattice)",
              reserved_for(kExperiment, "pdr"), reserved_for(kMesh, "rounds"), option("method", "METHOD"),
              option_help("How subdomains agree on the points between them: coupled (they tell each other at once), "
                          "rounds (after each round of refinement, so that the mesh does not depend on the number of "
                          "ranks) or decoupled (all are made beforehand, and a mesh that needs more fails)"),
              entry_points(kMesh | kExperiment)),
       choice(
           "run.presplit", &R::run, &R::Run::presplit, presplits,
           "Split interfaces to size before refinement: on, off (the full protocol), or auto (on if there is a bound "
           "on area or size)",
           option("presplit", "MODE")),
       key("run.aggregation", &R::run, &R::Run::aggregation, "Most split points in one message", in(1, 1e6),
           option("aggregation", "K"), places(kMany)),
       choice("run.order", &R::run, &R::Run::order, orders,
              "Which subdomain a rank refines next: given (neighbors together), largest or backlog",
              option("work-order", "ORDER")),
       key("run.slice", &R::run, &R::Run::slice, "Most points inserted between polls of the network", in(1, 1e9),
           option("slice", "N")),
       key("run.silence", &R::patience, &R::Patience::silence,
           "Name a rank that has not answered for so long, with its host and what it did; 10m are ten minutes",
           unit("seconds"), from(1), option("silence", "TIME"), places(kSubdomains | kRanks),
           entry_points(kMesh | kLibrary)),
       key("run.give-up", &R::patience, &R::Patience::give_up,
           "End the run when a rank has not answered for so long; 0: wait for it", unit("seconds"), from(0),
           option("give-up", "TIME"), places(kSubdomains | kRanks), entry_points(kMesh | kLibrary)),
       key("run.sleep", &R::run, &R::Run::sleep,
           "Compress finished subdomains to about 10 bytes per triangle, from 40, until a neighbor needs them; also "
           "without it where memory would not suffice",
           option("sleep")),
       key("run.scratch", &R::run, &R::Run::scratch,
           "Folder on a fast disk where finished subdomains sleep, for meshes larger than memory: about 10 bytes per "
           "triangle, gone when the program ends",
           option("scratch", "FOLDER"), places(kOnePiece | kSubdomains | kRanks), entry_points(kMesh)),
       key("run.threads", &R::run, &R::Run::threads,
           "Threads that mesh together in a process; 0: one for each core, but under mpirun one in each. Without "
           "mpirun the mesh does not depend on their number",
           in(0, 1024), option("threads", "N"), places(kOnePiece | kSubdomains | kRanks),
           entry_points(kMesh | kLibrary)),
       key("run.checkpoint", &R::run, &R::Run::checkpoint,
           "Keep the work done so far in this file, from which --resume goes on with it: now and then, when SIGUSR1 "
           "comes, and where SIGTERM or a limit ends the run. Implies --method rounds",
           output_file(), option("checkpoint", "FILE"), places(kSubdomains), entry_points(kMesh)),
       key("run.every", &R::run, &R::Run::every, "Time between two checkpoints; 10m are ten minutes", unit("seconds"),
           above(0), option("every", "TIME"), places(kSubdomains), entry_points(kMesh)),
       key("run.resume", &R::run, &R::Run::resume,
           "Go on with the work in a checkpoint, on any number of ranks or threads: the mesh is that of the run that "
           "was never stopped. All that decides it comes from the file; outputs, limits and threads may be given",
           file(), option("resume", "FILE"), places(kSubdomains), entry_points(kMesh))}};
}

Section balance_section() {
  return {
      "Balancing: subdomains move between ranks while they are refined",
      kMany,
      kMeshers,
      {key("balance.policy", &R::balance, &R::Balance::policy, "The policy that plans moves (docs/balancing.md)",
           one_of(balancer::policy_names()), or_file(balancer::kPolicyLibrary), option("balance", "POLICY")),
       key("balance.parameters", &R::balance, &R::Balance::parameters,
           "A parameter of the policy, such as method=graph; in a sweep over policies, of one of them: "
           "zoltan.method=graph",
           option("balance-with", "NAME=VALUE")),
       key("balance.look", &R::balance, &R::Balance::look, "Time between a rank's checks of its own load",
           unit("seconds"), above(0), option("balance-look", "SECONDS")),
       key("balance.gap", &R::balance, &R::Balance::gap, "Shortest time between reports of a rank, and between plans",
           unit("seconds"), from(0), option("balance-gap", "SECONDS")),
       key("balance.interval", &R::balance, &R::Balance::interval,
           "Longest time between reports of a rank that has work", unit("seconds"), above(0),
           option("balance-interval", "SECONDS")),
       key("balance.gain", &R::balance, &R::Balance::gain, "Fraction of the finishing time that moving must save",
           in(0, 1), option("balance-gain", "SHARE"))}};
}

Section cluster_section() {
  const Names<ClusterKind> kinds = {{ClusterKind::kSimulated, "simulated"}, {ClusterKind::kReal, "real"}};
  return {
      "Clusters",
      kSimulated,
      kExperiment,
      {choice("cluster.kind", &R::cluster, &R::Cluster::kind, kinds,
              "Simulated ranks in virtual time, or real ones started by mpirun", places(kMany)),
       key("cluster.ranks", &R::cluster, &R::Cluster::ranks, "Number of ranks; 0: given by cluster.groups or mpirun",
           in(0, kMaxRanks), places(kMany)),
       key("cluster.speed", &R::cluster, &R::Cluster::speed,
           "Triangles per second that each rank refines; 0: 7.9 million, like the machine in docs/benchmarks.md",
           unit("triangles/s"), from(0)),
       list("cluster.groups", &R::cluster, &R::Cluster::groups,
            "Ranks of different kinds, numbered in this order, instead of cluster.ranks and cluster.speed",
            field("name", &RankGroup::name, "Name of the group"),
            field("ranks", &RankGroup::ranks, "Number of ranks", in(1, kMaxRanks)),
            field("speed", &RankGroup::speed, "Triangles per second that each rank refines; 0: 7.9 million",
                  unit("triangles/s"), from(0))),
       key("cluster.rank-speeds", &R::cluster, &R::Cluster::rank_speeds,
           "Triangles per second of each rank, instead of cluster.ranks, cluster.speed and cluster.groups",
           unit("triangles/s"), above(0)),
       list("cluster.changes", &R::cluster, &R::Cluster::changes,
            "Changes of speeds during a run, on simulated clusters, such as {rank: 0, at: 5, factor: 0.25}; 0 for "
            "ranks that are not there until a later change",
            field("rank", &RankChange::rank, "The first rank that changes", in(0, kMaxRanks - 1)),
            field("ranks", &RankChange::ranks, "Number of ranks that change", in(1, kMaxRanks)),
            field("at", &RankChange::at, "Since the start of refinement", unit("seconds"), from(0)),
            field("factor", &RankChange::factor, "Of the speed that the ranks have without changes", from(0))),
       key("cluster.drag", &R::cluster, &R::Cluster::drag,
           "Fraction of its speed that each rank keeps, real or simulated, such as 1,0.5; empty: all of it",
           in(0.01, 1), option("drag", "F,F,..."), places(kMany), entry_points(kMesh | kExperiment)),
       key("cluster.memory", &R::cluster, &R::Cluster::memory,
           "Triangles for which each rank of a simulated cluster has memory: it takes no work beyond nine tenths of "
           "that, and more than all of it stop the run; 0: any number",
           unit("triangles"), from(0)),
       key("cluster.latency", &R::cluster, &R::Cluster::latency,
           "Time from the end of sending to arrival, on simulated clusters", unit("seconds"), from(0), places(kMany)),
       key("cluster.bandwidth", &R::cluster, &R::Cluster::bandwidth,
           "Bytes per second that a host can send, on simulated clusters", above(0), places(kMany)),
       key("cluster.ranks-per-host", &R::cluster, &R::Cluster::ranks_per_host,
           "Consecutive ranks that share a host, and with it the bandwidth: messages within a host go through memory, "
           "at 5 GB/s and 1 us",
           in(1, kMaxRanks)),
       key("cluster.message-overhead", &R::cluster, &R::Cluster::message_overhead,
           "Time a rank spends on each message it sends or receives, on simulated clusters", unit("seconds"), from(0),
           places(kMany)),
       key("cluster.scale", &R::cluster, &R::Cluster::scale,
           "Triangles that each one stands for, where speeds are scaled down: planning and the start of subdomains, "
           "which depend on their number, cost that much less than the speeds say",
           above(0)),
       key("cluster.costs", &R::cluster, &R::Cluster::costs,
           "What work and planning cost, as measured by driftmesh calibrate; empty: as on the machine in "
           "docs/benchmarks.md",
           file())}};
}

Section output_section() {
  const Names<MeshOrder> mesh_orders(kMeshOrders.begin(), kMeshOrders.end());
  const std::string meshes_help =
      "Mesh file; its extension selects the format: " + mesh_files_described() + "; - is standard output";
  return {
      "Output",
      kAnywhere,
      kMesh,
      {key("output.meshes", &R::output, &R::Output::meshes, meshes_help.c_str(), option('o', "output", "FILE")),
       key("output.ascii", &R::output, &R::Output::ascii,
           "Write .msh as text, for programs that read no binary one (deal.II)", option("ascii")),
       choice("output.order", &R::output, &R::Output::order, mesh_orders,
              "Order of points and triangles in files that one process writes: given (points of the domain first), "
              "hilbert (along a Hilbert curve) or rcm (reverse Cuthill-McKee, for solvers: a small bandwidth)",
              option("order", "ORDER")),
       key("output.ghost-layer", &R::output, &R::Output::ghost_layer,
           "Write the pieces of .pvtu with a ring of triangles of their neighbors, marked as ghosts",
           option("ghost-layer")),
       key("output.open-boundary", &R::output, &R::Output::open_boundary,
           "Markers of the segments that are open sea, in .14, .grd and .gr3 (none: those of markers called open)",
           in(INT32_MIN, INT32_MAX), option("open-boundary", "MARKERS")),
       key("output.open-from", &R::output, &R::Output::open_from,
           "Shortest open boundary in .14, .grd and .gr3, along it; shorter ones, such as creeks that the frame of "
           "the domain cuts, are land",
           from(0), option("open-from", "LENGTH")),
       key("output.crs", &R::output, &R::Output::crs,
           "Coordinates in files: lonlat (degrees on WGS 84), projected (meters of the plane in which the mesh was "
           "made), a code such as EPSG:3035 (with GDAL), or auto: lonlat in .14, .grd and .gr3 if the domain was "
           "given in degrees, otherwise projected",
           option("crs", "SYSTEM")),
       key("output.depth", &R::output, &R::Output::depth,
           "Give each point the value of the raster of this name as its attribute, called so in .vtu, .h5 and .msh, "
           "the depth in .14, .grd and .gr3",
           option("depth", "NAME"), entry_points(kMesh | kDecompose | kCheck | kLibrary),
           option_help("The raster of depths: each point gets its value as its attribute, called so in .vtu, .h5 and "
                       ".msh, the depth in .14, .grd and .gr3, and --courant-step asks it")),
       key("output.session", &R::output, &R::Output::session,
           "Save the mesh as an adaptive one that AdaptiveMesh.load, of Python and C++, goes on with on any number of "
           "ranks. Implies --method rounds",
           output_file(), option("save", "FILE"), places(kSubdomains), entry_points(kMesh)),
       key("output.picture", &R::output, &R::Output::picture,
           "Picture of the mesh: .png, .svg or .pdf (see also driftmesh plot --help)", output_file(),
           option("plot", "FILE")),
       key("output.record", &R::output, &R::Output::record, "Also write the summary as JSON", output_file(),
           option("json", "FILE")),
       key("output.quiet", &R::output, &R::Output::quiet, "Print only errors", option("quiet"))}};
}

Section experiment_section() {
  return {
      "Experiments",
      kMany,
      kExperiment,
      {key("name", &R::name, "Name of the results; by default that of the file"),
       key("repetitions", &R::repetitions, "Number of times each run is made", in(1, 1000)),
       key("report", &R::report, "Write what each rank did when, and all runs as a page for browsers"),
       key("lb-statistics", &R::lb_phases,
           "Number of phases in the load balancing statistics written for DARMA vt's tools; 0: none", in(0, 10'000))}};
}

}  // namespace

std::vector<Key> all_keys() {
  std::vector<Key> keys;
  for (Section& section : std::vector{input_section(), triangle_section(), limit_section(), parts_section(),
                                      balance_section(), cluster_section(), output_section(), experiment_section()})
    for (Key& k : section.keys) {
      k.group = section.group;
      if (k.places == kAsSection) k.places = section.places;
      if (k.entry_points == kAsSection) k.entry_points = section.entry_points;
      keys.push_back(std::move(k));
    }
  return keys;
}

}  // namespace driftmesh::job
