/* The call of Triangle's C library, made by driftmesh. A program that includes "triangle.h" and calls triangulate()
 * compiles with this header in its place, and links libdriftmesh_triangle:
 *
 *     #include <driftmesh/triangle.h>
 *
 *     struct triangulateio in = {0}, out = {0};
 *     in.pointlist = points;
 *     in.numberofpoints = 4;
 *     triangulate("zQ", &in, &out, NULL);
 *     trifree(out.trianglelist);
 *
 * Members, order and sizes of the structure do not change within version 1 of the library. For C and C++.
 */
#ifndef DRIFTMESH_TRIANGLE_H
#define DRIFTMESH_TRIANGLE_H

#ifdef SINGLE
#error "driftmesh computes in double precision; remove SINGLE"
#endif
#ifndef REAL
#define REAL double
#endif
#ifndef VOID
#define VOID void
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An input, a mesh, or a Voronoi diagram. All lists are flat: x and y of the first point, x and y of the second, ...
 * Numbers in lists count from 1, or from 0 with the switch z. Set what is not used to NULL or 0.
 *
 * An output list that is NULL on entry is allocated, and is the caller's to free by trifree(); any other is written to,
 * and must have room. holelist and regionlist of an output are the pointers of the input. */
/* NOLINTNEXTLINE(readability-identifier-naming): as programs call it */
struct triangulateio {
  REAL* pointlist;          /* in, out: x, y */
  REAL* pointattributelist; /* in, out: numberofpointattributes for each point */
  int* pointmarkerlist;     /* in, out: one for each point */
  int numberofpoints;
  int numberofpointattributes;

  int* trianglelist;           /* in (r), out: numberofcorners for each triangle, counterclockwise */
  REAL* triangleattributelist; /* in (r), out: numberoftriangleattributes for each triangle */
  REAL* trianglearealist;      /* in (r with a): largest area within each triangle; <= 0: no bound */
  int* neighborlist;           /* out (n): across from each corner; -1: none */
  int numberoftriangles;
  int numberofcorners; /* 3, or 6 with o2 */
  int numberoftriangleattributes;

  int* segmentlist;       /* in, out (p, c): the ends of each segment */
  int* segmentmarkerlist; /* in, out: one for each segment */
  int numberofsegments;

  REAL* holelist; /* in (p): x, y of a point in each hole */
  int numberofholes;

  REAL* regionlist; /* in (p): x, y, attribute, largest area of each region */
  int numberofregions;

  int* edgelist;       /* out (e), Voronoi: ends of each edge; the second is -1 for a ray of the Voronoi diagram */
  int* edgemarkerlist; /* out (e): one for each edge */
  REAL* normlist;      /* Voronoi: x, y of the direction of each ray; 0, 0 for other edges */
  int numberofedges;
};

/* Makes the mesh that the switches ask for (the page docs/which-tool.md has them). `vorout` may be NULL without the
 * switch v. Returns 0, or another number if there is an error, which driftmesh_triangle_error() describes; the outputs
 * are as they were then. Threads may call it at the same time. */
int driftmesh_triangulate(const char* switches, const struct triangulateio* in, struct triangulateio* out,
                          struct triangulateio* vorout);

/* The error of this thread's last call, one line without a newline; "" if there was none. Valid until the next call. */
const char* driftmesh_triangle_error(void);

/* For the switch u: what says whether a triangle with three corners (x, y each) and an area is too large. It must
 * depend on these alone and accept all small triangles. For calls of this thread; NULL: none. */
void driftmesh_set_triunsuitable(int (*unsuitable)(REAL* a, REAL* b, REAL* c, REAL area));

/* The same call by its old name. Prints the error and ends the program if there is one. */
void triangulate(char* switches, struct triangulateio* in, struct triangulateio* out, struct triangulateio* vorout);

/* Frees a list of an output. */
void trifree(VOID* list);

#ifdef __cplusplus
}
#endif

#endif
