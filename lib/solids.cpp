// Built-in solids filled with particles.
//
// Cartesian lattice: across the axis, and along it where the solid has no flat ends, centres lie at (i + 1/2) spacing
// from the symmetry planes (from the tip of an ogive rod); a box's edges and a cylinder's length are divided into the
// nearest whole number of particles. A centre belongs to the solid when its distance from the axis is at most the
// radius there. All volumes are equal: exact volume / count.
//
// Polar lattice: layers of thickness dr = (R - r_i) / n_r, each of n_t sectors dt = 2 pi / n_t and height dz. A
// particle sits at the layer's mean radius r, half a step from the planes x = 0 and y = 0, and has the sector's exact
// volume (r_out^2 - r_in^2) dt dz / 2 = r dr dt dz.
//
// Volumes: box a b c; cylinder pi (R^2 - r_i^2) l; sphere 4/3 pi R^3; ogive rod: the shank's pi R^2 (l - L) and the
// nose's pi [rho^2 (L - a asin(L / rho)) - L^3 / 3], a = rho - R, the integral of pi r(d)^2 over the nose.
//
// Only one quadrant (octant) is computed, and copied with the signs changed: mirror symmetry is exact.
#include "solids.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <utility>

#include "error.hpp"

namespace ogive {
namespace {

using Vector = std::array<double, 3>;

constexpr long double pi = 3.141592653589793238462643383279502884L;

// A centre exactly on the surface belongs to the solid however its coordinates were rounded.
constexpr double surface_tolerance = 1e-12;

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

std::string vector(const Vector& v) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.12g, %.12g, %.12g)", v[0], v[1], v[2]);
  return text;
}

[[noreturn]] void refuse(const std::string& field, const std::string& expectation, const std::string& value) {
  throw Error(ErrorKind::Argument, "solid." + field + ": must " + expectation + ", got " + value);
}

[[noreturn]] void refuse_count() {
  throw Error(ErrorKind::Argument,
              "solid.spacing: must give at most 2147483648 particles, got more: use a larger spacing");
}

std::string element(const char* field, int i) { return std::string(field) + "[" + std::to_string(i) + "]"; }

void require_positive(const char* field, const Vector& v, int i) {
  if (!(v[i] > 0.0)) refuse(element(field, i), "be > 0", number(v[i]));
  if (!std::isfinite(v[i])) refuse(element(field, i), "be > 0 and finite", number(v[i]));
}

void require_finite(const char* field, const Vector& v) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(v[i])) refuse(element(field, i), "be finite", number(v[i]));
  }
}

void validate_size(const SolidDef& solid) {
  const Vector& size = solid.size;
  switch (solid.shape) {
    case SolidShape::Box:
      for (int i = 0; i < 3; ++i) require_positive("size", size, i);
      return;
    case SolidShape::Cylinder:
      require_positive("size", size, 0);
      require_positive("size", size, 1);
      if (!(size[2] >= 0.0 && size[2] < size[0])) {
        refuse("size[2]", "be >= 0 and < size[0] = " + number(size[0]), number(size[2]));
      }
      return;
    case SolidShape::Sphere:
      require_positive("size", size, 0);
      return;
    case SolidShape::OgiveRod: {
      require_positive("size", size, 0);
      require_positive("size", size, 1);
      if (!(size[2] >= 0.5) || !std::isfinite(size[2])) refuse("size[2]", "be >= 0.5", number(size[2]));
      const double nose = ogive_nose_length(size[0], size[2]);
      if (!(size[1] >= nose)) refuse("size[1]", "be >= the nose length " + number(nose), number(size[1]));
      return;
    }
  }
  refuse("solid", "be 0 (box), 1 (cylinder), 2 (sphere) or 3 (ogive rod)",
         std::to_string(static_cast<std::int32_t>(solid.shape)));
}

void validate(const SolidDef& solid) {
  validate_size(solid);
  if (solid.lattice != Lattice::Cartesian && solid.lattice != Lattice::Polar) {
    refuse("lattice", "be 0 (Cartesian) or 1 (polar)", std::to_string(static_cast<std::int32_t>(solid.lattice)));
  }
  if (solid.lattice == Lattice::Polar && solid.shape != SolidShape::Cylinder) {
    refuse("lattice", "be 0 (Cartesian) for a solid that is not a cylinder", "1 (polar)");
  }
  require_finite("centre", solid.centre);
  require_finite("axis", solid.axis);
  require_finite("reference", solid.reference);
  for (int i = 0; i < 3; ++i) require_positive("spacing", solid.spacing, i);
  const double volume = exact_volume(solid);
  if (!(volume > 0.0) || !std::isfinite(volume)) {
    refuse("size", "give a volume that a double holds", vector(solid.size));
  }
}

// ------------------------------------------------------------------------------------------------------ the solid's
// axes

struct Axes {
  Vector x, y, z;
};

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Of length 1; scaled first, so that no square overflows or vanishes.
Vector unit(Vector v) {
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  for (double& component : v) component /= largest;
  const double length = std::sqrt(dot(v, v));
  for (double& component : v) component /= length;
  return v;
}

Axes axes_of(const SolidDef& solid) {
  const Vector zero{};
  if (solid.axis == zero) refuse("axis", "not be zero", vector(solid.axis));
  const Vector z = unit(solid.axis);
  if (solid.reference != zero) {
    Vector x = unit(solid.reference);
    const double along = dot(x, z);
    for (int i = 0; i < 3; ++i) x[i] -= along * z[i];
    if (std::sqrt(dot(x, x)) < 1e-8) refuse("reference", "not be parallel to axis", vector(solid.reference));
    x = unit(x);
    return {x, {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]}, z};
  }
  const double across = z[0] * z[0] + z[1] * z[1];
  if (across == 0.0) {
    // +z: as it is; -z: half a turn about y.
    return {{z[2] > 0.0 ? 1.0 : -1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, z[2]}};
  }
  // The least turn of z to the axis: I + [v]x + [v]x^2 / (1 + cos), v = z cross axis. 1 / (1 + cos) = (1 - cos) / sin^2
  // is taken in the form that does not cancel.
  const double k = z[2] >= 0.0 ? 1.0 / (1.0 + z[2]) : (1.0 - z[2]) / across;
  return {{1.0 - k * z[0] * z[0], -k * z[0] * z[1], -z[0]}, {-k * z[0] * z[1], 1.0 - k * z[1] * z[1], -z[1]}, z};
}

// ------------------------------------------------------------------------------------------------------------ counting

// Refuses what does not fit an index.
std::int64_t whole(double count) {
  if (!(count <= static_cast<double>(max_solid_particles))) refuse_count();
  return static_cast<std::int64_t>(count);
}

// Nearest whole number of particles in a length, at least one.
std::int64_t divisions(double length, double spacing) {
  return std::max<std::int64_t>(1, whole(std::round(length / spacing)));
}

std::int64_t product(std::int64_t a, std::int64_t b) { return whole(static_cast<double>(a) * static_cast<double>(b)); }

// The i-th of n equal cells that fill a length symmetrically about 0: exactly the negative of the (n-1-i)-th.
double centred(std::int64_t i, std::int64_t n, double step) {
  return static_cast<double>(2 * i + 1 - n) * (0.5 * step);
}

double half_step(std::int64_t i, double spacing) { return (static_cast<double>(i) + 0.5) * spacing; }

// ------------------------------------------------------------------------------------------------------------- filling

// Takes the particles of a solid in its own axes; one that only counts and one that stores.
class Counter {
 public:
  // A row of particles at x = (i + 1/2) step for first <= i < end and at the mirror images of these.
  void mirrored_row(std::int64_t first, std::int64_t end, double, double, double) { add(2 * (end - first)); }
  void add(std::int64_t more) {
    count_ += more;
    if (count_ > max_solid_particles) refuse_count();
  }
  std::int64_t count() const { return count_; }

 private:
  std::int64_t count_ = 0;
};

class Filler {
 public:
  Filler(const SolidDef& solid, std::int64_t count) : axes_(axes_of(solid)), centre_(solid.centre) {
    cloud_.xyz.reserve(static_cast<std::size_t>(3 * count));
    cloud_.volume.reserve(static_cast<std::size_t>(count));
  }
  void mirrored_row(std::int64_t first, std::int64_t end, double step, double y, double z) {
    for (std::int64_t i = end - 1; i >= first; --i) put(-half_step(i, step), y, z, volume_of_each_);
    for (std::int64_t i = first; i < end; ++i) put(half_step(i, step), y, z, volume_of_each_);
  }
  void put(double x, double y, double z, double volume) {
    for (int i = 0; i < 3; ++i) {
      cloud_.xyz.push_back(centre_[i] + (x * axes_.x[i] + y * axes_.y[i] + z * axes_.z[i]));
    }
    cloud_.volume.push_back(volume);
  }
  void set_volume_of_each(double volume) { volume_of_each_ = volume; }
  ParticleCloud take() { return std::move(cloud_); }

 private:
  const Axes axes_;
  const Vector centre_;
  double volume_of_each_ = 0.0;
  ParticleCloud cloud_;
};

// How many centres (i + 1/2) step, i >= 0, have x^2 + y^2 <= limit.
std::int64_t centres_within(double limit, double y, double step) {
  const auto within = [&](std::int64_t i) { return half_step(i, step) * half_step(i, step) + y * y <= limit; };
  std::int64_t count = whole(std::sqrt(std::max(0.0, limit - y * y)) / step + 0.5);
  while (within(count)) ++count;
  while (count > 0 && !within(count - 1)) --count;
  return count;
}

// The particles of one slice across the axis: inner <= r <= outer.
template <class Sink>
void disc(const SolidDef& solid, double outer, double inner, double z, Sink& sink) {
  const double within_outer = outer * outer * (1.0 + surface_tolerance);
  const double within_hole = inner > 0.0 ? inner * inner * (1.0 - surface_tolerance) : -1.0;
  const std::int64_t rows = centres_within(within_outer, 0.0, solid.spacing[1]);
  const auto row = [&](double y) {
    const std::int64_t end = centres_within(within_outer, y, solid.spacing[0]);
    const std::int64_t first = within_hole > y * y ? centres_within(within_hole, y, solid.spacing[0]) : 0;
    if (end > first) sink.mirrored_row(first, end, solid.spacing[0], y, z);
  };
  for (std::int64_t j = rows - 1; j >= 0; --j) row(-half_step(j, solid.spacing[1]));
  for (std::int64_t j = 0; j < rows; ++j) row(half_step(j, solid.spacing[1]));
}

template <class Sink>
void cartesian_cylinder(const SolidDef& solid, Sink& sink) {
  const std::int64_t slices = divisions(solid.size[1], solid.spacing[2]);
  const double step = solid.size[1] / static_cast<double>(slices);
  for (std::int64_t k = 0; k < slices; ++k) disc(solid, solid.size[0], solid.size[2], centred(k, slices, step), sink);
}

template <class Sink>
void sphere(const SolidDef& solid, Sink& sink) {
  const double radius = solid.size[0], step = solid.spacing[2];
  const auto slice = [&](double z) {
    const double square = radius * radius - z * z;
    disc(solid, std::sqrt(std::max(0.0, square)), 0.0, z, sink);
  };
  const std::int64_t slices = centres_within(radius * radius * (1.0 + surface_tolerance), 0.0, step);
  for (std::int64_t k = slices - 1; k >= 0; --k) slice(-half_step(k, step));
  for (std::int64_t k = 0; k < slices; ++k) slice(half_step(k, step));
}

template <class Sink>
void ogive_rod(const SolidDef& solid, Sink& sink) {
  const double length = solid.size[1], step = solid.spacing[2];
  const std::int64_t slices = centres_within(length * length * (1.0 + surface_tolerance), 0.0, step);
  for (std::int64_t k = slices - 1; k >= 0; --k) {
    const double distance = half_step(k, step);
    disc(solid, ogive_radius_at(solid.size[0], solid.size[2], distance), 0.0, -distance, sink);
  }
}

template <class Sink>
void cartesian_revolved(const SolidDef& solid, Sink& sink) {
  if (solid.shape == SolidShape::Cylinder) return cartesian_cylinder(solid, sink);
  if (solid.shape == SolidShape::Sphere) return sphere(solid, sink);
  ogive_rod(solid, sink);
}

ParticleCloud fill_cartesian_revolved(const SolidDef& solid) {
  // Far too many: refused without counting them row by row.
  const double estimate = exact_volume(solid) / solid.spacing[0] / solid.spacing[1] / solid.spacing[2];
  if (!(estimate < 4.0 * static_cast<double>(max_solid_particles))) refuse_count();
  Counter counter;
  cartesian_revolved(solid, counter);
  if (counter.count() == 0) {
    refuse("spacing", "leave at least one particle centre inside the solid", vector(solid.spacing));
  }
  Filler filler(solid, counter.count());
  filler.set_volume_of_each(exact_volume(solid) / static_cast<double>(counter.count()));
  cartesian_revolved(solid, filler);
  return filler.take();
}

ParticleCloud fill_box(const SolidDef& solid) {
  std::array<std::int64_t, 3> n;
  Vector step;
  for (int i = 0; i < 3; ++i) {
    n[i] = divisions(solid.size[i], solid.spacing[i]);
    step[i] = solid.size[i] / static_cast<double>(n[i]);
  }
  const std::int64_t count = product(product(n[0], n[1]), n[2]);
  const double volume = exact_volume(solid) / static_cast<double>(count);
  Filler filler(solid, count);
  for (std::int64_t k = 0; k < n[2]; ++k) {
    for (std::int64_t j = 0; j < n[1]; ++j) {
      for (std::int64_t i = 0; i < n[0]; ++i) {
        filler.put(centred(i, n[0], step[0]), centred(j, n[1], step[1]), centred(k, n[2], step[2]), volume);
      }
    }
  }
  return filler.take();
}

// One layer of a polar lattice: the first quadrant's sectors; the other quadrants mirror them.
struct PolarLayer {
  std::int64_t sectors_per_quadrant;
  double volume;             // of one sector of one slice
  std::vector<double> x, y;  // of the first quadrant
};

std::vector<PolarLayer> polar_layers(const SolidDef& solid, std::int64_t slices, std::int64_t& count) {
  const double outer = solid.size[0], inner = solid.size[2];
  const std::int64_t layers = divisions(outer - inner, solid.spacing[0]);
  const double thickness = (outer - inner) / static_cast<double>(layers);
  const double height = solid.size[1] / static_cast<double>(slices);
  // A ring has one number of sectors, that of its mean radius: its particles form straight radial lines. Towards the
  // axis of a solid cylinder that would end in slivers, so each layer there has its own.
  const auto quarter_count = [&](double radius) {
    return divisions(static_cast<double>(pi / 2) * radius, solid.spacing[1]);
  };
  const auto radius_of = [&](std::int64_t layer) { return inner + half_step(layer, thickness); };
  const auto sectors_of = [&](std::int64_t layer) {
    return quarter_count(inner > 0.0 ? 0.5 * (inner + outer) : radius_of(layer));
  };
  Counter counter;
  for (std::int64_t layer = 0; layer < layers; ++layer) counter.add(product(4 * sectors_of(layer), slices));
  count = counter.count();

  std::vector<PolarLayer> result;
  result.reserve(static_cast<std::size_t>(layers));
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    const double radius = radius_of(layer);
    PolarLayer& added = result.emplace_back();
    added.sectors_per_quadrant = sectors_of(layer);
    const double step = static_cast<double>(pi / 2 / static_cast<long double>(added.sectors_per_quadrant));
    added.volume = radius * thickness * step * height;
    for (std::int64_t j = 0; j < added.sectors_per_quadrant; ++j) {
      added.x.push_back(radius * std::cos(half_step(j, step)));
      added.y.push_back(radius * std::sin(half_step(j, step)));
    }
  }
  return result;
}

ParticleCloud fill_polar(const SolidDef& solid) {
  const std::int64_t slices = divisions(solid.size[1], solid.spacing[2]);
  std::int64_t count = 0;
  const std::vector<PolarLayer> layers = polar_layers(solid, slices, count);
  const double height = solid.size[1] / static_cast<double>(slices);
  Filler filler(solid, count);
  for (std::int64_t k = 0; k < slices; ++k) {
    const double z = centred(k, slices, height);
    for (const PolarLayer& layer : layers) {
      const std::size_t n = layer.x.size();
      for (std::size_t j = 0; j < n; ++j) filler.put(layer.x[j], layer.y[j], z, layer.volume);
      for (std::size_t j = n; j-- > 0;) filler.put(-layer.x[j], layer.y[j], z, layer.volume);
      for (std::size_t j = 0; j < n; ++j) filler.put(-layer.x[j], -layer.y[j], z, layer.volume);
      for (std::size_t j = n; j-- > 0;) filler.put(layer.x[j], -layer.y[j], z, layer.volume);
    }
  }
  return filler.take();
}

}  // namespace

double ogive_nose_length(double radius, double caliber_radius_head) {
  return radius * std::sqrt(4.0 * caliber_radius_head - 1.0);
}

double ogive_radius_at(double radius, double caliber_radius_head, double distance) {
  if (distance <= 0.0) return 0.0;
  const double to_shank = ogive_nose_length(radius, caliber_radius_head) - distance;
  if (to_shank <= 0.0) return radius;
  const double arc = 2.0 * caliber_radius_head * radius;
  return std::max(0.0, std::sqrt(arc * arc - to_shank * to_shank) - (arc - radius));
}

std::array<std::array<double, 3>, 3> solid_axes(const SolidDef& solid) {
  validate(solid);
  const Axes axes = axes_of(solid);
  return {axes.x, axes.y, axes.z};
}

double exact_volume(const SolidDef& solid) {
  validate_size(solid);
  const auto [a, b, c] = solid.size;
  switch (solid.shape) {
    case SolidShape::Box:
      return a * b * c;
    case SolidShape::Cylinder:
      return static_cast<double>(pi * (static_cast<long double>(a) - c) * (static_cast<long double>(a) + c) * b);
    case SolidShape::Sphere:
      return static_cast<double>(pi * 4 / 3 * a * a * a);
    case SolidShape::OgiveRod:
      break;
  }
  // The two terms of the nose nearly cancel for a long one: in long double.
  const long double radius = a, arc = 2.0L * c * radius, nose = radius * std::sqrt(4.0L * c - 1.0L);
  const long double nose_volume =
      arc * arc * (nose - (arc - radius) * std::asin(std::min(1.0L, nose / arc))) - nose * nose * nose / 3;
  return static_cast<double>(pi * (nose_volume + radius * radius * (b - nose)));
}

ParticleCloud fill_solid(const SolidDef& solid) {
  validate(solid);
  axes_of(solid);  // refuses a bad direction before the counting
  try {
    if (solid.shape == SolidShape::Box) return fill_box(solid);
    if (solid.lattice == Lattice::Polar) return fill_polar(solid);
    return fill_cartesian_revolved(solid);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Memory,
                "solid.spacing: must leave the particles room in memory, got " + vector(solid.spacing));
  }
}

}  // namespace ogive
