#include "driftmesh/adapt_part.hpp"

#include <algorithm>
#include <utility>

#include "api/library_request.hpp"
#include "base/cores.hpp"
#include "base/formatted.hpp"
#include "base/key_error.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/bounds.hpp"
#include "patch/point_data.hpp"
#include "patch/remake.hpp"

namespace driftmesh {
namespace {

void require_in_range(const PartOptions& options) {
  const auto require = [](bool sound, const char* key, double value, const KeyText& rule) {
    if (!sound) throw Keyed<Error>(KeyText::of("{} is {}; it must be {}", KeyText::key(key), value, rule));
  };
  const AdaptiveOptions& sizes = options.sizes;
  require(sizes.shortest >= 0, "part.sizes.shortest", sizes.shortest, "at least 0");
  require(sizes.longest > 0 && sizes.longest >= sizes.shortest, "part.sizes.longest", sizes.longest,
          KeyText::of("positive, and not below {part.sizes.shortest}, which is {}", sizes.shortest));
  require(sizes.gradation >= 0, "part.sizes.gradation", sizes.gradation, "at least 0");
  require(sizes.most_triangles >= 0, "part.sizes.most_triangles", sizes.most_triangles, "at least 0");
  require(options.min_angle >= 0 && options.min_angle <= kMaxAngle, "part.min_angle", options.min_angle,
          formatted("from 0 to {} degrees", kMaxAngle));
  require(options.threads >= 0, "part.threads", options.threads, "at least 0");
  require(options.tolerance >= 0, "part.tolerance", options.tolerance, "at least 0");
}

std::vector<adapt::Field> fields_of(Mesh& mesh, const std::vector<std::string>& conserve, bool in_another_domain) {
  std::vector<patch::NamedField> named = patch::take_point_data(mesh);
  for (const std::string& name : conserve) {
    const auto found = std::ranges::find(named, name, &patch::NamedField::name);
    if (found == named.end())
      throw Keyed<Error>(KeyText::of("the mesh has no point data '{}', which {part.conserve} names", name));
    patch::conserve(*found, in_another_domain);
  }
  std::vector<adapt::Field> fields;
  for (patch::NamedField& field : named) fields.push_back(std::move(field.field));
  return fields;
}

AdaptedMesh adapted(Mesh mesh, patch::Order order, const PartOptions& options) {
  order.lengths = options.lengths;
  order.options = options.sizes;
  order.min_angle = options.min_angle;
  order.threads = threads_or_cores(options.threads);
  std::vector<adapt::Field> fields =
      in_words_of_library([&] { return fields_of(mesh, options.conserve, order.domain != nullptr); });
  patch::Remade remade = patch::remake(std::move(mesh), std::move(fields), std::move(order));
  patch::give_point_data(remade.mesh, remade.fields);
  return {.mesh = std::move(remade.mesh),
          .old_points = std::move(remade.old_points),
          .old_triangles = std::move(remade.old_triangles),
          .margin = remade.report.margin,
          .margin_width = remade.report.margin_width,
          .beyond = remade.report.beyond};
}

}  // namespace

AdaptedMesh adapt_part(Mesh mesh, std::span<const std::int32_t> triangles, const PartOptions& options) {
  in_words_of_library([&] { require_in_range(options); });
  patch::Order order{.inside = std::vector<bool>(mesh.triangles.size(), false)};
  for (const std::int32_t t : triangles) {
    if (t < 0 || std::cmp_greater_equal(t, mesh.triangles.size()))
      throw Error("there is no triangle " + std::to_string(t) + "; the mesh has " +
                  std::to_string(mesh.triangles.size()) + ", counted from 0");
    order.inside[static_cast<std::size_t>(t)] = true;
  }
  return adapted(std::move(mesh), std::move(order), options);
}

AdaptedMesh adapt_outline(Mesh mesh, const Pslg& domain, const PartOptions& options) {
  in_words_of_library([&] { require_in_range(options); });
  patch::NewDomain now{domain, options.tolerance, "domain"};
  repair(now.pslg, now.name);
  if (now.tolerance == 0) now.tolerance = patch::rounding_of_midpoints(mesh.points);
  patch::adopt_names(now.pslg, mesh);
  patch::Order order;
  order.domain = &now;
  return adapted(std::move(mesh), std::move(order), options);
}

}  // namespace driftmesh
