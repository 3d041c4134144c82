/* What the header of the library for C promises: numbers from 1 and 0, lists of the caller, markers, attributes, areas,
 * the Voronoi diagram, and errors that leave outputs as they were. In C90, like the programs that call Triangle. */
#include <driftmesh/triangle.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                      \
  do {                                                        \
    if (!(condition)) {                                       \
      fprintf(stderr, "line %d: %s\n", __LINE__, #condition); \
      exit(1);                                                \
    }                                                         \
  } while (0)

static REAL points[] = {0, 0, 2, 0, 2, 1, 0, 1};
static REAL values[] = {0, 2, 3, 1};
static int point_markers[] = {7, 0, 0, 0};
static int segments[] = {1, 2, 2, 3, 3, 4, 4, 1};
static int segment_markers[] = {5, 0, 6, 0};
static REAL regions[] = {1, 0.5, 42, 0.05};

static struct triangulateio rectangle(void) {
  struct triangulateio in;
  memset(&in, 0, sizeof in);
  in.pointlist = points;
  in.pointattributelist = values;
  in.pointmarkerlist = point_markers;
  in.numberofpoints = 4;
  in.numberofpointattributes = 1;
  in.segmentlist = segments;
  in.segmentmarkerlist = segment_markers;
  in.numberofsegments = 4;
  in.regionlist = regions;
  in.numberofregions = 1;
  return in;
}

static REAL area_of(const struct triangulateio* mesh, int t, int first) {
  const int* v = mesh->trianglelist + mesh->numberofcorners * t;
  const REAL *a = mesh->pointlist + 2 * (v[0] - first), *b = mesh->pointlist + 2 * (v[1] - first);
  const REAL* c = mesh->pointlist + 2 * (v[2] - first);
  return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

static void free_lists(struct triangulateio* mesh) {
  trifree(mesh->pointlist);
  trifree(mesh->pointattributelist);
  trifree(mesh->pointmarkerlist);
  trifree(mesh->trianglelist);
  trifree(mesh->triangleattributelist);
  trifree(mesh->neighborlist);
  trifree(mesh->segmentlist);
  trifree(mesh->segmentmarkerlist);
  trifree(mesh->edgelist);
  trifree(mesh->edgemarkerlist);
  trifree(mesh->normlist);
  memset(mesh, 0, sizeof *mesh);
}

static void test_all_lists(void) {
  struct triangulateio in = rectangle(), out, vor;
  char switches[] = "pq30aAenvQ";
  int i, rays = 0, boundary = 0;
  REAL sum = 0;
  memset(&out, 0, sizeof out);
  memset(&vor, 0, sizeof vor);
  triangulate(switches, &in, &out, &vor);
  CHECK(out.numberofcorners == 3 && out.numberoftriangleattributes == 1 && out.numberofpointattributes == 1);
  CHECK(memcmp(out.pointlist, points, sizeof points) == 0);
  for (i = 0; i < out.numberofpoints; ++i) {
    const REAL wanted = out.pointlist[2 * i] + out.pointlist[2 * i + 1] - out.pointattributelist[i];
    CHECK(wanted < 1e-12 && wanted > -1e-12);
  }
  for (i = 0; i < out.numberoftriangles; ++i) {
    CHECK(area_of(&out, i, 1) > 0 && area_of(&out, i, 1) <= 0.05 && out.triangleattributelist[i] == 42);
    sum += area_of(&out, i, 1);
  }
  CHECK(sum > 2 - 1e-12 && sum < 2 + 1e-12);
  CHECK(out.pointmarkerlist[0] == 7 && out.pointmarkerlist[1] == 5 && out.pointmarkerlist[3] == 6);
  for (i = 0; i < 3 * out.numberoftriangles; ++i) {
    CHECK(out.neighborlist[i] == -1 || (out.neighborlist[i] >= 1 && out.neighborlist[i] <= out.numberoftriangles));
    boundary += out.neighborlist[i] == -1;
  }
  CHECK(boundary == out.numberofsegments);
  CHECK(out.numberofedges == out.numberofpoints + out.numberoftriangles - 1);
  CHECK(out.regionlist == regions && out.numberofregions == 1 && out.numberofholes == 0);
  CHECK(vor.numberofpoints == out.numberoftriangles && vor.numberofedges == out.numberofedges);
  for (i = 0; i < vor.numberofedges; ++i) {
    const int is_ray = vor.edgelist[2 * i + 1] == -1;
    CHECK(is_ray == (vor.normlist[2 * i] != 0 || vor.normlist[2 * i + 1] != 0));
    rays += is_ray;
  }
  CHECK(rays == boundary);
  free_lists(&out);
  free_lists(&vor);
}

static void test_numbers_from_zero(void) {
  struct triangulateio in = rectangle(), out;
  int from_zero[] = {0, 1, 1, 2, 2, 3, 3, 0}, i;
  memset(&out, 0, sizeof out);
  in.segmentlist = from_zero;
  CHECK(driftmesh_triangulate("pznQ", &in, &out, NULL) == 0);
  CHECK(out.numberoftriangles == 2 && out.numberofpoints == 4 && out.numberofsegments == 4);
  for (i = 0; i < 6; ++i) CHECK(out.trianglelist[i] >= 0 && out.trianglelist[i] < 4 && out.neighborlist[i] < 2);
  free_lists(&out);
}

static void test_lists_of_the_caller(void) {
  struct triangulateio in = rectangle(), out;
  REAL own_points[8];
  int own_markers[4], own_triangles[6];
  memset(&out, 0, sizeof out);
  out.pointlist = own_points;
  out.pointmarkerlist = own_markers;
  out.trianglelist = own_triangles;
  in.pointattributelist = NULL;
  CHECK(driftmesh_triangulate("pPQ", &in, &out, NULL) == 0);
  CHECK(out.pointlist == own_points && out.trianglelist == own_triangles && out.segmentlist == NULL);
  CHECK(own_points[4] == 2 && own_markers[0] == 7 && own_triangles[0] >= 1 && own_triangles[0] <= 4);
}

static void test_refinement(void) {
  struct triangulateio in = rectangle(), coarse, fine;
  REAL areas[] = {-1, 0.01};
  int i;
  memset(&coarse, 0, sizeof coarse);
  memset(&fine, 0, sizeof fine);
  CHECK(driftmesh_triangulate("pAQ", &in, &coarse, NULL) == 0);
  coarse.trianglearealist = areas;
  coarse.triangleattributelist[0] = 10;
  CHECK(driftmesh_triangulate("prqaQ", &coarse, &fine, NULL) == 0);
  CHECK(memcmp(fine.pointlist, points, sizeof points) == 0);
  for (i = 0; i < fine.numberoftriangles; ++i)
    CHECK(fine.triangleattributelist[i] == 10 || (fine.triangleattributelist[i] == 42 && area_of(&fine, i, 1) <= 0.01));
  free_lists(&coarse);
  free_lists(&fine);
}

static void test_errors(void) {
  struct triangulateio in = rectangle(), out;
  memset(&out, 0, sizeof out);
  CHECK(driftmesh_triangulate("pq70", &in, &out, NULL) != 0);
  CHECK(strstr(driftmesh_triangle_error(), "switch q") != NULL);
  CHECK(driftmesh_triangulate("pv", &in, &out, NULL) != 0 && strstr(driftmesh_triangle_error(), "vorout") != NULL);
  CHECK(driftmesh_triangulate("pu", &in, &out, NULL) != 0 && strstr(driftmesh_triangle_error(), "switch u") != NULL);
  in.numberofpoints = 2;
  CHECK(driftmesh_triangulate("p", &in, &out, NULL) != 0 && driftmesh_triangle_error()[0] != 0);
  CHECK(out.pointlist == NULL && out.trianglelist == NULL && out.numberofpoints == 0);
  in.numberofpoints = 4;
  CHECK(driftmesh_triangulate("pNEPQ", &in, &out, NULL) == 0 && driftmesh_triangle_error()[0] == 0);
  CHECK(out.pointlist == NULL && out.numberofpoints == 4 && out.numberoftriangles == 2);
}

int main(void) {
  test_all_lists();
  test_numbers_from_zero();
  test_lists_of_the_caller();
  test_refinement();
  test_errors();
  return 0;
}
