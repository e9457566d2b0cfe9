/* Ogive: explicit three-dimensional material point method for impact and penetration.
 *
 * This header is the manual of the C interface. A host builds a world in this order:
 *
 *   ogive_world_create          an empty world; every later message belongs to it
 *   ogive_world_set_grid        cell size, domain, boundary of each face
 *   ogive_world_set_numerics    shape function, time-step factor, threads      (optional)
 *   ogive_world_set_contact     contact method for all pairs of bodies         (optional)
 *   ogive_material_add          materials
 *   ogive_body_add_*            bodies, each of one material
 *   ogive_body_set_motion       motion of a rigid body as a table in time      (optional)
 *   ogive_contact_set_pair      another contact rule for one pair              (optional)
 *   ogive_wall_add              rigid walls                                    (optional)
 *   ogive_clamp_add             what is held                                   (optional)
 *   ogive_load_add              accelerations, tractions, prescribed velocities (optional)
 *   ogive_world_prepare         checks the whole model once and freezes it
 *   ogive_world_step / ogive_world_advance
 *
 * Units      any consistent set; nothing here carries units of its own. With mm, ms and g: stress in MPa, speed in
 *            m/s, energy in mJ, specific heat in J/(kg K). Each field names its dimension in [brackets]:
 *            L length, T time, M mass, K temperature, - none.
 * Structs    every definition struct starts with struct_size. Fill it by its *_init function, which takes sizeof of the
 *            struct as the caller was compiled, then change what differs from the defaults. A result struct needs its
 *            struct_size set before the call. Fields are only ever appended; those named reserved are 0 and not used.
 * Errors     every function returns an ogive_status; OGIVE_OK is 0. Otherwise nothing was changed and
 *            ogive_world_message names the field, the value and what was expected. The library never prints, exits,
 *            raises a signal or lets an exception out. (The OpenMP run time is not under its control: it ends the process
 *            where the system refuses it threads. One thread needs none.)
 * Threads    one caller per world at a time; different worlds may be used from different threads at once.
 * Ownership  the library copies everything it is given. Pointers that it returns say how long they live.
 * Text       UTF-8, zero-terminated.
 */
#ifndef OGIVE_H
#define OGIVE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Marks what the libraries export. */
#if defined(OGIVE_BUILDING) && defined(__GNUC__)
#define OGIVE_API __attribute__((visibility("default")))
#else
#define OGIVE_API
#endif

#define OGIVE_VERSION_MAJOR 0 /* version of this header: the soname's number */
#define OGIVE_VERSION_MINOR 2 /* grows with additions */
#define OGIVE_VERSION_PATCH 0 /* grows with corrections */
/* Grows by one whenever functions, fields or choices are appended; nothing is ever removed or given another meaning while the
 * major version stays. Version 0.1.0 had 1. */
#define OGIVE_ABI 2

/* ------------------------------------------------------------------------------------------------ status, ids, names */

/* What every call returns: OGIVE_OK or OGIVE_ERROR_*. */
typedef int32_t ogive_status;
enum {
  OGIVE_OK = 0,
  OGIVE_ERROR_ARGUMENT = 1,      /* a value outside its range, a null pointer, a wrong struct_size, an unknown name or id */
  OGIVE_ERROR_STATE = 2,         /* a call in the wrong order (for example a step before ogive_world_prepare) */
  OGIVE_ERROR_MEMORY = 3,        /* memory could not be had; the world is as it was before the call. Only a step that runs
                                    out of memory half-way leaves a world that can be looked at and saved, not advanced */
  OGIVE_ERROR_NUMERICAL = 4,     /* the run broke down: NaN, inverted volume, runaway particle, collapsed time step */
  OGIVE_ERROR_FILE = 5,          /* a file cannot be read or written */
  OGIVE_ERROR_FORMAT = 6,        /* a file is damaged, foreign or of an unknown version */
  OGIVE_ERROR_INTERNAL = 7       /* a defect in the library: please report it with the message */
};

typedef struct ogive_world ogive_world; /* opaque */
/* A material of a world. */
typedef struct ogive_material_id {
  int32_t index; /* 0-based; -1 is none */
} ogive_material_id;
/* A body of a world. */
typedef struct ogive_body_id {
  int32_t index; /* 0-based; -1 is none */
} ogive_body_id;
/* A load of a world. */
typedef struct ogive_load_id {
  int32_t index; /* 0-based; -1 is none */
} ogive_load_id;

/* Such as "0.2.0"; lives for ever. */
OGIVE_API const char* ogive_version(void);
/* OGIVE_ABI of the library. A program runs with every library of the same soname whose number is not below the
 * OGIVE_ABI that it was compiled with. */
OGIVE_API int32_t ogive_abi_version(void);
/* A short English name of a status; lives for ever. */
OGIVE_API const char* ogive_status_name(ogive_status status);

/* ------------------------------------------------------------------------------------------------------------- world */

/* Makes an empty world. *world is set to NULL on failure (only OGIVE_ERROR_MEMORY or _ARGUMENT). Destroy it once. */
OGIVE_API ogive_status ogive_world_create(ogive_world** world);
/* Releases everything; NULL is allowed. */
OGIVE_API void ogive_world_destroy(ogive_world* world);
/* Message of the last call on this world that failed, "" if none. Valid until the next call on the world. */
OGIVE_API const char* ogive_world_message(const ogive_world* world);
/* Sets the message of the world (NULL: "") and returns status; for companion libraries and hosts. */
OGIVE_API ogive_status ogive_world_report(ogive_world* world, ogive_status status, const char* message);

/* What a world tells while it works, beside its statuses. */
enum {
  OGIVE_LOG_INFO = 1,    /* prepared, loaded, a stop condition met, the first failed particle of a body */
  OGIVE_LOG_WARNING = 2, /* cautions of the plan; the first particle of a body that leaves the domain */
  OGIVE_LOG_ERROR = 3    /* the message of each call that fails */
};
/* One line without its end; text lives during the call. It may query the world, and must not change or destroy it. Called
 * on the thread of the caller. */
typedef void (*ogive_log_callback)(void* user, int32_t level, const char* text);
/* At any time; NULL: silence, the default. It is no part of what is saved. */
OGIVE_API ogive_status ogive_world_set_log(ogive_world* world, ogive_log_callback callback, void* user);

/* Boundary of a domain face. */
enum {
  OGIVE_FACE_FREE = 0,     /* nothing acts there; a particle that crosses is removed and its mass, momentum, energy booked */
  OGIVE_FACE_SYMMETRY = 1, /* mirror plane: normal velocity zero, the mirrored material is part of every nodal sum;
                              bodies given whole are cut there (a particle whose centre lies on the plane keeps half) */
  OGIVE_FACE_FIXED = 2     /* velocity zero */
};

/* Dimensions of a world. In a two-dimensional one all lies and moves in the plane z = 0; the grid has one layer of nodes there,
 * and z of the domain and its faces are not used. A built-in solid is the section of it with the plane, a particle's volume is
 * that of the body it stands for: sums (mass, momentum along y, energies, forces) are those of that body. Contact by surfaces
 * (OGIVE_DETECTION_SURFACE) is for three dimensions. */
enum {
  OGIVE_SPACE_THREE_DIMENSIONAL = 0,
  OGIVE_SPACE_PLANE_STRAIN = 1, /* no strain along z; volumes are those of `thickness` along z */
  OGIVE_SPACE_AXISYMMETRIC = 2  /* bodies of revolution about y, without twist: x is the radius, domain_min[0] must be 0 and the
                                   face x min is a symmetry face; volumes are those of whole rings. The x components of momenta,
                                   impulses and forces are sums of radial ones (those of the whole body vanish), with what hoop
                                   stress gives in boundary_impulse; centre, velocity and speed of a body are the whole
                                   body's, and angular momentum is 0. Rigid bodies move along y alone */
};

/* The background grid. */
typedef struct ogive_grid_def {
  uint32_t struct_size;
  uint32_t reserved0;
  double cell_size;     /* [L] > 0; no default */
  double domain_min[3]; /* [L] lower corner; a grid node lies there. No default */
  double domain_max[3]; /* [L] upper corner, > domain_min. Where the face is symmetry or fixed, (max - min) must be a
                           whole number of cells (to 1e-6 of a cell) so that the face holds nodes. No default */
  int32_t face[6];      /* OGIVE_FACE_*: x min, x max, y min, y max, z min, z max. Default free */
  int32_t space;        /* OGIVE_SPACE_*. Default three-dimensional */
  int32_t reserved1;
  double thickness;     /* [L] > 0, with plane strain: of what is modelled along z. Default 1 */
} ogive_grid_def;
OGIVE_API void ogive_grid_def_init(ogive_grid_def* def, size_t size);
/* Before the bodies; another call replaces the grid. */
OGIVE_API ogive_status ogive_world_set_grid(ogive_world* world, const ogive_grid_def* def);

/* Shape functions. */
enum {
  OGIVE_SHAPE_LINEAR = 0,            /* trilinear, 8 nodes */
  OGIVE_SHAPE_QUADRATIC_BSPLINE = 1, /* quadratic B-spline, 27 nodes */
  OGIVE_SHAPE_GIMP = 2              /* GIMP (Bardenhagen, Kober 2004) with particles half a cell wide along each axis, 27
                                       nodes: between the two, smooth and narrower than the B-spline */
};

/* How velocity travels between particles and grid. */
enum {
  OGIVE_TRANSFER_FLIP = 0,        /* particles take the change of the grid's velocity, Huang et al. 2010 Eq. (34) */
  OGIVE_TRANSFER_AFFINE_FLIP = 1, /* the same, and each particle gives the grid the velocity field around it, v + C (x - x_p),
                                     with C from the grid's last velocity (Jiang et al. 2015): without the noise of FLIP
                                     below the grid's resolution, at the price of some energy (transfer_dissipation) */
  OGIVE_TRANSFER_APIC = 2,        /* particles take the grid's velocity itself and C (Jiang et al. 2015) */
  OGIVE_TRANSFER_XPIC = 3         /* XPIC(k) (Hammerquist, Nairn 2017): as FLIP, without the part of a particle's velocity
                                     that the grid cannot see, filtered k-fold; k - 1 more passes a step */
};
/* When stress is updated. */
enum {
  OGIVE_UPDATE_STRESS_FIRST = 0, /* USF, the papers' order: at the beginning of the step */
  OGIVE_UPDATE_STRESS_LAST = 1,  /* MUSL: at the end, from the new velocities mapped once more; a third dearer. With
                                    trilinear functions it prevents pressures that grow in particles lying at nodes */
  OGIVE_UPDATE_STRESS_LAST_AS_IS = 2 /* USL (Sulsky, Chen, Schreyer 1994): at the end, from the nodal velocities as they are;
                                    unstable at nodes with next to no mass, kept to show it */
};

/* How the world is computed. */
typedef struct ogive_numerics_def {
  uint32_t struct_size;
  int32_t shape_function;   /* OGIVE_SHAPE_*. Default quadratic B-spline */
  double time_step_factor;  /* [-] alpha of Huang et al. 2010 Eq. (35), 0 < alpha <= 1.5. Default 0.5: with affine
                               velocities a lone particle is stable below 0.58 to 0.73, with FLIP B-splines bear 0.8 */
  double maximum_time_step; /* [T] upper limit, > 0; infinity allowed. Default infinity */
  int32_t threads;          /* 1..1024, 0: all processors that this process may use. Results do not depend on it. Default 1 */
  int32_t reserved0;
  double gravity[3];        /* [L/T2] body force per mass on every body. Default 0 */
  int32_t transfer;         /* OGIVE_TRANSFER_*. Default affine FLIP */
  int32_t update_order;     /* OGIVE_UPDATE_*. Default stress first */
  double pic_fraction;      /* [-] 0..1: part of the grid's own velocity in a particle's new one, each step. Default 0; APIC
                               has 1 whatever stands here, XPIC none */
  int32_t xpic_order;       /* k of XPIC(k), 1..20; 1 is PIC. Default 2 */
  int32_t reserved1;
  double energy_warning;    /* [-] growth of the energy, of what there was and of the work done, that is warned of: a line of the
                               log, energy_warning_time of the ledger. Looked at every 25th step. > 0, infinity allowed.
                               Default 0.01 */
  double energy_limit;      /* [-] growth at which a step fails with OGIVE_ERROR_NUMERICAL; the message names the time, the
                               particle with the most energy and the probable cause. > 0, infinity allowed. Default 1 */
  int32_t drop_debris;      /* 1: fragments that can meet nothing any more are removed and booked (dropped_* of ledger and body
                               results); looked for at every 50th step, the number of steps alone decides. Default 0.
                               All that lies nearer than 4 cells together is one fragment. It is dropped where it has at
                               most 1 % of the mass that each of its bodies was given and is not the largest left of one,
                               where no load or force acts on it, and where it keeps 4 cells from everything until it has
                               left the domain by a free face: it is a box that moves with any velocity that differs from
                               its centre's by at most the largest such difference of its particles now. Everything: the
                               boxes of other fragments and bodies, with any of the velocities of their particles (of
                               rigid bodies: any that their motion can have), of those that they may meet, and as a wall
                               or mirror would turn these round; walls; symmetry and fixed faces (2 cells); regions of
                               clamps and prescribed velocities that hold its bodies. Never where gravity acts, never of
                               rigid and total Lagrangian bodies or those whose surface makes contact; not with
                               OGIVE_SPACE_AXISYMMETRIC. What others do after later collisions among themselves is not
                               foreseen beyond that */
  int32_t skip_resting;     /* 1: particles to which nothing has happened yet, far from all that moves, are left out of a step; 0:
                               they are computed too. No bit of any result depends on it (docs/theory.md, section 9a); never
                               left out: what gravity or a load acts on, total Lagrangian bodies, anything where contact is by
                               surfaces. Default 1 */
  double energy_loss_limit; /* [-] loss of energy that no term of the ledger has (a negative growth) at which a step fails as at
                               energy_limit. > 0, infinity allowed. Default 1: as good as never */
} ogive_numerics_def;
OGIVE_API void ogive_numerics_def_init(ogive_numerics_def* def, size_t size);
/* Before ogive_world_prepare; another call replaces them. */
OGIVE_API ogive_status ogive_world_set_numerics(ogive_world* world, const ogive_numerics_def* def);
/* Changes the thread count at any time; results do not depend on it. */
OGIVE_API ogive_status ogive_world_set_threads(ogive_world* world, int32_t threads);

/* A part of space whose grid nodes are held at rest (a clamp). */
enum {
  OGIVE_REGION_BOX = 0,             /* point a .. point b, a <= b */
  OGIVE_REGION_OUTSIDE_CYLINDER = 1, /* farther than radius from the line through a along direction b */
  OGIVE_REGION_EVERYWHERE = 2        /* a, b and radius are not used */
};
/* What is held, and where. */
typedef struct ogive_clamp_def {
  uint32_t struct_size;
  int32_t region;       /* OGIVE_REGION_*. Default box */
  double a[3];          /* [L] */
  double b[3];          /* [L] for a box, [-] for a direction */
  double radius;        /* [L] > 0 for a cylinder */
  ogive_body_id body;   /* the body that is held; index -1: all. Default all */
  int32_t axes;         /* bit 0 x, bit 1 y, bit 2 z: velocity components that are held. Default 7 */
} ogive_clamp_def;
OGIVE_API void ogive_clamp_def_init(ogive_clamp_def* def, size_t size);
/* Before ogive_world_prepare; there may be any number. */
OGIVE_API ogive_status ogive_clamp_add(ogive_world* world, const ogive_clamp_def* def);

/* Loads beside gravity: what the host applies. */
enum {
  OGIVE_LOAD_ACCELERATION = 0, /* force per mass [L/T2] on the particles that lay in the region when the world was prepared */
  OGIVE_LOAD_TRACTION = 1,     /* force per area [M/(L T2)] on a surface of the size `area`: value x area is shared by mass
                                  among the particles of the body that lay in the region when the world was prepared, best
                                  its outermost layer. It keeps its direction (a dead load) */
  OGIVE_LOAD_VELOCITY = 2      /* velocity [L/T] of the body's grid nodes in the region, which stays where it is */
};
/* A load. */
typedef struct ogive_load_def {
  uint32_t struct_size;
  int32_t kind;         /* OGIVE_LOAD_*. Default acceleration */
  int32_t region;       /* OGIVE_REGION_*. Default everywhere */
  ogive_body_id body;   /* the body that is loaded; index -1: all, not with traction. Default all */
  double a[3];          /* [L] as in ogive_clamp_def */
  double b[3];          /* [L] for a box, [-] for a direction */
  double radius;        /* [L] > 0 for a cylinder */
  double value[3];      /* as the kind says, finite. Default 0 */
  double area;          /* [L2] > 0 with traction: the loaded surface before it deforms, as modelled (a half model: half) */
  int32_t axes;         /* with velocity: bit 0 x, bit 1 y, bit 2 z: components that are prescribed. Default 7 */
  int32_t reserved0;
} ogive_load_def;
OGIVE_API void ogive_load_def_init(ogive_load_def* def, size_t size);
/* Before ogive_world_prepare, which refuses a traction that meets no particle and more than 31 accelerations and tractions on
 * a body. id may be NULL. */
OGIVE_API ogive_status ogive_load_add(ogive_world* world, const ogive_load_def* def, ogive_load_id* id);
/* Another value[3] from the next step on; at any time, also from a step callback. Loads travel in every save. */
OGIVE_API ogive_status ogive_load_set(ogive_world* world, ogive_load_id load, const double* value);

/* --------------------------------------------------------------------------------------------------------- materials */

/* Deviatoric response. */
enum {
  OGIVE_STRENGTH_ELASTIC = 0,     /* linear elastic deviator, objective rate */
  OGIVE_STRENGTH_NEO_HOOKEAN = 1, /* compressible neo-Hookean from the deformation gradient; it brings its own pressure,
                                     so eos must be linear and bulk modulus K and shear modulus G come from E and nu
                                     or from bulk_modulus and shear_modulus */
  OGIVE_STRENGTH_J2_POWER = 2,    /* von Mises, yield stress A + B eps_p^n, Huang et al. 2010 Eq. (37) */
  OGIVE_STRENGTH_JOHNSON_COOK = 3, /* (A + B eps_p^n)(1 + C ln eps_rate*)(1 - T*^m), Huang et al. 2010 Eq. (39) */
  /* Von Mises, yield stress A + c B eps_p and Prager's back stress of modulus (1 - c) B, c = isotropic_fraction; n must be 1 and
   * eos linear. Both keep the deformation gradient and a plastic strain and back stress tensor. */
  OGIVE_STRENGTH_J2_MIXED = 4,    /* Lee et al. 2005 (2.1)-(2.13), in second Piola-Kirchhoff stress and Green-Lagrange strain:
                                     for moderate strains, large rotations */
  OGIVE_STRENGTH_J2_MULTIPLICATIVE = 5 /* F = F_e F_p with logarithmic elastic strain (principal elastic stretches within
                                     1/1.5..1.5), for large strains */
};
/* Pressure. */
enum {
  OGIVE_EOS_LINEAR = 0,         /* p = -K ln J: bulk modulus constant in the logarithmic volume strain */
  OGIVE_EOS_MIE_GRUNEISEN = 1   /* Huang et al. 2010 Eq. (38) */
};
/* Failure. */
enum {
  OGIVE_FAILURE_NONE = 0,
  OGIVE_FAILURE_PLASTIC_STRAIN = 1 /* at eps_p >= failure_strain: deviator zero, tension zero, compression kept */
};

/* A material; fields that its strength, eos and failure do not need are not looked at. */
typedef struct ogive_material_def {
  uint32_t struct_size;
  int32_t strength;            /* OGIVE_STRENGTH_*. Default elastic */
  int32_t eos;                 /* OGIVE_EOS_*. Default linear */
  int32_t failure;             /* OGIVE_FAILURE_*. Default none */
  double density;              /* [M/L3] > 0 at rest. No default */
  /* Elastic constants: either Young's modulus and Poisson ratio, or bulk and shear modulus; the other two stay 0. */
  double youngs_modulus;       /* [M/(L T2)] > 0 */
  double poisson_ratio;        /* [-] -1 < nu < 0.5 */
  double bulk_modulus;         /* [M/(L T2)] > 0 */
  double shear_modulus;        /* [M/(L T2)] >= 0 */
  /* Yield stress (J2 power law and Johnson-Cook). */
  double yield_stress;         /* A [M/(L T2)] > 0 */
  double hardening_modulus;    /* B [M/(L T2)] >= 0. Default 0 */
  double hardening_exponent;   /* n [-] > 0. Default 1 */
  double rate_coefficient;     /* C [-] >= 0. Default 0: no rate work is done */
  double reference_strain_rate;/* [1/T] > 0. Default 1 */
  double thermal_exponent;     /* m [-] > 0; 0: no thermal softening and no temperature kept. Default 0 */
  double melt_temperature;     /* [K] > room_temperature, where m > 0 */
  double room_temperature;     /* [K] >= 0. Default 293 */
  double specific_heat;        /* [L2/(T2 K)] > 0, where m > 0 */
  double taylor_quinney;       /* part of the plastic work that heats, 0..1. Default 1 */
  /* Mie-Grueneisen. */
  double eos_sound_speed;      /* c0 [L/T] > 0 */
  double eos_slope;            /* s [-] >= 0 */
  double gruneisen;            /* gamma0 [-] >= 0 */
  /* Failure. */
  double failure_strain;       /* [-] > 0 where failure is by plastic strain */
  /* Bulk viscosity q = rho h |d| (c_q h |d| + c_l c) where the volume shrinks at rate d. Default 0: no work is done. */
  double viscosity_linear;     /* c_l [-] >= 0 */
  double viscosity_quadratic;  /* c_q [-] >= 0 */
  double isotropic_fraction;   /* c [-] 0..1: part of the hardening that is isotropic, the rest is kinematic; J2 mixed and
                                  multiplicative. Default 1 */
} ogive_material_def;
OGIVE_API void ogive_material_def_init(ogive_material_def* def, size_t size);
/* name: 1..63 characters, unique among materials; used in messages. */
OGIVE_API ogive_status ogive_material_add(ogive_world* world, const char* name, const ogive_material_def* def,
                                          ogive_material_id* id);

/* ------------------------------------------------------------------------------------------------------------ bodies */

enum {
  OGIVE_FORMULATION_DEFORMABLE = 0,
  /* A rigid body has no strain, stress or failure and meets others by contact alone (domain faces and clamps do not hold
   * it; use walls). A symmetry face that cuts or touches it makes it one with its mirror images. */
  OGIVE_FORMULATION_RIGID_FREE = 1,      /* six degrees of freedom; mass, centre and inertia from its particles */
  OGIVE_FORMULATION_RIGID_PRESCRIBED = 2, /* infinite mass in contact; moves with velocity, and turns with angular_velocity
                                            about the point that is at angular_centre at time 0 and moves with velocity;
                                            or as ogive_body_set_motion says */
  /* Nodes and shape functions of the body as it is when the world is prepared, Lee et al. 2005: no errors of particles that
   * cross cells, no numerical fracture, less work a step. For elastic bodies and moderate plastic deformation. Any material.
   * Clamps and prescribed velocities hold the particles that lay in their region at the beginning. The body is not cut by
   * the domain's free faces; it is removed once all of it is outside. */
  OGIVE_FORMULATION_TOTAL_LAGRANGIAN = 3
};
/* What becomes of a total Lagrangian body once some particle is distorted beyond the body's limit. */
enum {
  OGIVE_DISTORTED_UPDATE = 0, /* from the next step on it is updated Lagrangian (deformable); mass and momentum stay, the kinetic
                                 energy that its particles do not see is booked as transfer_dissipation */
  OGIVE_DISTORTED_STOP = 1    /* the step is OGIVE_ERROR_NUMERICAL */
};
/* What a body is made of and how it moves at first. */
typedef struct ogive_body_def {
  uint32_t struct_size;
  ogive_material_id material; /* no default */
  double velocity[3];         /* [L/T] initial velocity of every particle. Default 0 */
  double angular_velocity[3]; /* [1/T] initial rotation about angular_centre, added to velocity. Default 0 */
  double angular_centre[3];   /* [L]. Default 0 */
  int32_t formulation;        /* OGIVE_FORMULATION_*. Default deformable */
  int32_t reserved0;
  /* Total Lagrangian bodies. The distortion of a particle is |F| |F^-1| / 3 with the Frobenius norm: 1 undeformed, 3.8 stretched
   * to four times its length at constant volume. */
  double distortion_limit;    /* [-] > 1, infinity allowed. Default 10 */
  int32_t when_distorted;     /* OGIVE_DISTORTED_*. Default update */
  int32_t reserved1;
  /* Deformable bodies. Fewer particles away from where things happen: in cells whose centre is farther than coarse_beyond from
   * the line between coarse_from and coarse_to, a cell's particles become one, at their centre of mass with their volume. What
   * has one particle a cell carries waves and elastic deformation well; it must not be where the body flows, tears or is hit
   * (measured: docs/performance.md). */
  double coarse_from[3];      /* [L]. Default 0 */
  double coarse_to[3];        /* [L], may be the same point. Default 0 */
  double coarse_beyond;       /* [L] > 0; 0: all particles as they are. Default 0 */
} ogive_body_def;
OGIVE_API void ogive_body_def_init(ogive_body_def* def, size_t size);

/* A body from particles: count >= 1 positions xyz[3 * count] [L] inside the domain and volumes volume[count] [L3] > 0.
 * Particles beyond a symmetry face are cut off. name: 1..63 characters, unique among bodies. */
OGIVE_API ogive_status ogive_body_add_particles(ogive_world* world, const char* name, const ogive_body_def* def,
                                                int64_t count, const double* xyz, const double* volume,
                                                ogive_body_id* id);

/* The motion of a rigid body with prescribed motion in place of a constant one: `count` >= 1 ascending times [T], velocities
 * [L/T] of the reference point (angular_centre at time 0) and angular velocities [1/T], 3 * count each; NULL: zero. Linear
 * between the times, constant before the first and after the last. Before ogive_world_prepare, or between steps, when a host
 * moves the body by its own solver: the next step begins with the new motion, and the ledger books the change. */
OGIVE_API ogive_status ogive_body_set_motion(ogive_world* world, ogive_body_id body, int32_t count, const double* time,
                                             const double* velocity, const double* angular_velocity);

/* Built-in solids. Each is defined in its own axes with the origin at `centre`; axis 3 (z) is the axis of revolution. */
enum {
  OGIVE_SOLID_BOX = 0,      /* size[0] x size[1] x size[2], centred */
  OGIVE_SOLID_CYLINDER = 1, /* size[0] outer radius, size[1] length, size[2] inner radius (0: solid; > 0: a ring), centred */
  OGIVE_SOLID_SPHERE = 2,   /* size[0] radius */
  OGIVE_SOLID_OGIVE_ROD = 3 /* tangent-ogive nose: size[0] radius, size[1] overall length, size[2] ogive radius divided by
                               the diameter (caliber-radius-head, >= 0.5). Tip at the origin, body along -z */
};
enum {
  OGIVE_LATTICE_CARTESIAN = 0, /* centres at (i + 1/2) spacing from the solid's symmetry planes (box: spacing is rounded so
                                  that whole particles fill each edge) */
  OGIVE_LATTICE_POLAR = 1      /* cylinder only: rings of equal radial thickness, spacing[0] radial, spacing[1] along the
                                  circumference at the middle radius, spacing[2] axial; every particle has its exact volume */
};
/* A built-in solid and its lattice of particles. */
typedef struct ogive_solid_def {
  uint32_t struct_size;
  int32_t solid;        /* OGIVE_SOLID_* */
  int32_t lattice;      /* OGIVE_LATTICE_*. Default Cartesian */
  int32_t reserved0;
  double size[3];       /* [L] as above */
  double centre[3];     /* [L]. Default 0 */
  double axis[3];       /* [-] direction of the solid's z axis, not zero. Default (0,0,1) */
  double reference[3];  /* [-] the solid's x axis is this direction's part normal to axis; (0,0,0): chosen. Default 0 */
  double spacing[3];    /* [L] > 0, in the solid's own axes */
} ogive_solid_def;
OGIVE_API void ogive_solid_def_init(ogive_solid_def* def, size_t size);
/* A body filled from a built-in solid; particle volumes sum to the exact volume of the solid. In a two-dimensional world it is
 * the solid's section with z = 0: its centre and one of its axes must lie there, the other axes along or across z; particles
 * lie on the lattice of its axes in the plane. In an axisymmetric one the section turns about y: it must lie at x >= 0 or be
 * symmetric about x = 0, and the volumes sum to that of the body of revolution. A polar lattice is then a Cartesian one. */
OGIVE_API ogive_status ogive_body_add_solid(ogive_world* world, const char* name, const ogive_body_def* def,
                                            const ogive_solid_def* solid, ogive_body_id* id);
/* The particles such a body would get in the world as it is. First call with xyz = volume = NULL to learn *count, then with room for it. */
OGIVE_API ogive_status ogive_solid_particles(ogive_world* world, const ogive_solid_def* solid, int64_t* count, double* xyz,
                                             double* volume);

/* The surface of a body for OGIVE_DETECTION_SURFACE, as it lies in the world now: vertex_count >= 4 positions
 * xyz[3 * vertex_count] [L], finite, and triangle_count >= 4 triangles corners[3 * triangle_count] of vertices numbered from 0,
 * counter-clockwise from outside. It must be closed and oriented, each edge shared by two triangles; what ogive_mesh_check
 * accepts is (ogive_mesh_surface gives it). A body that symmetry faces cut is given whole, as its particles are. A rigid body
 * carries it with its motion, a deformable one moves the vertices with its own velocities. A body of ogive_body_add_solid has its
 * surface without this call: exact where it is rigid, else triangles of half a cell where a rule asks for them. Before
 * ogive_world_prepare; another call replaces it. */
OGIVE_API ogive_status ogive_body_set_surface(ogive_world* world, ogive_body_id body, int64_t vertex_count, const double* xyz,
                                              int64_t triangle_count, const int32_t* corners);
/* The same from a built-in solid for a body given by its particles: exact with sharp tip and edges where it is rigid, else
 * triangles of half a cell; lattice and spacing are not looked at. */
OGIVE_API ogive_status ogive_body_set_surface_solid(ogive_world* world, ogive_body_id body, const ogive_solid_def* solid);

/* ----------------------------------------------------------------------------------------------------------- contact */

enum {
  OGIVE_CONTACT_SINGLE_FIELD = 0, /* standard MPM: one velocity field, no slip, no separation */
  OGIVE_CONTACT_HUANG_FIRST = 1,  /* Huang et al. 2010, section 3.1: on the deformed grid */
  OGIVE_CONTACT_HUANG_SECOND = 2, /* Huang et al. 2010, section 3.2: also on the redefined grid */
  OGIVE_CONTACT_YORK = 3,         /* York, Sulsky, Schreyer 1999: standard MPM while bodies approach, free departure; no
                                     friction coefficient */
  OGIVE_CONTACT_HU_CHEN = 4,      /* Hu, Chen 2003: common normal velocity, own tangential velocities; no friction */
  OGIVE_CONTACT_BARDENHAGEN_2000 = 5, /* Bardenhagen, Brackbill, Sulsky 2000: both bodies approach by their own normals */
  OGIVE_CONTACT_BARDENHAGEN_2001 = 6, /* Bardenhagen et al. 2001: and are released once the normal traction pulls */
  OGIVE_CONTACT_PAN_2008 = 7,     /* Pan et al. 2008: equal normal accelerations, while the force pushes */
  OGIVE_CONTACT_PERSISTENT = 8    /* Huang's second with Pan's persistence in the strain too: keeps energy */
};
enum {
  OGIVE_NORMAL_MASTER = 0, /* the master body's mass gradient, Eq. (9) and choices 1, 2 of section 2.3 */
  OGIVE_NORMAL_AVERAGE = 1, /* Eq. (10) */
  OGIVE_NORMAL_VOLUME_GRADIENT = 2, /* difference of the gradients of volume at rest */
  OGIVE_NORMAL_OCCUPIED_CELL = 3,   /* Pan et al. 2008: from the cells around the node that hold particles */
  OGIVE_NORMAL_LOGISTIC_REGRESSION = 4 /* Nairn, Hammerquist, Smith 2020: most probable plane between the particles */
};
enum {
  OGIVE_DETECTION_SHARED_NODE = 0, /* the papers: both bodies reach the node */
  OGIVE_DETECTION_GAP = 1,         /* and the bodies' nearest sides at the node, measured along the normal, are closer than
                                      gap_offset cells (docs/theory.md) */
  OGIVE_DETECTION_SURFACE = 2      /* normal and gap from the signed distance to the true surface of one of the bodies (or to
                                      the wall); `normal` and `master` are not used but where two bodies of one kind
                                      (rigid, total, updated Lagrangian; the first named has the surface) both have one: the
                                      master's is taken, or the first body's. See
                                      ogive_body_set_surface */
};
/* A rule of contact. */
typedef struct ogive_contact_def {
  uint32_t struct_size;
  int32_t method;       /* OGIVE_CONTACT_*. Default persistent. single_field as the rule of a pair among others holds the
                           pair without slip and separation at every node that both reach */
  int32_t normal;       /* OGIVE_NORMAL_*. Default average */
  ogive_body_id master; /* with OGIVE_NORMAL_MASTER. In ogive_world_set_contact -1 means: the first body of each pair */
  double friction;      /* Coulomb coefficient [-] >= 0. Default 0 */
  int32_t detection;    /* OGIVE_DETECTION_*. Default gap */
  int32_t reserved0;
  double gap_offset;    /* [-] cells, -2..2, with OGIVE_DETECTION_GAP. Default 0.3: at 0 bodies that just touch chatter */
} ogive_contact_def;
OGIVE_API void ogive_contact_def_init(ogive_contact_def* def, size_t size);
/* The rule for all pairs; call before bodies or after, but before ogive_world_prepare. */
OGIVE_API ogive_status ogive_world_set_contact(ogive_world* world, const ogive_contact_def* def);
/* Another rule, method included, for one pair (either order). */
OGIVE_API ogive_status ogive_contact_set_pair(ogive_world* world, ogive_body_id a, ogive_body_id b,
                                              const ogive_contact_def* def);
/* The methods and rules for normals that this library has, by their values from 0; names as in scenes ("huang_second"), which
 * live for ever, NULL out of range. */
OGIVE_API int32_t ogive_contact_method_count(void);
/* Name of a contact method. */
OGIVE_API const char* ogive_contact_method_name(int32_t method);
/* How many rules for normals there are. */
OGIVE_API int32_t ogive_contact_normal_count(void);
/* Name of a rule for normals. */
OGIVE_API const char* ogive_contact_normal_name(int32_t normal);

/* A rigid wall at rest: the half space beyond the plane. Bodies in front of it and rigid ones that are free meet it by
 * contact; bodies with a prescribed motion do not. What it gives is in the ledger's boundary_impulse. */
typedef struct ogive_wall_def {
  uint32_t struct_size;
  int32_t method;     /* OGIVE_CONTACT_*. Default persistent */
  double point[3];    /* [L] on the plane. Default 0 */
  double normal[3];   /* [-] towards the bodies, any length > 0. Default (0,0,1) */
  double friction;    /* Coulomb coefficient [-] >= 0. Default 0 */
  int32_t detection;  /* OGIVE_DETECTION_*. Default gap: between the body's surface at the node and the plane. Surface: no
                         body needs one, particles meet the plane itself */
  int32_t reserved0;
  double gap_offset;  /* [-] cells, -2..2. Default 0.3 */
} ogive_wall_def;
OGIVE_API void ogive_wall_def_init(ogive_wall_def* def, size_t size);
/* Adds a wall; before ogive_world_prepare. */
OGIVE_API ogive_status ogive_wall_add(ogive_world* world, const ogive_wall_def* def);

/* ------------------------------------------------------------------------------------------------------ stop conditions */

/* Besides the end time, looked at when the world is prepared and at every tenth step. The body's speed is that of its centre of
 * mass. */
typedef struct ogive_stop_def {
  uint32_t struct_size;
  ogive_body_id body;        /* the projectile; -1: no stop condition on a body. Default -1 */
  double settle_window;      /* [T] > 0: settled when, after the body has lost more than settle_tolerance of its speed, its
                                speed changes by less than settle_tolerance during this time. 0: not tested. Default 0 */
  double settle_tolerance;   /* [L/T] > 0 */
  int32_t stop_when_stopped; /* 1: also when the velocity along the initial direction has fallen to zero. Default 1 */
  int32_t stop_when_out;     /* 1: also when all its particles have left the domain. Default 1 */
  /* Of the whole world, with or without a body: the energy exchange has ended when, after it has begun, for so long neither the
   * kinetic energy of any body nor the internal energy of all nor what was dissipated so far (plastic, viscous, failure, friction,
   * transfer, contact) has changed by more than the tolerance. It has begun when internal or dissipated energy has changed by
   * more since the beginning; where no load, gravity or prescribed motion has done work also when a kinetic energy has, or when
   * bodies have pushed on each other. What only flies never ends a run. Removed particles are no change. */
  double exchange_window;    /* [T] >= 0; 0: not tested. Default 0 */
  double exchange_tolerance; /* [-] > 0, < 1: part of the initial total energy with what the host put in by setting fields;
                                never met where that is 0. Default 0.001 */
} ogive_stop_def;
OGIVE_API void ogive_stop_def_init(ogive_stop_def* def, size_t size);
/* Before ogive_world_prepare; another call replaces it. */
OGIVE_API ogive_status ogive_world_set_stop(ogive_world* world, const ogive_stop_def* def);
enum {
  OGIVE_STOP_NONE = 0,    /* still running */
  OGIVE_STOP_SETTLED = 1,
  OGIVE_STOP_STOPPED = 2,
  OGIVE_STOP_OUT = 3,
  OGIVE_STOP_EXCHANGE_ENDED = 4
};

/* -------------------------------------------------------------------------------------------------------------- running */

/* Checks the model once (bodies inside the domain, not overlapping, at least one body, consistent materials and rules)
 * and freezes it. Afterwards only stepping, state access, thread count and queries are allowed. */
OGIVE_API ogive_status ogive_world_prepare(ogive_world* world);

/* Changes of a run. Opens a prepared world's model again: until the next ogive_world_prepare, which checks the changes,
 * ogive_world_set_numerics, _set_contact, _set_stop, ogive_contact_set_pair and ogive_material_change are allowed, stepping and
 * saving are not, and queries tell of the model as it was. ogive_world_prepare refuses, because what the particles carry belongs
 * to the old value: density, elastic constants, equation of state, kind of strength, failure or thermal softening, affine
 * velocities begun or ended, the update order, and a failure strain that would make failed particles whole or whole ones failed.
 * The world then stays open and can be corrected. Without a change the run goes on to the same bits. */
OGIVE_API ogive_status ogive_world_reopen(ogive_world* world);
/* Another definition for a material of a reopened world. */
OGIVE_API ogive_status ogive_material_change(ogive_world* world, ogive_material_id material, const ogive_material_def* def);

/* What is modelled and what is left out, and why: lines of text. Writes at most capacity bytes with the final zero and
 * sets *needed to the size of the whole text with it. After ogive_world_prepare. */
OGIVE_API ogive_status ogive_world_plan(const ogive_world* world, char* text, size_t capacity, size_t* needed);

/* Largest stable time step now, Eq. (35) with the fastest wave and particle [T]. */
OGIVE_API ogive_status ogive_world_stable_time_step(const ogive_world* world, double* dt);

/* One step. dt = 0: the stable time step; otherwise the host's own, 0 < dt <= stable time step. For a host whose step is
 * longer ogive_world_advance takes as many as are needed. */
OGIVE_API ogive_status ogive_world_step(ogive_world* world, double dt);

/* Called after each step; a value other than 0 makes ogive_world_advance return OGIVE_OK at once. It may query the
 * world, save it and set loads and fields; stepping or loading it is OGIVE_ERROR_STATE, and it must not be destroyed. */
typedef int32_t (*ogive_step_callback)(ogive_world* world, void* user);
/* Steps until `time` is reached exactly (the last step is shortened), a stop condition holds, max_steps (> 0; 0: no
 * limit) steps are done or the callback asks for a stop. Stop conditions end it at once if they already hold. */
OGIVE_API ogive_status ogive_world_advance(ogive_world* world, double time, int64_t max_steps, ogive_step_callback callback,
                                           void* user);

/* Clock and size of a world. */
typedef struct ogive_progress {
  uint32_t struct_size;
  int32_t stop;              /* OGIVE_STOP_* */
  double time;               /* [T] */
  double last_time_step;     /* [T] */
  int64_t steps;             /* since the beginning, over restarts */
  int64_t particles;         /* in the domain now */
  int64_t particle_steps;    /* sum over steps of particles, over restarts */
  int64_t memory_bytes;      /* held by the world now */
  int64_t resting_particle_steps; /* part of particle_steps: left out because the particles were at rest, over restarts */
} ogive_progress;
/* struct_size must be set by the caller. Cheap: may be called each step. */
OGIVE_API ogive_status ogive_world_progress(const ogive_world* world, ogive_progress* progress);

/* ------------------------------------------------------------------------------------------------------------ results */

/* Mass, momentum and energy of the whole world. The energies of what is modelled: a half model has half of them.
 *   total    = kinetic + internal + failure_loss + left_domain_energy + dropped_energy + friction_dissipation
 *            + transfer_dissipation + contact_dissipation - external_work - prescribed_work - boundary_work
 *   residual = total - initial_total; what no term accounts for
 * contact_work is what inelastic nodal contact took from the kinetic energy of the grid. Particles lose less than that (they
 * carry motion that the grid does not see), so it is an indicator and part of no sum: compare it between runs, not with the
 * residual. */
typedef struct ogive_ledger {
  uint32_t struct_size;
  uint32_t reserved0;
  double time;                 /* [T] */
  double mass;                 /* [M] in the domain */
  double left_domain_mass;     /* [M] */
  double momentum[3];          /* [M L/T] in the domain */
  double left_domain_momentum[3]; /* [M L/T] taken along by removed particles */
  double boundary_impulse[3];  /* [M L/T] given to the material by faces, clamps, walls and what guides prescribed motion */
  double external_impulse[3];  /* by gravity, loads and forces of the host */
  double kinetic;              /* [M L2/T2] with that of the particles' affine velocities */
  double internal;             /* elastic + plastic + thermal */
  double plastic_dissipation;  /* plastic work done so far; part of internal */
  double viscous_dissipation;  /* bulk viscosity work so far; part of internal */
  double failure_loss;         /* elastic energy removed from failed particles */
  double left_domain_energy;   /* kinetic + internal of removed particles */
  double friction_dissipation; /* energy turned to heat by Coulomb friction at nodes */
  double transfer_dissipation; /* kinetic energy that affine velocities or mixing in the grid's velocity took out: motion
                                  below the grid's resolution. 0 to round-off with plain FLIP */
  double contact_work;         /* kinetic energy of the grid taken (< 0) by the normal contact forces */
  double boundary_work;        /* work of the clamps on the particles (< 0: taken from them); symmetry and fixed faces do none */
  double external_work;        /* by gravity, loads and forces of the host */
  double initial_total;        /* total when the world was prepared */
  double total;                /* the sum above */
  double residual;             /* total - initial_total */
  double residual_relative;    /* residual / initial_total (0 where that is 0) */
  double maximum_speed;        /* [L/T] fastest particle now */
  double maximum_speed_ever;   /* [L/T] fastest particle in any step so far */
  double prescribed_work;      /* by what guides the rigid bodies with prescribed motion; its impulse is in boundary_impulse */
  double angular_momentum[3];  /* [M L2/T] in the domain, about the origin, with that of affine velocities */
  double contact_couple[3];    /* [M L2/T] given to free rigid bodies because contact acts on them at the surface, and on a
                                  deformable body at the node: angular_momentum less this is what contact conserves */
  double energy_growth;        /* [-] largest growth of the energy that was seen, at every 25th step and now: residual, less what
                                  the host put in by setting fields (and with what clamps would give), divided by initial_total +
                                  largest work of loads and guides so far + what the host put in. 0: it never grew */
  double energy_growth_time;   /* [T] when that was */
  double energy_warning_time;  /* [T] when growth first passed energy_warning; -1: never */
  double contact_dissipation;  /* kinetic energy that contact took, beside friction, where total Lagrangian bodies meet each other,
                                  rigid bodies or walls: the impact of the layer of nodes that meets. There it is exactly
                                  known; what contact takes from other bodies is in the residual */
  double dropped_mass;         /* [M] of debris (drop_debris of ogive_numerics_def), when it was dropped; in no other field */
  double dropped_momentum[3];  /* [M L/T] */
  double dropped_angular_momentum[3]; /* [M L2/T] about the origin, with that of affine velocities */
  double dropped_energy;       /* kinetic + internal */
  double energy_unaccounted;   /* [-] energy_growth as it is now; < 0: a loss */
} ogive_ledger;
/* After ogive_world_prepare; a pass over all particles. struct_size must be set by the caller. */
OGIVE_API ogive_status ogive_world_ledger(const ogive_world* world, ogive_ledger* ledger);

/* Fails as a step does, with OGIVE_ERROR_NUMERICAL and the same message, where the energy is now beyond energy_limit or
 * energy_loss_limit: steps look at every 25th alone, a host at the end of its run. Changes nothing. After ogive_world_prepare; a
 * pass over all particles. */
OGIVE_API ogive_status ogive_world_check_energy(const ogive_world* world);

/* Number of bodies; ids are 0 .. number - 1. 0 for a NULL world. */
OGIVE_API int32_t ogive_body_count(const ogive_world* world);
/* Name of a body; lives as long as the world. NULL if the id is unknown. */
OGIVE_API const char* ogive_body_name(const ogive_world* world, ogive_body_id body);
/* The body of that name; OGIVE_ERROR_ARGUMENT if there is none. */
OGIVE_API ogive_status ogive_body_find(const ogive_world* world, const char* name, ogive_body_id* body);

/* A body as a whole. */
typedef struct ogive_body_result {
  uint32_t struct_size;
  uint32_t reserved0;
  int64_t particles;            /* in the domain */
  int64_t failed_particles;     /* failed so far, whether still in the domain or not */
  int64_t left_domain;          /* removed at free faces */
  double mass;                  /* [M] in the domain */
  double failed_mass;           /* [M] */
  double left_domain_mass;      /* [M] */
  double first_failure_time;    /* [T], -1 if none failed */
  double failure_loss;          /* [M L2/T2] */
  double centre[3];             /* [L] centre of mass */
  double momentum[3];           /* [M L/T] */
  double velocity[3];           /* [L/T] momentum / mass */
  double speed;                 /* [L/T] |velocity| */
  double initial_speed;         /* [L/T] */
  double kinetic;               /* [M L2/T2] */
  double internal;              /* [M L2/T2] */
  double contact_force[3];      /* [M L/T2] on the body in the last step */
  double lower[3];              /* [L] bounding box of particle centres */
  double upper[3];              /* [L] */
  double maximum_plastic_strain;/* [-] */
  double maximum_temperature;   /* [K], 0 where none is kept */
  double angular_momentum[3];   /* [M L2/T] about `centre` */
  double angular_velocity[3];   /* [1/T] of a rigid body, otherwise 0 */
  int32_t formulation;          /* OGIVE_FORMULATION_* now: a total Lagrangian body that was too distorted is deformable */
  int32_t reserved1;
  int64_t dropped_particles;    /* dropped as debris; not among those that left the domain */
  double dropped_mass;          /* [M] */
} ogive_body_result;
/* After ogive_world_prepare; a pass over the particles of the body. struct_size must be set by the caller. */
OGIVE_API ogive_status ogive_body_result_get(const ogive_world* world, ogive_body_id body, ogive_body_result* result);

/* What a load has done. */
typedef struct ogive_load_result {
  uint32_t struct_size;
  uint32_t reserved0;
  double value[3];   /* as it is now */
  double force[3];   /* [M L/T2] of the load on the material in the last step: with velocity, what holds it */
  double impulse[3]; /* [M L/T] so far */
  double work;       /* [M L2/T2] so far */
} ogive_load_result;
/* After ogive_world_prepare. */
OGIVE_API ogive_status ogive_load_result_get(const ogive_world* world, ogive_load_id load, ogive_load_result* result);

/* Contact between two bodies. */
typedef struct ogive_pair_result {
  uint32_t struct_size;
  uint32_t reserved0;
  double force[3];             /* [M L/T2] of b on a in the last step */
  double impulse[3];           /* [M L/T] of b on a so far */
  double friction_dissipation; /* [M L2/T2] so far, as in ogive_ledger */
  double contact_work;         /* [M L2/T2] so far, as in ogive_ledger */
} ogive_pair_result;
/* Contact between two bodies, in either order: all zero until they touch. With the single-field method there is none. */
OGIVE_API ogive_status ogive_pair_result_get(const ogive_world* world, ogive_body_id a, ogive_body_id b,
                                             ogive_pair_result* result);

/* Particle fields by name. Values are ordered by particle number (the order in which the body's particles were given,
 * those cut off at symmetry planes or removed left out), components of a particle together. All are double.
 *   position 3, velocity 3, mass 1, volume 1 (current), stress 6 (xx yy zz yz xz xy, tension positive),
 *   pressure 1, von_mises 1, energy 1 (internal, per particle), plastic_strain 1, temperature 1, failed 1 (0 or 1),
 *   number 1 (0-based particle number), deformation_gradient 9 (row by row), affine_velocity 9 (dv_i/dx_j of the particle's
 *   own velocity field, row by row; its kinetic energy is mass h^2/8 times the sum of the squares),
 *   volume_ratio 1 (current by initial volume), force 3 [M L/T2] (the host's on each particle, once it was set)
 * A body has only the fields that its material and the transfer need (a rigid one position, velocity, mass, volume and
 * number): asking for another is OGIVE_ERROR_ARGUMENT. */
OGIVE_API int32_t ogive_field_count(const ogive_world* world, ogive_body_id body);
/* Name (lives as long as the world) and components of field `index`, NULL if out of range. */
OGIVE_API const char* ogive_field_name(const ogive_world* world, ogive_body_id body, int32_t index, int32_t* components);
/* Copies field `name` of all particles of a body now in the domain; count: the number of doubles that `values` holds,
 * which must be particles * components. */
OGIVE_API ogive_status ogive_field_get(const ogive_world* world, ogive_body_id body, const char* name, double* values,
                                       int64_t count);
/* Sets position (inside the domain), velocity, affine_velocity, stress, energy, plastic_strain (>= 0), temperature (>= 0),
 * volume_ratio (> 0), deformation_gradient (determinant > 0) or force in the same layout; all values finite. Setting one leaves
 * the others as they are: who sets velocity may want to set affine_velocity too. A force acts in every step until it is set
 * anew; its impulse and work are part of the ledger's external ones. Of a total Lagrangian body velocity (its nodes take the
 * mean of what their particles have), energy, temperature and force can be set. */
OGIVE_API ogive_status ogive_field_set(ogive_world* world, ogive_body_id body, const char* name, const double* values,
                                       int64_t count);

/* A field where the engine keeps it, without a copy. Particles are in the engine's order, some places being padding. */
typedef struct ogive_field_view {
  uint32_t struct_size;
  int32_t components;          /* of the field */
  int64_t places;              /* particles and padding */
  int64_t stride;              /* doubles from one place to the next */
  const double* component[9];  /* value c of place i: component[c][i * stride]; NULL beyond `components` */
  const int32_t* number;       /* particle number of each place, -1: padding, whose values mean nothing */
} ogive_field_view;
/* For position, velocity, mass, stress, plastic_strain, temperature, volume_ratio, deformation_gradient, affine_velocity and
 * force; the other fields are computed when they are asked for, so that viewing them is OGIVE_ERROR_ARGUMENT. The pointers live
 * until the world is stepped, advanced, loaded, destroyed or one of its fields is set. struct_size must be set by the caller. */
OGIVE_API ogive_status ogive_field_view_get(const ogive_world* world, ogive_body_id body, const char* name,
                                            ogive_field_view* view);

/* ------------------------------------------------------------------------------------------------- save and load a world */

/* Bytes that a host keeps with the world and that travel in every save: name 1..63 characters; size 0 removes it. */
OGIVE_API ogive_status ogive_world_attach(ogive_world* world, const char* name, const void* data, int64_t size);
/* *data lives until the attachment changes. OGIVE_ERROR_ARGUMENT if there is none of that name. */
OGIVE_API ogive_status ogive_world_attachment(const ogive_world* world, const char* name, const void** data, int64_t* size);

/* A save is a set of named arrays ("model/..." what a step only reads, "state/..." all that it changes, "attachment/...").
 * The host (or the library ogive_io) writes them where it likes. Element types: */
enum { OGIVE_TYPE_FLOAT64 = 1, OGIVE_TYPE_INT32 = 2, OGIVE_TYPE_INT64 = 3, OGIVE_TYPE_UINT8 = 4 };
/* Where a world is saved to. */
typedef struct ogive_writer {
  uint32_t struct_size;
  uint32_t reserved0;
  void* user;                  /* given to put */
  /* Takes one array of `count` elements; data lives during the call. Not OGIVE_OK: the save ends with that status. */
  ogive_status (*put)(void* user, const char* name, int32_t type, int64_t count, const void* data);
} ogive_writer;
/* Where a saved world is read from. */
typedef struct ogive_reader {
  uint32_t struct_size;
  uint32_t reserved0;
  void* user;                  /* given to find and get */
  /* Type and element count of a named array; OGIVE_ERROR_FORMAT if there is none. */
  ogive_status (*find)(void* user, const char* name, int32_t* type, int64_t* count);
  /* Copies it; `count` is what find said. */
  ogive_status (*get)(void* user, const char* name, int64_t count, void* data);
} ogive_reader;
/* Puts every array in turn; after ogive_world_prepare. The world is not changed. */
OGIVE_API ogive_status ogive_world_save(const ogive_world* world, const ogive_writer* writer);
/* Into a world fresh from ogive_world_create. Afterwards it is prepared and continues to the same bits as the saved one.
 * On failure the world is as fresh as before. Every count is checked against the model before memory is taken. */
OGIVE_API ogive_status ogive_world_load(ogive_world* world, const ogive_reader* reader);

/* ------------------------------------------------------------------------------------- files (link the library ogive_io) */

/* HDF5 checkpoint (docs/formats.md): written under a temporary name in the same directory, flushed to disk and renamed, so
 * that `path` is either the old file, whole, or the new one, whole. */
OGIVE_API ogive_status ogive_checkpoint_write(ogive_world* world, const char* path);
/* Into a fresh world; every checksum is verified first. */
OGIVE_API ogive_status ogive_checkpoint_read(ogive_world* world, const char* path);
/* Checks a checkpoint or particle file without loading it: all datasets readable and their checksums right. Writes one line
 * per finding into text as ogive_world_plan does. OGIVE_OK: undamaged. */
OGIVE_API ogive_status ogive_file_verify(const char* path, char* text, size_t capacity, size_t* needed);
/* What the file is and holds: lines of text. */
OGIVE_API ogive_status ogive_file_info(const char* path, char* text, size_t capacity, size_t* needed);
/* ogive_body_add_particles from a text file of lines x,y,z,volume; empty lines, lines that begin with # and one heading before
 * the first numbers are skipped. OGIVE_ERROR_FILE: it cannot be read; OGIVE_ERROR_FORMAT: the message names the line. */
OGIVE_API ogive_status ogive_body_add_particle_file(ogive_world* world, const char* name, const ogive_body_def* def,
                                                    const char* path, ogive_body_id* id);
/* Particles of all bodies now, as an HDF5 file of groups /<body>/<field>; atomic as a checkpoint. */
OGIVE_API ogive_status ogive_particles_write(ogive_world* world, const char* path);
/* An XDMF time series over `count` such files (paths relative to the XDMF file), for ParaView; atomic. The counts and fields
 * are read from the files. */
OGIVE_API ogive_status ogive_series_write(ogive_world* world, const char* path, int32_t count, const char* const* files);

#ifdef __cplusplus
}
#endif
#endif
