#include "mutants/declared_tables.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "mutants/declared_mesh.hpp"
#include "mutants/table_rows.hpp"

namespace driftmesh::mutants {
namespace {

constexpr std::int32_t kSeparator = -1'000'000;

struct Nodes {
  Mesh mesh;  // points only
  std::int64_t first = 1;

  std::int32_t vertex(Row& row) const {
    const std::int64_t index = row.integer() - first;
    if (index < 0 || index >= static_cast<std::int64_t>(mesh.points.size())) throw Undeclared("no such vertex");
    return static_cast<std::int32_t>(index);
  }
};

Nodes nodes_of(Table& table) {
  Row header = table.row();
  Nodes nodes;
  const std::size_t count = header.count();
  if (header.has_more() && header.integer() != 2) throw Undeclared("not of two dimensions");
  const std::int64_t attributes = header.has_more() ? header.integer(0) : 0;
  const bool has_markers = header.flag();
  header.end();
  nodes.mesh.attributes_per_point = static_cast<std::int32_t>(attributes);
  RowNumbers numbers;
  table.rows(count, [&](Row& row, std::int64_t i) {
    numbers.take(row, i);
    nodes.mesh.points.push_back(row.point());
    for (std::int64_t k = 0; k < attributes; ++k) nodes.mesh.attributes.push_back(row.real());
    if (has_markers) nodes.mesh.point_markers.push_back(row.int32());
  });
  nodes.first = numbers.first();
  return nodes;
}

const std::string& file(const Files& files, const std::string& name) {
  const auto found = files.find(name);
  if (found == files.end()) throw Undeclared("there is no " + name);
  return found->second;
}

Nodes node_file(const Files& files, const std::string& name) {
  Table table(file(files, name));
  Nodes nodes = nodes_of(table);
  table.end();
  return nodes;
}

/// Segments and edges. Those of a mesh are numbered in order.
std::vector<Mesh::Edge> edges_of(Table& table, const Nodes& nodes, bool of_mesh) {
  Row header = table.row();
  const std::size_t count = header.count();
  const bool has_markers = header.flag();
  header.end();
  std::vector<Mesh::Edge> edges;
  RowNumbers numbers;
  table.rows(count, [&](Row& row, std::int64_t i) {
    if (of_mesh)
      numbers.take(row, i);
    else
      (void)row.integer();
    Mesh::Edge edge;
    edge.a = nodes.vertex(row);
    edge.b = nodes.vertex(row);
    if (has_markers) edge.marker = row.int32();
    edges.push_back(edge);
  });
  return edges;
}

void holes_and_regions_of(Table& table, Pslg& pslg) {
  Row holes = table.row();
  const std::size_t count = holes.count();
  holes.end();
  table.rows(count, [&](Row& row, std::int64_t) {
    (void)row.integer();
    pslg.holes.push_back(row.point());
  });
  if (table.has_more()) {
    Row regions = table.row();
    const std::size_t region_count = regions.count();
    regions.end();
    table.rows(region_count, [&](Row& row, std::int64_t) {
      (void)row.integer();
      Pslg::Region region;
      region.at = row.point();
      region.attribute = row.real();
      region.max_area = row.has_more() ? row.real() : region.attribute;
      pslg.regions.push_back(region);
    });
  }
  table.end();
}

Pslg domain_of(Nodes&& nodes) {
  Pslg pslg;
  if (nodes.mesh.points.empty()) throw Undeclared("no vertices");
  pslg.points = std::move(nodes.mesh.points);
  pslg.point_markers = std::move(nodes.mesh.point_markers);
  pslg.attributes = std::move(nodes.mesh.attributes);
  pslg.attributes_per_point = nodes.mesh.attributes_per_point;
  pslg.first_number = static_cast<std::int32_t>(nodes.first);
  return pslg;
}

void take_triangles(const Files& files, const std::string& name, const Nodes& nodes, Mesh& mesh) {
  Table table(file(files, name));
  Row header = table.row();
  const std::size_t count = header.count();
  const std::int64_t corners = header.has_more() ? header.integer() : 3;
  if (corners != 3 && corners != 6) throw Undeclared("triangles of neither 3 nor 6 points");
  const std::int64_t attributes = header.has_more() ? header.integer(0) : 0;
  header.end();
  RowNumbers numbers;
  table.rows(count, [&](Row& row, std::int64_t i) {
    numbers.take(row, i);
    auto& triangle = mesh.triangles.emplace_back();
    for (std::int32_t& corner : triangle) corner = nodes.vertex(row);
    for (std::int64_t k = 3; k < corners; ++k) (void)row.integer();
    double attribute = 0;
    for (std::int64_t k = 0; k < attributes; ++k) attribute = row.real();
    if (attributes > 0) mesh.regions.push_back(attribute);
  });
  table.end();
}

/// The edges of a mesh: from a .poly without vertices, or else from the .edge.
std::vector<Mesh::Edge> constrained_edges(const Files& files, const std::string& stem, const Nodes& nodes) {
  if (files.contains(stem + "poly")) {
    Table table(file(files, stem + "poly"));
    if (nodes_of(table).mesh.points.empty()) {
      std::vector<Mesh::Edge> edges = edges_of(table, nodes, true);
      Pslg seeds;
      holes_and_regions_of(table, seeds);
      return edges;
    }
  }
  if (!files.contains(stem + "edge")) return {};
  Table table(file(files, stem + "edge"));
  std::vector<Mesh::Edge> edges = edges_of(table, nodes, true);
  table.end();
  std::erase_if(edges, [](const Mesh::Edge& edge) { return edge.marker == 0; });
  return edges;
}

std::vector<std::size_t> neighbors(const std::vector<std::size_t>& around_edge, std::size_t triangle) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < around_edge.size(); ++i)
    if (around_edge[i] == triangle && (i ^ 1U) < around_edge.size()) result.push_back(around_edge[i ^ 1U]);
  return result;
}

/// The number of the part of each triangle when edges cut the mesh: parts are numbered by their first triangles. Where
/// more than two triangles have an edge, the first and the second one are neighbors, the third and the fourth one...
std::vector<std::int32_t> parts_of(const Mesh& mesh) {
  std::set<std::pair<std::int32_t, std::int32_t>> cuts;
  for (const Mesh::Edge& edge : mesh.edges) cuts.insert(std::minmax({edge.a, edge.b}));
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> around;
  const auto edge_of = [&](std::size_t t, std::size_t i) {
    const auto& corners = mesh.triangles[t];
    return std::pair<std::int32_t, std::int32_t>(std::minmax({corners[i], corners[(i + 1) % 3]}));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (!cuts.contains(edge_of(t, i))) around[edge_of(t, i)].push_back(t);
  std::vector<std::int32_t> part(mesh.triangles.size(), -1);
  std::int32_t parts = 0;
  for (std::size_t first = 0; first < part.size(); ++first) {
    if (part[first] >= 0) continue;
    std::vector<std::size_t> open{first};
    part[first] = parts++;
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      for (std::size_t i = 0; i < 3; ++i)
        for (const std::size_t other : neighbors(around[edge_of(t, i)], t))
          if (part[other] < 0) part[other] = part[first], open.push_back(other);
    }
  }
  return part;
}

/// A reference into `count` things, or -1 where there may be none.
template <class Id>
Id reference(Row& row, std::size_t count, std::int64_t least) {
  return Id{static_cast<std::int32_t>(row.integer(least, static_cast<std::int64_t>(count) - 1))};
}

Decomposition::Root root_of(Row& row, std::size_t points, std::size_t subdomains) {
  Decomposition::Root root;
  root.a = reference<GlobalPointId>(row, points, 0);
  root.b = reference<GlobalPointId>(row, points, 0);
  root.marker = row.int32();
  root.shell = static_cast<std::int32_t>(row.integer(-1));
  root.left = reference<SubdomainId>(row, subdomains, -1);
  root.right = reference<SubdomainId>(row, subdomains, -1);
  root.left_region = static_cast<std::uint16_t>(row.integer(0, 65535));
  root.right_region = static_cast<std::uint16_t>(row.integer(0, 65535));
  root.separator = row.integer(0, 1) == 1;
  return root;
}

Decomposition::Subdomain subdomain_of(Row& row) {
  Decomposition::Subdomain subdomain;
  subdomain.area = row.real();
  subdomain.predicted = row.real();
  subdomain.centroid.x = row.real();
  subdomain.centroid.y = row.real();
  subdomain.region = static_cast<std::uint16_t>(row.integer(0, 65535));
  return subdomain;
}

}  // namespace

Pslg declared_domain(const Files& files, const std::string& name) {
  if (name.ends_with(".node")) return domain_of(node_file(files, name));
  Table table(file(files, name));
  Nodes nodes = nodes_of(table);
  const bool is_of_mesh = nodes.mesh.points.empty();
  if (is_of_mesh) nodes = node_file(files, name.substr(0, name.rfind('.') + 1) + "node");
  std::vector<Mesh::Edge> edges = edges_of(table, nodes, false);
  if (is_of_mesh) std::erase_if(edges, [](const Mesh::Edge& edge) { return edge.marker == kSeparator; });
  Pslg pslg = domain_of(std::move(nodes));
  for (const Mesh::Edge& edge : edges) pslg.segments.push_back({edge.a, edge.b, edge.marker});
  holes_and_regions_of(table, pslg);
  return pslg;
}

Mesh declared_triangle_mesh(const Files& files, const std::string& stem) {
  const Nodes nodes = node_file(files, stem + "node");
  Mesh mesh = nodes.mesh;
  take_triangles(files, stem + "ele", nodes, mesh);
  mesh.edges = constrained_edges(files, stem, nodes);
  turn_if_seen_from_below(mesh);
  const auto is_separator = [](const Mesh::Edge& edge) { return edge.marker == kSeparator; };
  if (std::ranges::any_of(mesh.edges, is_separator)) mesh.subdomains = parts_of(mesh);
  std::erase_if(mesh.edges, is_separator);
  return mesh;
}

DeclaredBackground declared_background(const Files& files, const std::string& stem, bool with_areas) {
  const Nodes nodes = node_file(files, stem + "node");
  DeclaredBackground background;
  background.mesh.points = nodes.mesh.points;
  take_triangles(files, stem + "ele", nodes, background.mesh);
  if (with_areas) {
    Table table(file(files, stem + "area"));
    Row header = table.row();
    if (header.count() != background.mesh.triangles.size()) throw Undeclared("areas of other triangles");
    header.end();
    RowNumbers numbers;
    table.rows(background.mesh.triangles.size(), [&](Row& row, std::int64_t i) {
      numbers.take(row, i);
      background.areas.push_back(row.real());
    });
    table.end();
  } else {
    const auto stride = static_cast<std::size_t>(nodes.mesh.attributes_per_point);
    if (stride == 0) throw Undeclared("points without a length");
    for (std::size_t i = 0; i < nodes.mesh.attributes.size(); i += stride) {
      background.lengths.push_back(nodes.mesh.attributes[i]);
      if (!(background.lengths.back() > 0)) throw Undeclared("a length that is not positive");
    }
  }
  return background;
}

Decomposition declared_decomposition(std::string_view text) {
  if (!text.starts_with("# driftmesh decomposition 2\n")) throw Undeclared("another first line");
  Table table(text);
  Row header = table.row();
  const std::size_t points = header.count(), roots = header.count(), subdomains = header.count();
  const std::size_t inner_points = header.count();
  (void)header.integer();
  header.end();
  Decomposition d;
  table.rows(points, [&](Row& row, std::int64_t) {
    const double x = row.real();
    d.points.push_back({x, row.real()});
    d.origin.push_back(static_cast<std::int32_t>(row.integer(-1)));
  });
  table.rows(roots, [&](Row& row, std::int64_t) { d.roots.push_back(root_of(row, points, subdomains)); });
  table.rows(subdomains, [&](Row& row, std::int64_t) { d.subdomains.push_back(subdomain_of(row)); });
  d.point_begin.assign(subdomains + 1, 0);
  table.rows(inner_points, [&](Row& row, std::int64_t) {
    const auto subdomain = row.integer(0, static_cast<std::int64_t>(subdomains) - 1);
    for (auto i = static_cast<std::size_t>(subdomain) + 1; i <= subdomains; ++i) ++d.point_begin[i];
    d.point_list.push_back(reference<GlobalPointId>(row, points, 0));
  });
  table.end();
  return d;
}

}  // namespace driftmesh::mutants
