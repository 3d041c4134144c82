#include "app/new_domain.hpp"

#include <algorithm>
#include <utility>

#include "gis/coordinates.hpp"
#include "job/domain.hpp"
#include "job/request.hpp"

namespace driftmesh::app {

patch::NewDomain read_new_domain(const std::string& file, double tolerance, Mesh& mesh, job::Watch& watch) {
  job::Request request;
  request.input.file = file;
  if (const auto own = coordinates_from(mesh.coordinates); own && !own->projection.empty())
    request.input.projection = own->projection;
  patch::NewDomain domain{std::move(job::read_domain(request, {}, watch).pslg), tolerance, file};
  if (tolerance == 0) {
    domain.tolerance = patch::rounding_of_midpoints(mesh.points);
    if (!mesh.coordinates.empty()) domain.tolerance = std::max(domain.tolerance, kRoundedPlaces);
  }
  patch::adopt_names(domain.pslg, mesh);
  return domain;
}

}  // namespace driftmesh::app
