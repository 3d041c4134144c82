#include "migration/packed_form.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/triangulation_fault.hpp"
#include "migration/archive.hpp"
#include "migration/packed_bytes.hpp"

// Types stored as they are in memory. No padding: the same state gives the same bytes.
static_assert(std::has_unique_object_representations_v<driftmesh::Triangle>);
static_assert(std::has_unique_object_representations_v<driftmesh::Subsegment>);
static_assert(std::has_unique_object_representations_v<driftmesh::RootSegment>);
static_assert(std::has_unique_object_representations_v<driftmesh::Sweep::Places>);
static_assert(std::has_unique_object_representations_v<driftmesh::RefineCounters>);
static_assert(sizeof(driftmesh::Point) == 2 * sizeof(double));

namespace driftmesh {

template <>
inline constexpr bool kIsFlat<Triangle> = true;
template <>
inline constexpr bool kIsFlat<Subsegment> = true;
template <>
inline constexpr bool kIsFlat<RootSegment> = true;
template <>
inline constexpr bool kIsFlat<Sweep::Places> = true;
template <>
inline constexpr bool kIsFlat<RefineCounters> = true;
template <>
inline constexpr bool kIsFlat<Point> = true;

namespace {

#ifdef DRIFTMESH_CHECKED
constexpr bool kCheckAll = true;
#else
constexpr bool kCheckAll = false;
#endif

enum class Content : std::uint8_t { kNotStarted, kMesh, kDormant };

[[noreturn]] void refuse(const std::string& why) {
  throw Error(why);
}
void require(bool condition, const char* why) {
  if (!condition) refuse(why);
}

bool is_path(dyadic::Path path) {
  return path >= dyadic::kWhole && dyadic::depth(path) <= dyadic::kMaxDepth;
}

// ---- Points on edges: numbers and paths separately, since a struct of both has padding ----

template <class Root>
void save_points(ArchiveWriter& out, const std::vector<SplitPoint<Root>>& points) {
  std::vector<std::int32_t> roots;
  std::vector<dyadic::Path> paths;
  for (const SplitPoint<Root>& p : points) {
    roots.push_back(to_int(p.root));
    paths.push_back(p.path);
  }
  out.array(roots);
  out.array(paths);
}

template <class Root>
void load_points(ArchiveReader& in, std::vector<SplitPoint<Root>>& points) {
  std::vector<std::int32_t> roots;
  std::vector<dyadic::Path> paths;
  in.array(roots);
  in.array(paths);
  require(roots.size() == paths.size(), "split points without roots");
  for (std::size_t i = 0; i < roots.size(); ++i) {
    require(roots[i] >= 0 && is_path(paths[i]), "a split point has no valid place");
    points.push_back({Root{roots[i]}, paths[i]});
  }
}

// ---- The mesh: the fields in one order for both directions ----

template <class Archive, class Part>
void transfer_mesh(Archive& archive, Part& part) {
  auto& mesh = part.mesh;
  archive.array(mesh.triangles);
  archive.array(mesh.points);
  archive.array(mesh.origin);
  archive.array(mesh.region);
  archive.array(mesh.subsegments);
  archive.array(mesh.roots);
  archive.array(mesh.free_triangles);
  archive.array(mesh.free_vertices);
  archive.array(part.roots);
  archive.array(part.points);
}

void check_part(const SubdomainMesh& part) {
  if (const std::string fault = triangulation_fault(part.mesh); !fault.empty()) refuse(fault);
  require(part.roots.size() == part.mesh.roots.size(), "roots without numbers");
  require(std::is_sorted(part.roots.begin(), part.roots.end(), std::less_equal<>()), "roots out of order");
  require(part.roots.empty() || part.roots.front() >= GlobalRootId{0}, "a root has no number");
  require(std::ranges::all_of(part.points, [](GlobalPointId v) { return v >= GlobalPointId{0}; }),
          "a point has no number");
}

// ---- The refiner ----

void save_skinny(ArchiveWriter& out, const SkinnyBuckets& skinny) {
  std::vector<TriangleId> triangles;
  std::vector<std::uint16_t> buckets;
  for (const SkinnyBuckets::Entry& e : skinny.entries()) {
    triangles.push_back(e.triangle);
    buckets.push_back(static_cast<std::uint16_t>(e.bucket));
  }
  out.array(triangles);
  out.array(buckets);
}

void load_skinny(ArchiveReader& in, SkinnyBuckets& skinny) {
  std::vector<TriangleId> triangles;
  std::vector<std::uint16_t> buckets;
  in.array(triangles);
  in.array(buckets);
  require(triangles.size() == buckets.size(), "skinny triangles without lengths");
  require(std::is_sorted(buckets.begin(), buckets.end()), "skinny triangles out of order");
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    require(buckets[i] < SkinnyBuckets::kBuckets, "a skinny triangle of impossible length");
    skinny.add(triangles[i], buckets[i]);
  }
}

void save_refiner(ArchiveWriter& out, const RefinerState& state, std::size_t vertices) {
  out.value(state.stage);
  out.value(state.next_segment);
  out.value(state.sweep.places());
  out.array(state.sweep.again());
  save_skinny(out, state.skinny);
  out.array(state.deferred);
  std::vector<SubsegmentId> unsplittable(state.unsplittable.begin(), state.unsplittable.end());
  std::sort(unsplittable.begin(), unsplittable.end());
  out.array(unsplittable);
  save_points(out, state.made);
  out.array(std::span(state.size.data(), std::min(vertices, state.size.size())));
  out.value(state.max_triangles);
  out.value(state.counters);
}

RefinerState load_refiner(ArchiveReader& in) {
  RefinerState state;
  in.value(state.stage);
  in.value(state.next_segment);
  Sweep::Places places{};
  GrowingArray<TriangleId> again;
  in.value(places);
  in.array(again);
  state.sweep = Sweep(places, std::move(again));
  load_skinny(in, state.skinny);
  in.array(state.deferred);
  std::vector<SubsegmentId> unsplittable;
  in.array(unsplittable);
  require(std::is_sorted(unsplittable.begin(), unsplittable.end(), std::less_equal<>()), "subsegments out of order");
  state.unsplittable.insert(unsplittable.begin(), unsplittable.end());
  load_points(in, state.made);
  in.array(state.size);
  in.value(state.max_triangles);
  in.value(state.counters);
  return state;
}

// ---- The dormant form ----

template <class Archive, class Body>
void transfer_dormant(Archive& archive, Body& body) {
  DormantMesh::fields(body.mesh, [&](auto& field) {
    if constexpr (requires { field.data(); })
      archive.array(field);
    else
      archive.value(field);
  });
  archive.array(body.unsplittable);
  archive.value(body.max_triangles);
  archive.value(body.counters);
  archive.value(body.forecast);
}

void check_dormant(const DormantBody& body) {
  require(std::isfinite(body.forecast), "the forecast is not a number");
  require(std::is_sorted(body.unsplittable.begin(), body.unsplittable.end(), std::less_equal<>()),
          "subsegments out of order");
  body.mesh.check();
  const std::size_t subsegments = body.mesh.skeleton().mesh.subsegments.size();
  require(std::ranges::all_of(body.unsplittable, [&](SubsegmentId s) { return to_index(s) < subsegments; }),
          "an unsplittable subsegment does not exist");
  check_part(body.mesh.wake());
}

// ---- The whole ----

void load_body(ArchiveReader& in, SubdomainState::Body& body) {
  in.value(body.forecast);
  transfer_mesh(in, body.part);
  body.refiner = load_refiner(in);
}

void check_body(const SubdomainState::Body& body) {
  require(std::isfinite(body.forecast), "the forecast is not a number");
  check_part(body.part);
  require(body.refiner.size.empty() || body.refiner.size.size() == body.part.mesh.points.size(),
          "the size field is not known at each vertex");
}

void load(ArchiveReader& in, SubdomainState& subdomain) {
  std::uint8_t refined = 0;
  Content content{};
  in.value(subdomain.id);
  in.value(refined);
  in.value(content);
  require(subdomain.id >= SubdomainId{0}, "it has no number");
  require(refined <= 1 && content <= Content::kDormant, "it has invalid flags");
  subdomain.refined = refined != 0;
  load_points(in, subdomain.pending);
  if (content == Content::kMesh) {
    SubdomainState::Body body;
    load_body(in, body);
    subdomain.body = std::move(body);
  }
  if (content == Content::kDormant) transfer_dormant(in, subdomain.dormant.emplace());
  require(in.at_end(), "bytes are left over");
}

void check(const SubdomainState& subdomain) {
  const bool done =
      subdomain.dormant || (subdomain.body && subdomain.body->refiner.stage == RefinerState::Stage::kDone);
  require(done || !subdomain.refined, "it contradicts itself on being refined");
  require(subdomain.refined || !subdomain.dormant, "it is dormant but not refined");
  if (subdomain.body) check_body(*subdomain.body);
  if (subdomain.dormant) check_dormant(*subdomain.dormant);
}

/// The message of the error that a step throws; empty if it does not throw.
template <class Step>
std::string complaint_of(Step&& step) {
  try {
    step();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Content content_of(const SubdomainView& subdomain) {
  if (subdomain.body) return Content::kMesh;
  return subdomain.dormant != nullptr ? Content::kDormant : Content::kNotStarted;
}

std::size_t body_bytes(const SubdomainView::Body& body) {
  const Triangulation& mesh = body.part.mesh;
  return body.refiner.size.size() * sizeof(double) + mesh.triangles.size() * sizeof(Triangle) +
         mesh.points.size() * (sizeof(Point) + sizeof(VertexOrigin)) + mesh.region.size() * sizeof(std::uint16_t) +
         mesh.subsegments.size() * sizeof(Subsegment);
}

void write(const SubdomainView& subdomain, SealedBytes& bytes) {
  ArchiveWriter out(bytes);
  out.value(subdomain.id);
  out.value(static_cast<std::uint8_t>(subdomain.refined));
  out.value(content_of(subdomain));
  save_points(out, subdomain.pending);
  if (subdomain.body) {
    out.value(subdomain.body->forecast);
    transfer_mesh(out, subdomain.body->part);
    save_refiner(out, subdomain.body->refiner, subdomain.body->part.mesh.points.size());
  }
  if (subdomain.dormant != nullptr) transfer_dormant(out, *subdomain.dormant);
}

}  // namespace

Bytes pack(const SubdomainView& subdomain, std::size_t room_behind) {
  constexpr std::size_t kSmallArrays = 4096;
  SealedBytes bytes(kSmallArrays + room_behind +
                    (subdomain.body                 ? body_bytes(*subdomain.body)
                     : subdomain.dormant != nullptr ? subdomain.dormant->mesh.bytes()
                                                    : 0));
  write(subdomain, bytes);
  return bytes.take();
}

std::uint64_t packed_size(const SubdomainView& subdomain) {
  SealedBytes bytes = SealedBytes::counted();
  write(subdomain, bytes);
  return bytes.size();
}

SubdomainState unpack(std::span<const std::byte> bytes, Source source) {
  SealReader sealed(bytes, "the packed form of a subdomain");
  SubdomainState subdomain;
  std::string complaint = complaint_of([&] {
    ArchiveReader in(sealed);
    load(in, subdomain);
  });
  sealed.verify();  // reported first: damaged bytes explain all other errors
  const bool vouched_for = source == Source::kThisRun && !kCheckAll;
  if (complaint.empty() && !vouched_for) complaint = complaint_of([&] { check(subdomain); });
  if (!complaint.empty())
    throw Error("the packed form of subdomain " + to_string(subdomain.id) + " is damaged: " + complaint);
  return subdomain;
}

}  // namespace driftmesh
