#include "job/mesh_facts.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <iterator>

#include "geometry/triangle_geometry.hpp"
#include "mesh/digest.hpp"

namespace driftmesh::job {
namespace {

using Group = MeshFacts::ExceptionGroup;

/// The causes in the order in which they are shown, with their descriptions.
constexpr std::array kCauses{ExceptionCause::kInputAngle, ExceptionCause::kShell, ExceptionCause::kPrecision,
                             ExceptionCause::kUnexplained};

const char* cause_words(ExceptionCause cause, bool complete) {
  switch (cause) {
    case ExceptionCause::kInputAngle:
      return "small angle of the input";
    case ExceptionCause::kShell:
      return "wedge between input segments";
    case ExceptionCause::kPrecision:
    case ExceptionCause::kUnexplained:
      break;
  }
  return complete ? "no room between coordinates" : "not reached";
}

Point centroid(const Triangulation& mesh, TriangleId t) {
  const Point &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
}

/// The corner with the smallest angle: the one opposite the shortest edge.
const Point& sharpest_corner(const Triangulation& mesh, TriangleId t) {
  std::array<double, 3> opposite{};
  for (int i = 0; i < 3; ++i)
    opposite[static_cast<std::size_t>(i)] = squared_distance(mesh.corner(t, next(i)), mesh.corner(t, previous(i)));
  return mesh.corner(t, static_cast<int>(std::min_element(opposite.begin(), opposite.end()) - opposite.begin()));
}

/// Keeps the worst places, each once.
void add_places(Group& group, const std::vector<MeshFacts::Place>& places) {
  group.places.insert(group.places.end(), places.begin(), places.end());
  std::stable_sort(group.places.begin(), group.places.end(),
                   [](const MeshFacts::Place& a, const MeshFacts::Place& b) { return a.angle < b.angle; });
  std::vector<MeshFacts::Place> kept;
  for (const MeshFacts::Place& p : group.places)
    if (kept.size() < Group::kMaxPlaces &&
        std::none_of(kept.begin(), kept.end(), [&](const MeshFacts::Place& k) { return k.at == p.at; }))
      kept.push_back(p);
  group.places = std::move(kept);
}

void add_group(MeshFacts& facts, const Group& group) {
  if (group.count == 0) return;
  auto place = std::find_if(facts.exceptions.begin(), facts.exceptions.end(),
                            [&](const Group& g) { return g.cause == group.cause; });
  if (place == facts.exceptions.end()) place = facts.exceptions.insert(place, Group{group.cause, 0, 180, {}});
  place->count += group.count;
  place->worst_angle = std::min(place->worst_angle, group.worst_angle);
  add_places(*place, group.places);
}

void add_skinny(MeshFacts& facts, const Triangulation& mesh, std::vector<Exceptions::Item> skinny, bool complete) {
  std::stable_sort(skinny.begin(), skinny.end(),
                   [](const auto& a, const auto& b) { return a.smallest_angle < b.smallest_angle; });
  for (const ExceptionCause cause : kCauses) {
    Group group{cause_words(cause, complete), 0, 180, {}};
    for (const Exceptions::Item& item : skinny) {
      if (item.cause != cause) continue;
      ++group.count;
      group.worst_angle = std::min(group.worst_angle, item.smallest_angle);
      if (group.places.size() < Group::kMaxPlaces)
        add_places(group, {{sharpest_corner(mesh, item.triangle), item.smallest_angle}});
    }
    add_group(facts, group);
  }
}

void add_large(MeshFacts& facts, const Triangulation& mesh, const std::vector<TriangleId>& large) {
  Group group{"area or size bound missed", static_cast<std::int64_t>(large.size()), 180, {}};
  for (std::size_t i = 0; i < std::min(large.size(), Group::kMaxPlaces); ++i)
    group.places.push_back({centroid(mesh, large[i])});
  add_group(facts, group);
}

void add_shape(AngleSummary& sum, const AngleSummary& part, bool first) {
  sum.smallest = std::min(sum.smallest, part.smallest);
  sum.largest = std::max(sum.largest, part.largest);
  for (std::size_t i = 0; i < sum.bins.size(); ++i) sum.bins[i] += part.bins[i];
  sum.smallest_area = first ? part.smallest_area : std::min(sum.smallest_area, part.smallest_area);
  sum.largest_area = std::max(sum.largest_area, part.largest_area);
  sum.total_area += part.total_area;
}

void add_to(MeshFacts::Step::Group& group, const MeshFacts::Step::Group& other) {
  std::vector<MeshFacts::Step::Place> places;
  const auto take = [&](const MeshFacts::Step::Group& from) {
    const auto known = std::min<std::size_t>(static_cast<std::size_t>(from.count), from.places.size());
    places.insert(places.end(), from.places.begin(), from.places.begin() + static_cast<std::ptrdiff_t>(known));
  };
  take(group);
  take(other);
  std::ranges::stable_sort(places, {}, &MeshFacts::Step::Place::room);
  std::copy_n(places.begin(), std::min(places.size(), group.places.size()), group.places.begin());
  group.count += other.count;
  group.longest_needed = std::max(group.longest_needed, other.longest_needed);
}

void add_step(MeshFacts& facts, const Triangulation& mesh, const TimeStep& step) {
  const StepInspection found = inspect_step(mesh, step);
  facts.step.least_room = std::min(facts.step.least_room, found.least_room);
  for (const StepMiss& miss : found.misses)
    add_to(facts.step.groups[static_cast<std::size_t>(miss.cause)],
           {1, {{{centroid(mesh, miss.triangle), miss.room}}}, miss.needed});
}

/// The plain values of MeshFacts, in the same order for writing and reading.
template <class Stream, class Facts>
void transfer_plain(Stream& stream, Facts& facts) {
  stream.value(facts.triangles);
  stream.value(facts.vertices);
  stream.value(facts.subsegments);
  stream.value(facts.counters);
  stream.value(facts.shape);
  stream.value(facts.digest);
  stream.value(facts.step);
}

}  // namespace

void add_counters(MeshFacts& facts, const RefineCounters& counters) {
  facts.counters.free_points += counters.free_points;
  facts.counters.segment_points += counters.segment_points;
  facts.counters.deleted_points += counters.deleted_points;
  facts.counters.encroaching += counters.encroaching;
  facts.counters.given_up += counters.given_up;
}

void add_part(MeshFacts& facts, const Triangulation& mesh, const QualityBounds& bounds, bool complete,
              bool on_all_cores) {
  // async | deferred: on a thread of its own if the system has one to give.
  const std::launch policy = on_all_cores ? std::launch::async | std::launch::deferred : std::launch::deferred;
  auto digest = std::async(policy, [&] { return mesh_digest(mesh); });
  Inspection found = inspect(mesh, bounds);
  add_shape(facts.shape, found.shape, facts.triangles == 0);
  facts.triangles += static_cast<std::int64_t>(mesh.live_triangles());
  facts.vertices += static_cast<std::int64_t>(mesh.live_vertices());
  facts.subsegments +=
      std::count_if(mesh.subsegments.begin(), mesh.subsegments.end(), [](const auto& s) { return s.is_leaf(); });
  facts.digest += digest.get();
  add_skinny(facts, mesh, std::move(found.exceptions.skinny), complete);
  add_large(facts, mesh, found.exceptions.large);
  if (bounds.step != nullptr) add_step(facts, mesh, *bounds.step);
}

std::int64_t MeshFacts::Step::misses() const {
  std::int64_t sum = 0;
  for (const Group& group : groups) sum += group.count;
  return sum;
}

void MeshFacts::Step::add(const Step& other) {
  least_room = std::min(least_room, other.least_room);
  for (std::size_t k = 0; k < groups.size(); ++k) add_to(groups[k], other.groups[k]);
}

void add_facts(MeshFacts& facts, const MeshFacts& others) {
  if (others.triangles > 0) add_shape(facts.shape, others.shape, facts.triangles == 0);
  facts.triangles += others.triangles;
  facts.vertices += others.vertices;
  facts.subsegments += others.subsegments;
  facts.digest += others.digest;
  add_counters(facts, others.counters);
  facts.step.add(others.step);
  for (const Group& group : others.exceptions) add_group(facts, group);
}

void write_facts(ByteWriter& writer, const MeshFacts& facts) {
  transfer_plain(writer, facts);
  writer.value(static_cast<std::uint64_t>(facts.exceptions.size()));
  for (const Group& group : facts.exceptions) {
    writer.text(group.cause);
    writer.value(group.count);
    writer.value(group.worst_angle);
    writer.array(group.places);
  }
}

MeshFacts read_facts(ByteReader& reader) {
  MeshFacts facts;
  transfer_plain(reader, facts);
  for (auto groups = reader.value<std::uint64_t>(); groups > 0; --groups) {
    Group group;
    group.cause = reader.text();
    reader.value(group.count);
    reader.value(group.worst_angle);
    reader.array(group.places);
    facts.exceptions.push_back(std::move(group));
  }
  return facts;
}

}  // namespace driftmesh::job
