// Shallow water on ranks, with a mesh that follows the wave: a dam breaks, the water runs over a wet plain and an
// island and climbs a beach. Finite volumes on triangles, explicit, first order.
//
//   mpiexec -n 4 dam_break [shortest edge] [seconds] [FILE.pvd]
//
// Of each triangle the program keeps the mean depth and discharge. Every few steps it asks for short edges where the
// water level jumps from a triangle to the next, and the fields go to the new mesh with their integrals. Fluxes are
// Harten's, Lax's and van Leer's (1983) between depths that are reconstructed over the higher bed (Audusse and others
// 2004): still water stays still, and no depth gets negative. The mesh, and all that is computed on it, are the same on
// any number of ranks. The program succeeds if no water was lost.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <driftmesh/driftmesh.hpp>
#include <driftmesh/mpi/adaptive.hpp>
#include <driftmesh/mpi/distributed.hpp>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using driftmesh::Point;

constexpr double kGravity = 9.81, kDry = 1e-4;
constexpr int kStepsPerMesh = 10;
constexpr double kSecondsPerFrame = 0.1;

/// Meters above the plain: an island and, at the far end, a beach.
double bed(const Point& p) {
  const double island = 1.2 - 0.3 * std::hypot(p.x - 25, p.y - 9);
  return std::max({0.0, island, 0.12 * (p.x - 32)});
}

driftmesh::Pslg basin() {
  driftmesh::Pslg rectangle;
  rectangle.points = {{0, 0}, {40, 0}, {40, 20}, {0, 20}};
  rectangle.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return rectangle;
}

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

struct Water {
  double depth = 0, x = 0, y = 0;  // discharge per meter along x and y
  [[nodiscard]] double level_over(double ground) const { return depth + ground; }
  /// The speed at which what happens here becomes known, at most.
  [[nodiscard]] double reach() const { return speed() + std::sqrt(kGravity * depth); }
  [[nodiscard]] double speed() const { return depth > kDry ? std::hypot(x, y) / depth : 0; }
};

/// Over an edge with unit normal (nx, ny), from a to b: of water, and of momentum as each side feels it.
struct Flux {
  double water = 0;
  std::array<Point, 2> momentum{};
};

Flux flux_between(const Water& a, double ground_a, const Water& b, double ground_b, double nx, double ny) {
  const double ground = std::max(ground_a, ground_b);
  struct Side {
    double depth, across, along, wave;
  };
  const auto side_of = [&](const Water& w, double own) {
    const double depth = std::max(0.0, w.level_over(own) - ground);
    const double share = w.depth > kDry ? 1 / w.depth : 0;
    return Side{depth, share * (w.x * nx + w.y * ny), share * (w.y * nx - w.x * ny), std::sqrt(kGravity * depth)};
  };
  const Side l = side_of(a, ground_a), r = side_of(b, ground_b);
  const double slow = std::min({l.across - l.wave, r.across - r.wave, 0.0});
  const double fast = std::max({l.across + l.wave, r.across + r.wave, 0.0});
  const auto between = [&](double flux_l, double flux_r, double value_l, double value_r) {
    return fast > slow ? (fast * flux_l - slow * flux_r + slow * fast * (value_r - value_l)) / (fast - slow) : 0;
  };
  const auto pressure = [](double depth) { return kGravity / 2 * depth * depth; };
  const double water = between(l.depth * l.across, r.depth * r.across, l.depth, r.depth);
  const double across =
      between(l.depth * l.across * l.across + pressure(l.depth), r.depth * r.across * r.across + pressure(r.depth),
              l.depth * l.across, r.depth * r.across);
  const double along = water * (water > 0 ? l.along : r.along);
  const auto felt = [&](double whole, double reconstructed) {
    const double push = across + pressure(whole) - pressure(reconstructed);
    return Point{push * nx - along * ny, push * ny + along * nx};
  };
  return {water, {felt(a.depth, l.depth), felt(b.depth, r.depth)}};
}

/// This rank's triangles and ghosts around them, with water.
class Basin {
 public:
  explicit Basin(const driftmesh::DistributedPiece& piece)
      : ghosted_(driftmesh::add_ghost_layer(MPI_COMM_WORLD, piece)), water_(mesh().triangles.size()) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::size_t, int>> open;
    beyond_.resize(mesh().triangles.size(), {kWall, kWall, kWall});
    for (std::size_t t = 0; t < mesh().triangles.size(); ++t) {
      const auto& corner = mesh().triangles[t];
      double ground = 0;
      for (int k = 0; k < 3; ++k) {
        ground += bed(mesh().points[at(corner[at(k)])]) / 3;
        const auto [a, b] = std::minmax(corner[at(k)], corner[at((k + 1) % 3)]);
        const auto [found, is_first] = open.try_emplace(std::pair(a, b), t, k);
        if (is_first) continue;
        const auto [other, side] = found->second;
        beyond_[t][at(k)] = other;
        beyond_[other][at(side)] = t;
      }
      ground_.push_back(ground);
    }
  }

  [[nodiscard]] const driftmesh::Mesh& mesh() const { return ghosted_.mesh; }
  [[nodiscard]] std::size_t own() const { return at(ghosted_.own_triangles); }
  [[nodiscard]] double ground(std::size_t t) const { return ground_[t]; }
  [[nodiscard]] Water& water(std::size_t t) { return water_[t]; }
  [[nodiscard]] const Water& water(std::size_t t) const { return water_[t]; }
  /// Seconds that this rank has computed.
  [[nodiscard]] double worked() const { return worked_; }

  [[nodiscard]] double area(std::size_t t) const {
    const auto& [a, b, c] = mesh().triangles[t];
    const Point &p = mesh().points[at(a)], &q = mesh().points[at(b)], &r = mesh().points[at(c)];
    return ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
  }

  /// One step as long as all ranks can take; returns its length.
  double step(double most) {
    swap_ghosts();
    double begin = MPI_Wtime(), length = most;
    for (std::size_t t = 0; t < own(); ++t) {
      double reach = water_[t].reach(), border = 0;
      for (int k = 0; k < 3; ++k) {
        border += edge(t, k).length;
        if (beyond_[t][at(k)] != kWall) reach = std::max(reach, water_[beyond_[t][at(k)]].reach());
      }
      if (reach > 0) length = std::min(length, 0.9 * area(t) / (border * reach));
    }
    worked_ += MPI_Wtime() - begin;
    MPI_Allreduce(MPI_IN_PLACE, &length, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
    begin = MPI_Wtime();
    std::vector<Water> next = water_;
    for (std::size_t t = 0; t < own(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const auto [water_out, momentum_out] = leaving(t, k);
        const double share = length * edge(t, k).length / area(t);
        next[t].depth -= share * water_out;
        next[t].x -= share * momentum_out.x;
        next[t].y -= share * momentum_out.y;
      }
      if (next[t].depth <= kDry) next[t].x = next[t].y = 0;
    }
    water_ = std::move(next);
    worked_ += MPI_Wtime() - begin;
    return length;
  }

  /// Gives the triangles around those of this rank the water that neighbors have there.
  void swap_ghosts() {
    std::vector<std::vector<Water>> sent, received;
    std::vector<MPI_Request> requests;
    for (const auto& neighbor : ghosted_.neighbors) {
      auto& out = sent.emplace_back();
      for (const std::int32_t t : neighbor.sent) out.push_back(water_[at(t)]);
      received.emplace_back(neighbor.received.size());
    }
    for (std::size_t n = 0; n < sent.size(); ++n) {
      const int rank = driftmesh::to_int(ghosted_.neighbors[n].rank);
      MPI_Irecv(received[n].data(), static_cast<int>(3 * received[n].size()), MPI_DOUBLE, rank, 0, MPI_COMM_WORLD,
                &requests.emplace_back());
      MPI_Isend(sent[n].data(), static_cast<int>(3 * sent[n].size()), MPI_DOUBLE, rank, 0, MPI_COMM_WORLD,
                &requests.emplace_back());
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    for (std::size_t n = 0; n < received.size(); ++n)
      for (std::size_t k = 0; k < received[n].size(); ++k)
        water_[at(ghosted_.neighbors[n].received[k])] = received[n][k];
  }

  /// Lengths at the points of this rank: short where the level jumps.
  [[nodiscard]] std::vector<double> lengths(double shortest) {
    swap_ghosts();
    std::vector<double> lengths(at(ghosted_.own_points), std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < water_.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::size_t other = beyond_[t][at(k)];
        if (other == kWall || std::max(water_[t].depth, water_[other].depth) < 10 * kDry) continue;
        const double rise = water_[t].level_over(ground_[t]) - water_[other].level_over(ground_[other]);
        const bool is_shore = std::min(water_[t].depth, water_[other].depth) < 10 * kDry;
        if (std::fabs(rise) < 0.03 && !is_shore) continue;
        for (const std::int32_t v : {mesh().triangles[t][at(k)], mesh().triangles[t][at((k + 1) % 3)]})
          if (v < ghosted_.own_points) lengths[at(v)] = shortest;
      }
    return lengths;
  }

 private:
  static constexpr std::size_t kWall = std::numeric_limits<std::size_t>::max();
  driftmesh::GhostedPiece ghosted_;                 // initialized before all that is computed from it
  std::vector<std::array<std::size_t, 3>> beyond_;  // the triangle beyond the edge from corner k to the next
  std::vector<double> ground_;
  std::vector<Water> water_;  // in this rank's triangles, then in ghosts
  double worked_ = 0;

  struct Edge {
    double length, nx, ny;  // the normal points outward
  };
  [[nodiscard]] Edge edge(std::size_t t, int k) const {
    const Point &p = mesh().points[at(mesh().triangles[t][at(k)])],
                &q = mesh().points[at(mesh().triangles[t][at((k + 1) % 3)])];
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    return {length, (q.y - p.y) / length, (p.x - q.x) / length};
  }

  /// Computed from the same one of both sides, so that what leaves one triangle is what enters the other, to the last
  /// bit.
  [[nodiscard]] std::pair<double, Point> leaving(std::size_t t, int k) const {
    const auto [length, nx, ny] = edge(t, k);
    const std::size_t other = beyond_[t][at(k)];
    if (other == kWall) {
      const double normal = water_[t].x * nx + water_[t].y * ny;
      const Water mirrored{water_[t].depth, water_[t].x - 2 * normal * nx, water_[t].y - 2 * normal * ny};
      return {0, flux_between(water_[t], ground_[t], mirrored, ground_[t], nx, ny).momentum[0]};
    }
    const auto& corner = mesh().triangles[t];
    if (mesh().numbers[at(corner[at(k)])] < mesh().numbers[at(corner[at((k + 1) % 3)])]) {
      const Flux flux = flux_between(water_[t], ground_[t], water_[other], ground_[other], nx, ny);
      return {flux.water, flux.momentum[0]};
    }
    const Flux flux = flux_between(water_[other], ground_[other], water_[t], ground_[t], -nx, -ny);
    return {-flux.water, {-flux.momentum[1].x, -flux.momentum[1].y}};
  }
};

/// A dam at x = 8 that is not there any more.
void fill(Basin& basin) {
  for (std::size_t t = 0; t < basin.own(); ++t) {
    const auto& [a, b, c] = basin.mesh().triangles[t];
    const double x = (basin.mesh().points[at(a)].x + basin.mesh().points[at(b)].x + basin.mesh().points[at(c)].x) / 3;
    basin.water(t) = {std::max(0.0, (x < 8 ? 2 : 0.4) - basin.ground(t)), 0, 0};
  }
}

/// Hands the water to the mesh: depths as linear functions, so that a level that is the same everywhere stays so on a
/// bed that is not.
void give(const Basin& basin, driftmesh::DistributedAdaptiveMesh& mesh) {
  std::vector<double> depths, discharges;
  for (std::size_t t = 0; t < basin.own(); ++t) {
    const Water& w = basin.water(t);
    std::array<double, 3> depth{};
    for (std::size_t k = 0; k < 3; ++k)
      depth[k] = w.level_over(basin.ground(t)) - bed(basin.mesh().points[at(basin.mesh().triangles[t][k])]);
    if (*std::min_element(depth.begin(), depth.end()) < 0) depth.fill(w.depth);
    depths.insert(depths.end(), depth.begin(), depth.end());
    discharges.insert(discharges.end(), {w.x, w.y});
  }
  using driftmesh::FieldPlace, driftmesh::Transfer;
  mesh.attach("depth", std::move(depths), FieldPlace::kCorners, Transfer::kConserve);
  mesh.attach("discharge", std::move(discharges), FieldPlace::kTriangles, Transfer::kConserve);
}

void take(const driftmesh::DistributedAdaptiveMesh& mesh, Basin& basin) {
  const auto depths = mesh.field("depth"), discharges = mesh.field("discharge");
  for (std::size_t t = 0; t < basin.own(); ++t)
    basin.water(t) = {(depths[3 * t] + depths[3 * t + 1] + depths[3 * t + 2]) / 3, discharges[2 * t],
                      discharges[2 * t + 1]};
}

double over_all(double value, MPI_Op how) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, how, MPI_COMM_WORLD);
  return value;
}

double volume(const Basin& basin) {
  double sum = 0;
  for (std::size_t t = 0; t < basin.own(); ++t) sum += basin.area(t) * basin.water(t).depth;
  return over_all(sum, MPI_SUM);
}

/// The highest ground that is wet on this side of x, in meters above the plain.
double shore(const Basin& basin, double from, double to) {
  double highest = 0;
  for (std::size_t t = 0; t < basin.own(); ++t) {
    const double x = basin.mesh().points[at(basin.mesh().triangles[t][0])].x;
    if (x >= from && x < to && basin.water(t).depth > 10 * kDry) highest = std::max(highest, basin.ground(t));
  }
  return over_all(highest, MPI_MAX);
}

/// Files of meshes with the water on them, some each second, and one that lists these: FILE.pvd, FILE_0.pvtu, ...
class Film {
 public:
  /// An empty path: nothing is written.
  explicit Film(const std::string& path) : stem_(path.substr(0, path.rfind(".pvd"))) {}

  /// If it is time: with the depth at points, the greatest around each, which all ranks agree on.
  void add(double time, Basin& basin, const driftmesh::DistributedAdaptiveMesh& mesh) {
    if (stem_.empty() || time < frames_ * kSecondsPerFrame) return;
    basin.swap_ghosts();
    driftmesh::DistributedPiece piece = mesh.piece();
    std::vector<double>& depths = piece.mesh.attributes;
    depths.assign(basin.mesh().points.size(), 0);
    for (std::size_t t = 0; t < basin.mesh().triangles.size(); ++t)
      for (const std::int32_t v : basin.mesh().triangles[t])
        depths[at(v)] = std::max(depths[at(v)], basin.water(t).depth);
    depths.resize(piece.mesh.points.size());  // without those of ghosts
    piece.mesh.attributes_per_point = 1;
    piece.mesh.attribute_names = {"depth"};
    const std::string path = stem_ + "_" + std::to_string(frames_++) + ".pvtu";
    driftmesh::write_distributed(MPI_COMM_WORLD, piece, path);
    list_ += "<DataSet timestep=\"" + std::to_string(time) + "\" file=\"" + path.substr(path.rfind('/') + 1) + "\"/>\n";
    if (piece.rank == driftmesh::Rank{0})
      std::ofstream(stem_ + ".pvd") << "<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
                                    << list_ << "</Collection>\n</VTKFile>\n";
  }

 private:
  std::string stem_;
  std::string list_;
  int frames_ = 0;
};

bool run(double shortest, double end, const std::string& path) {
  driftmesh::DistributedAdaptiveMesh mesh(MPI_COMM_WORLD, basin(), {.min_angle = 25, .max_area = 0.5},
                                          {.shortest = shortest, .longest = 1});
  Basin basin(mesh.piece());
  for (int k = 0; k < 6; ++k) {  // until the mesh knows where the dam was
    fill(basin);
    mesh.adapt(basin.lengths(shortest));
    basin = Basin(mesh.piece());
  }
  fill(basin);
  const double filled = volume(basin);
  double time = 0, triangles = 0, island = 0, beach = 0, moved = 0;
  int meshes = 0, steps = 0;
  Film film(path);
  for (; time < end; ++meshes) {
    film.add(time, basin, mesh);
    for (int k = 0; k < kStepsPerMesh && time < end; ++k, ++steps) time += basin.step(end - time);
    island = std::max(island, shore(basin, 20, 30));
    beach = std::max(beach, shore(basin, 32, 40));
    triangles += static_cast<double>(mesh.piece().total_triangles);
    give(basin, mesh);
    const std::vector<double> lengths = basin.lengths(shortest);
    mesh.spent(basin.worked());
    mesh.adapt(lengths);
    moved += mesh.report().moved;
    basin = Basin(mesh.piece());
    take(mesh, basin);
  }
  film.add(time, basin, mesh);
  const double lost = std::fabs(volume(basin) / filled - 1);
  if (mesh.piece().rank == driftmesh::Rank{0}) {
    std::printf("%d steps on %d meshes of %.0f triangles, %.0f moves of subdomains between %d ranks\n", steps, meshes,
                triangles / meshes, moved, mesh.piece().ranks);
    std::printf("the water climbs %.17g m of the island and %.17g m of the beach; %.1e of it is lost\n", island, beach,
                lost);
  }
  return lost < 1e-12;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const bool is_kept =
      run(argc > 1 ? std::atof(argv[1]) : 0.1, argc > 2 ? std::atof(argv[2]) : 8, argc > 3 ? argv[3] : "");
  MPI_Finalize();
  return is_kept ? EXIT_SUCCESS : EXIT_FAILURE;
}
