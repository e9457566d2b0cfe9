/* Ogive geometry: closed surface meshes and their particles (library ogive_geometry).
 *
 * This header is the manual. A host turns a surface file into particles in this order:
 *
 *   ogive_mesh_create       an empty mesh; every later message belongs to it
 *   ogive_mesh_read         a surface from an STL or OFF file     (or ogive_mesh_set_facets: from arrays)
 *   ogive_mesh_check        repairs what is unambiguous, refuses what cannot be filled, orients outwards
 *   ogive_mesh_report       what was read, found and repaired, in lines of text
 *   ogive_mesh_voxelise     positions and volumes, as ogive_body_add_particles takes them
 *
 * Units, definition structs, statuses, threads, ownership and text are as ogive.h says, with "mesh" for "world": one
 * caller per mesh at a time, different meshes from different threads at once; a call that fails changes nothing but the
 * message (and, for ogive_mesh_check, the report and the findings). The library never prints, exits, raises a signal or
 * lets an exception out. It does not need libogive: only ogive.h, for the statuses.
 *
 * Facets and vertices are numbered from 0 in the order of the file, those of messages and reports too; the lines of a
 * text file are numbered from 1.
 *
 * Licence    this library uses CGAL packages under the GPL (version 3 or later): a program that links it must be
 *            distributed under terms that the GPL allows. Nothing else of Ogive depends on it.
 */
#ifndef OGIVE_GEOMETRY_H
#define OGIVE_GEOMETRY_H

#include "ogive.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ogive_mesh ogive_mesh; /* opaque */

/* Makes an empty mesh. *mesh is set to NULL on failure (only OGIVE_ERROR_MEMORY or _ARGUMENT). Destroy it once. */
OGIVE_API ogive_status ogive_mesh_create(ogive_mesh** mesh);
/* Releases everything; NULL is allowed. */
OGIVE_API void ogive_mesh_destroy(ogive_mesh* mesh);
/* Message of the last call on this mesh that failed, "" if none. Valid until the next call on the mesh. */
OGIVE_API const char* ogive_mesh_message(const ogive_mesh* mesh);

/* ---------------------------------------------------------------------------------------------------------- reading */

/* How a file is read. */
typedef struct ogive_mesh_read_def {
  uint32_t struct_size;
  uint32_t reserved0;
  double scale; /* [-] > 0: multiplies the file's coordinates (1000: a file in metres, a world in mm). Default 1 */
} ogive_mesh_read_def;
OGIVE_API void ogive_mesh_read_def_init(ogive_mesh_read_def* def, size_t size);

/* Reads a surface and replaces what the mesh held. What the file is follows from its content:
 *   binary STL   its length is 84 + 50 n, n the facet count in it, whatever the header says ("solid" too)
 *   ASCII STL    begins with "solid" and is text; several solids in one file are one surface
 *   OFF          begins with "OFF" (also COFF, NOFF, CNOFF, STOFF...: colours and normals are skipped); text only. A
 *                facet of more than three corners must be flat (to 1e-6 of its size) and convex; it becomes triangles
 * Numbers are read with a decimal point whatever the locale. Normals in STL files are ignored: the order of a facet's
 * corners counts. Corners with equal coordinates become one vertex. Open, self-intersecting... surfaces are read:
 * ogive_mesh_check judges them.
 *   OGIVE_ERROR_FILE     the file cannot be read (missing, a directory...)
 *   OGIVE_ERROR_FORMAT   not such a file, damaged, cut short, no facets, a coordinate that is not a number or beyond
 *                        1e100; the message names the line, or the facet and corner */
OGIVE_API ogive_status ogive_mesh_read(ogive_mesh* mesh, const char* path, const ogive_mesh_read_def* def);

/* The same from arrays: vertex_count >= 3 positions xyz[3 * vertex_count] [L] and facet_count >= 1 triangles
 * corners[3 * facet_count] of vertex numbers, seen from outside counter-clockwise. */
OGIVE_API ogive_status ogive_mesh_set_facets(ogive_mesh* mesh, int64_t vertex_count, const double* xyz,
                                             int64_t facet_count, const int32_t* corners);

/* --------------------------------------------------------------------------------------------------------- checking */

/* Makes the surface ready to be filled, or refuses it with OGIVE_ERROR_FORMAT: all findings are in the report; the
 * first reason, with its place, is the message. A second call changes nothing. OGIVE_ERROR_STATE if nothing was read.
 *   repaired    facets with a corner twice and facets given twice are dropped; a facet whose three corners lie exactly
 *               on one line is removed by cutting its neighbour at the corner between; facets that face the other way
 *               than their neighbours, and whole surfaces turned inside out, are turned
 *   refused     an edge of one facet (a hole) or of more than two; a one-sided surface; parts that touch in a single
 *               vertex; facets that intersect; a shell without volume; a shell inside another whose orientation does
 *               not say that it is a cavity
 *   accepted    any number of shells beside each other, and cavities: shells inside a shell that face inwards, and
 *               solids within cavities in turn
 * All tests are exact for the coordinates as they are in double precision. */
OGIVE_API ogive_status ogive_mesh_check(ogive_mesh* mesh);

/* What was read, found, repaired or refused: lines of text. Writes at most capacity bytes with the final zero and sets
 * *needed to the size of the whole text with it. text may be NULL where capacity is 0. Empty before ogive_mesh_read. */
OGIVE_API ogive_status ogive_mesh_report(const ogive_mesh* mesh, char* text, size_t capacity, size_t* needed);

/* The surface in numbers. Facets, vertices, area and box describe it as it is now: as read, or as repaired once
 * ogive_mesh_check accepted it. The findings describe what the last ogive_mesh_check met (0 before it). */
typedef struct ogive_mesh_info {
  uint32_t struct_size;
  int32_t checked;            /* 1: ogive_mesh_check accepted it, so it can be filled */
  int64_t facets;             /* triangles */
  int64_t vertices;           /* different corners */
  double area;                /* [L2] */
  double lower[3];            /* [L] bounding box in mesh coordinates */
  double upper[3];            /* [L] */
  /* Once checked; 0 otherwise. */
  double volume;              /* [L3] enclosed, cavities taken off */
  int32_t shells;             /* closed surfaces, cavities among them */
  int32_t cavities;           /* shells that face inwards */
  /* Findings. */
  int64_t dropped_degenerate; /* facets with a corner twice: dropped */
  int64_t dropped_duplicate;  /* facets given more than once: all but the first dropped */
  int64_t removed_flat;       /* facets with corners on one line: removed by cutting their neighbours */
  int64_t turned;             /* facets turned */
  int64_t open_edges;         /* edges of one facet: refused */
  int64_t crowded_edges;      /* edges of more than two facets: refused */
  int64_t touching_vertices;  /* vertices in which parts only touch: refused */
  int64_t intersecting_pairs; /* pairs of facets that intersect: refused; not counted where others are refused first */
} ogive_mesh_info;
/* struct_size must be set by the caller. OGIVE_ERROR_STATE if nothing was read. */
OGIVE_API ogive_status ogive_mesh_info_get(const ogive_mesh* mesh, ogive_mesh_info* info);

/* --------------------------------------------------------------------------------------------- filling by particles */

/* Particles are the centres, inside the surface, of the cells of a lattice that is fixed to the mesh:
 *   centre = lattice_origin + (i + 1/2) spacing[0] X + (j + 1/2) spacing[1] Y + (k + 1/2) spacing[2] Z
 * for whole numbers i, j, k, so that a mesh that is symmetric about coordinate planes gets particles that are symmetric
 * to the last bit. A centre exactly on the surface belongs to the solid. Each particle has the same volume: the
 * enclosed volume divided by their number. Then the whole is rotated and moved: for mesh coordinates x, y, z
 *   world = position + x X' + y Y' + z Z'
 *
 * Both rotations come from an axis (where z points, of any length) and a reference:
 *   reference not zero      x points along the reference's part normal to the axis; they must not be parallel
 *   reference zero          the smallest rotation that takes z to the axis; for the axis -z: half a turn about y
 * y follows: right-handed. An axis in the x-z plane, without a reference, keeps y exactly as it is. */
typedef struct ogive_voxelise_def {
  uint32_t struct_size;
  uint32_t reserved0;
  double spacing[3];           /* [L] > 0 along the lattice axes X, Y, Z. No default */
  double lattice_axis[3];      /* [-] Z in mesh coordinates, not zero. Default (0,0,1) */
  double lattice_reference[3]; /* [-] for X. Default 0, so the lattice axes are the mesh's own */
  double lattice_origin[3];    /* [L] in mesh coordinates. Default 0 */
  double axis[3];              /* [-] where the mesh's z axis points in the world, not zero. Default (0,0,1) */
  double reference[3];         /* [-] for the mesh's x axis. Default 0 */
  double position[3];          /* [L] where the mesh's origin goes in the world. Default 0 */
} ogive_voxelise_def;
OGIVE_API void ogive_voxelise_def_init(ogive_voxelise_def* def, size_t size);

/* The particles of a checked mesh. First call with xyz = volume = NULL to learn *count, then with *count as it was
 * given and room for it: xyz[3 * count] [L], volume[count] [L3]. The order is the same each time. Inside or outside is
 * decided by exact predicates, whatever the lattice: no line slips through an edge.
 *   OGIVE_ERROR_STATE     the mesh was not accepted by ogive_mesh_check
 *   OGIVE_ERROR_ARGUMENT  no lattice centre lies inside (the spacing is too large); the bounding box holds more than
 *                         1e11 lattice cells or reaches farther than 1e9 cells from the lattice origin, or that lies
 *                         farther than 1e9 cells from the mesh's; *count is another than the first call gave */
OGIVE_API ogive_status ogive_mesh_voxelise(const ogive_mesh* mesh, const ogive_voxelise_def* def, int64_t* count,
                                           double* xyz, double* volume);

/* The surface of a checked mesh where ogive_mesh_voxelise puts its particles (axis, reference and position of def; the lattice
 * is not looked at), as ogive_body_set_surface takes it. First call with xyz = corners = NULL to learn *vertex_count and
 * *triangle_count, then with these and room for them: xyz[3 * vertex_count] [L], corners[3 * triangle_count] vertex numbers
 * from 0, counter-clockwise from outside.
 *   OGIVE_ERROR_STATE     the mesh was not accepted by ogive_mesh_check
 *   OGIVE_ERROR_ARGUMENT  a count is another than the first call gave */
OGIVE_API ogive_status ogive_mesh_surface(const ogive_mesh* mesh, const ogive_voxelise_def* def, int64_t* vertex_count,
                                          int64_t* triangle_count, double* xyz, int32_t* corners);

#ifdef __cplusplus
}
#endif
#endif
