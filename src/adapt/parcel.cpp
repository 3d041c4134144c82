#include "adapt/parcel.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "driftmesh/error.hpp"
#include "mesh/refiner_state.hpp"

namespace driftmesh::adapt {
namespace {

/// Calls visit(begin, count) for each stretch of a field's values on a part, in order.
template <class Visit>
void visit_stretches(const Generation& generation, SubdomainId s, const Field& field, const Visit& visit) {
  if (field.place == FieldPlace::kPoints) {
    for (const std::int32_t place : generation.places[s])
      if (place != kNone) visit(to_index(place) * field.components, field.components);
    return;
  }
  const std::size_t each = values_at(field);
  visit(to_index(generation.first_triangle[s]) * each, generation.parts[s].mesh->mesh.live_triangles() * each);
}

/// The lengths by which vertices were made are the sizes that a refiner at rest knows.
RefinerState state_of(const Part& part) {
  RefinerState state;
  state.stage = RefinerState::Stage::kDone;
  if (!part.made_for) return state;
  for (const double length : *part.made_for) state.size.push_back(length);
  return state;
}

const std::vector<SplitPoint<GlobalRootId>> kNothingPending;

SubdomainView view_of(SubdomainId s, const Part& part, const RefinerState& state) {
  return {s, true, kNothingPending, SubdomainView::Body{*part.mesh, state, part.asked}};
}

/// The length of the packed subdomain, the density, and the number of fields.
constexpr std::size_t kBytesBeside = 2 * sizeof(std::uint64_t) + sizeof(double);

std::size_t bytes_of_values(std::size_t count) {
  return sizeof(std::uint64_t) + count * sizeof(double);
}

}  // namespace

ValuesOnPart values_on(const Generation& generation, SubdomainId s, const Fields& fields) {
  ValuesOnPart all;
  for (const auto& named : fields) {
    const Field& field = named.second;
    std::vector<double>& values = all.emplace_back();
    visit_stretches(generation, s, field, [&](std::size_t begin, std::size_t count) {
      const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(begin);
      values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(count));
    });
  }
  return all;
}

void set_values_on(const Generation& generation, SubdomainId s, const ValuesOnPart& values, Fields& fields) {
  if (values.size() != fields.size()) throw Error("a part has other fields than the rank");
  auto of_field = values.begin();
  for (auto& named : fields) {
    const std::string& name = named.first;
    Field& field = named.second;
    std::size_t next = 0;
    visit_stretches(generation, s, field, [&](std::size_t begin, std::size_t count) {
      if (count > of_field->size() - next) throw Error("field '" + name + "' lacks values on a part");
      std::copy_n(of_field->begin() + static_cast<std::ptrdiff_t>(next), count,
                  field.values.begin() + static_cast<std::ptrdiff_t>(begin));
      next += count;
    });
    if (next != of_field->size()) throw Error("field '" + name + "' has too many values on a part");
    ++of_field;
  }
}

Fields without_values(const Fields& fields, const DistributedPiece& piece) {
  Fields all;
  for (const auto& [name, field] : fields) {
    const std::size_t places = field.place == FieldPlace::kPoints
                                   ? piece.mesh.points.size()
                                   : (field.place == FieldPlace::kCorners ? 3 : 1) * piece.mesh.triangles.size();
    all[name] = {field.place, field.how, field.components, std::vector<double>(places * field.components)};
  }
  return all;
}

Bytes pack(SubdomainId s, const Part& part, const ValuesOnPart& values) {
  const RefinerState state = state_of(part);
  std::size_t room = kBytesBeside;
  for (const std::vector<double>& of_field : values) room += bytes_of_values(of_field.size());
  Bytes bytes = driftmesh::pack(view_of(s, part, state), room);
  ByteWriter length;
  length.number(std::uint64_t{bytes.size()});
  bytes.insert(bytes.begin(), length.bytes().begin(), length.bytes().end());
  ByteWriter writer(std::move(bytes));
  writer.value(part.density);
  writer.value(std::uint64_t{values.size()});
  for (const std::vector<double>& of_field : values) writer.array(of_field);
  return writer.take();
}

Bytes pack(const Generation& generation, SubdomainId s, const Fields& fields) {
  return pack(s, generation.parts[s], values_on(generation, s, fields));
}

std::uint64_t packed_size(const Generation& generation, SubdomainId s, const Fields& fields) {
  const Part& part = generation.parts[s];
  std::uint64_t size = kBytesBeside + driftmesh::packed_size(view_of(s, part, state_of(part)));
  for (const auto& named : fields) {
    std::size_t values = 0;
    visit_stretches(generation, s, named.second, [&](std::size_t, std::size_t count) { values += count; });
    size += bytes_of_values(values);
  }
  return size;
}

Parcel unpack_parcel(std::span<const std::byte> bytes, Source source) {
  Parcel parcel;
  ByteReader reader(bytes);
  Bytes packed;
  reader.array(packed);
  SubdomainState subdomain = driftmesh::unpack(packed, source);
  if (!subdomain.body) throw Error("a part has no mesh");
  parcel.id = subdomain.id;
  parcel.part.asked = subdomain.body->forecast;
  reader.value(parcel.part.density);
  for (auto left = reader.value<std::uint64_t>(); left > 0; --left) reader.array(parcel.values.emplace_back());
  reader.end();
  const auto& lengths = subdomain.body->refiner.size;
  if (!lengths.empty()) {
    auto made_for = std::make_shared<Lengths>();
    for (const double length : lengths) made_for->push_back(length);
    parcel.part.made_for = std::move(made_for);
  }
  parcel.part.mesh = std::make_shared<const SubdomainMesh>(std::move(subdomain.body->part));
  return parcel;
}

}  // namespace driftmesh::adapt
