/* A square with a hole, meshed by the call of Triangle's C library, and refined where it is near the hole. */
#include <driftmesh/triangle.h>
#include <math.h>
#include <stdio.h>

static int too_large(REAL* a, REAL* b, REAL* c, REAL area) {
  const REAL x = (a[0] + b[0] + c[0]) / 3 - 0.5, y = (a[1] + b[1] + c[1]) / 3 - 0.5;
  return area > 0.001 + 0.02 * (x * x + y * y);
}

static void free_lists(struct triangulateio* mesh) {
  trifree(mesh->pointlist);
  trifree(mesh->pointmarkerlist);
  trifree(mesh->trianglelist);
  trifree(mesh->segmentlist);
  trifree(mesh->segmentmarkerlist);
}

int main(void) {
  REAL points[] = {0, 0, 1, 0, 1, 1, 0, 1, 0.4, 0.4, 0.6, 0.4, 0.6, 0.6, 0.4, 0.6};
  int segments[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
  int markers[] = {1, 1, 1, 1, 2, 2, 2, 2};
  REAL hole[] = {0.5, 0.5};
  struct triangulateio in = {0}, coarse = {0}, fine = {0}, none = {0};
  REAL sum = 0;
  int t;

  in.pointlist = points;
  in.numberofpoints = 8;
  in.segmentlist = segments;
  in.segmentmarkerlist = markers;
  in.numberofsegments = 8;
  in.holelist = hole;
  in.numberofholes = 1;
  triangulate("pzQq30a0.05", &in, &coarse, NULL);
  printf("%d points, %d triangles\n", coarse.numberofpoints, coarse.numberoftriangles);

  driftmesh_set_triunsuitable(too_large);
  triangulate("przQq30u", &coarse, &fine, NULL);
  printf("%d points, %d triangles\n", fine.numberofpoints, fine.numberoftriangles);
  for (t = 0; t < fine.numberoftriangles; ++t) {
    REAL *a = fine.pointlist + 2 * fine.trianglelist[3 * t], *b = fine.pointlist + 2 * fine.trianglelist[3 * t + 1];
    REAL* c = fine.pointlist + 2 * fine.trianglelist[3 * t + 2];
    const REAL area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    if (area <= 0 || too_large(a, b, c, area)) return 2;
    sum += area;
  }
  printf("area %.6f\n", sum);

  if (driftmesh_triangulate("pk", &in, &none, NULL) == 0) return 3;
  printf("%s\n", driftmesh_triangle_error());

  free_lists(&coarse);
  free_lists(&fine);
  return fabs(sum - 0.96) > 1e-12 || fine.numberoftriangles <= coarse.numberoftriangles;
}
