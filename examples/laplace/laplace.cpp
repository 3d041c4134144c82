// A solver that makes its own distributed mesh: the Laplace equation on a rectangle with a round hole, linear elements,
// conjugate gradients. Every rank works on its piece of the mesh; values at shared vertices are summed over the pieces.
//
//   mpiexec -n 4 laplace [largest triangle area]
//
// On the boundary the solution is exp(x) cos(y), which is harmonic, so it is known everywhere. The program meshes
// twice, the second time with a quarter of the area, and succeeds if the error decreases as theory predicts: with the
// square of the edge length, so to about a quarter.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <driftmesh/driftmesh.hpp>
#include <driftmesh/mpi/distributed.hpp>
#include <vector>

namespace {

using driftmesh::DistributedPiece;
using driftmesh::Point;
using Values = std::vector<double>;  // one for each vertex of the piece

double exact(const Point& p) {
  return std::exp(p.x) * std::cos(p.y);
}

/// Communication with neighbors: sums over all pieces that have a vertex, and over all vertices.
class Shared {
 public:
  explicit Shared(const DistributedPiece& piece) : piece_(piece) {
    for (const auto& neighbor : piece.neighbors) {
      sent_.emplace_back(neighbor.shared.size());
      received_.emplace_back(neighbor.shared.size());
    }
  }

  /// Adds to each shared value those of the other ranks. Both sides list shared vertices in the same order.
  void add_up(Values& values) {
    std::vector<MPI_Request> requests;
    for (std::size_t n = 0; n < sent_.size(); ++n) {
      const auto& [rank, shared] = piece_.neighbors[n];
      const auto count = static_cast<int>(shared.size());
      std::transform(shared.begin(), shared.end(), sent_[n].begin(), [&](std::int32_t v) { return values[at(v)]; });
      MPI_Irecv(received_[n].data(), count, MPI_DOUBLE, driftmesh::to_int(rank), 0, MPI_COMM_WORLD,
                &requests.emplace_back());
      MPI_Isend(sent_[n].data(), count, MPI_DOUBLE, driftmesh::to_int(rank), 0, MPI_COMM_WORLD,
                &requests.emplace_back());
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    for (std::size_t n = 0; n < received_.size(); ++n)
      for (std::size_t k = 0; k < received_[n].size(); ++k)
        values[at(piece_.neighbors[n].shared[k])] += received_[n][k];
  }

  /// Each vertex counts once, at its owner.
  [[nodiscard]] double dot(const Values& a, const Values& b) const {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v)
      if (piece_.owners[v] == piece_.rank) sum += a[v] * b[v];
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
  }

  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

 private:
  const DistributedPiece& piece_;
  std::vector<Values> sent_, received_;
};

/// The stiffness matrix of the piece, element by element; rows and columns of the boundary are left out.
class Laplacian {
 public:
  Laplacian(const DistributedPiece& piece, Shared& shared) : piece_(piece), shared_(shared) {
    for (const auto& triangle : piece.mesh.triangles) elements_.push_back(element(triangle));
  }

  [[nodiscard]] bool is_boundary(std::size_t v) const { return piece_.mesh.point_markers[v] != 0; }

  /// y = A x, for x on all vertices; y is 0 on the boundary.
  void apply(const Values& x, Values& y) {
    std::fill(y.begin(), y.end(), 0.0);
    for (std::size_t t = 0; t < elements_.size(); ++t) {
      const auto& corner = piece_.mesh.triangles[t];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) y[Shared::at(corner[i])] += elements_[t][i][j] * x[Shared::at(corner[j])];
    }
    shared_.add_up(y);
    for (std::size_t v = 0; v < y.size(); ++v)
      if (is_boundary(v)) y[v] = 0;
  }

 private:
  using Element = std::array<std::array<double, 3>, 3>;

  /// The gradients of the hat functions are the opposite edges, rotated by 90 degrees, divided by twice the area.
  [[nodiscard]] Element element(const std::array<std::int32_t, 3>& triangle) const {
    std::array<Point, 3> edge;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& a = piece_.mesh.points[Shared::at(triangle[(i + 1) % 3])];
      const Point& b = piece_.mesh.points[Shared::at(triangle[(i + 2) % 3])];
      edge[i] = {b.x - a.x, b.y - a.y};
    }
    const double twice_area = edge[0].x * edge[1].y - edge[0].y * edge[1].x;
    Element result;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        result[i][j] = (edge[i].x * edge[j].x + edge[i].y * edge[j].y) / (2 * twice_area);
    return result;
  }

  const DistributedPiece& piece_;
  Shared& shared_;
  std::vector<Element> elements_;
};

/// Conjugate gradients starting from x, whose boundary values do not change. Returns the number of steps.
int solve(Laplacian& a, const Shared& shared, Values& x) {
  Values residual(x.size()), product(x.size());
  a.apply(x, residual);
  for (double& r : residual) r = -r;
  Values direction = residual;
  double square = shared.dot(residual, residual);
  const double enough = 1e-20 * square;
  int steps = 0;
  for (; square > enough && steps < 10000; ++steps) {
    a.apply(direction, product);
    const double alpha = square / shared.dot(direction, product);
    for (std::size_t v = 0; v < x.size(); ++v) {
      x[v] += alpha * direction[v];
      residual[v] -= alpha * product[v];
    }
    const double next = shared.dot(residual, residual);
    for (std::size_t v = 0; v < x.size(); ++v) direction[v] = residual[v] + next / square * direction[v];
    square = next;
  }
  return steps;
}

/// Meshes with this bound on the area, solves, and returns the root mean square of the error at the vertices.
double error_with(double max_area) {
  const DistributedPiece piece = driftmesh::mesh_distributed(MPI_COMM_WORLD, driftmesh::generate_rectangle_hole({}),
                                                             {.min_angle = 25, .max_area = max_area});

  Shared shared(piece);
  Laplacian laplacian(piece, shared);
  Values x(piece.mesh.points.size());
  for (std::size_t v = 0; v < x.size(); ++v) x[v] = laplacian.is_boundary(v) ? exact(piece.mesh.points[v]) : 0;
  const int steps = solve(laplacian, shared, x);

  Values error(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) error[v] = x[v] - exact(piece.mesh.points[v]);
  const double mean = std::sqrt(shared.dot(error, error) / static_cast<double>(piece.total_points));
  if (piece.rank == driftmesh::Rank{0})
    std::printf("%lld triangles, %lld vertices on %d ranks: %d steps, error %.3g\n",
                static_cast<long long>(piece.total_triangles), static_cast<long long>(piece.total_points), piece.ranks,
                steps, mean);
  return mean;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const double max_area = argc > 1 ? std::atof(argv[1]) : 4e-4;
  const double coarse = error_with(max_area), fine = error_with(max_area / 4);
  const bool converges = fine < 0.35 * coarse && fine > 0.15 * coarse;
  MPI_Finalize();
  if (!converges)
    std::fprintf(stderr, "the error decreased to %.2f of the first one; a quarter is expected\n", fine / coarse);
  return converges ? EXIT_SUCCESS : EXIT_FAILURE;
}
