// Mirror planes of a scene.
//
// Cheap questions first: faces, gravity, motion, walls, clamps, centres of mass. Then the particles themselves: each must have
// a partner of the same volume at its mirror image. That sees whatever makes a body unsymmetric, however it was made: a hole, a
// mesh, a list of particles, a lattice that is not the same on both sides.
#include "mirror.hpp"

#include <ogive.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "build.hpp"
#include "text.hpp"

namespace driver {
namespace {

constexpr double kTolerance = 1e-6;  // of a cell: places of particles that count as the same
constexpr size_t kSample = 50000;
constexpr double kVolumeTolerance = 1e-6;

std::string quoted(const std::string& name) { return '"' + name + '"'; }
std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

/// Centre of volume, which is that of mass.
Vector3 centre_of(const ParticleList& particles) {
  Vector3 moment{};
  double volume = 0;
  for (size_t p = 0; p < particles.volumes.size(); ++p) {
    volume += particles.volumes[p];
    for (size_t c = 0; c < 3; ++c) moment[c] += particles.volumes[p] * particles.positions[3 * p + c];
  }
  for (double& coordinate : moment) coordinate /= volume;
  return moment;
}

/// Particles by place, to be found within a tolerance that is far below their distances.
class Places {
 public:
  Places(ParticleList particles, double cell, double tolerance)
      : particles_(std::move(particles)), cell_(cell), tolerance_(tolerance) {
    boxes_.reserve(particles_.volumes.size());
    for (size_t p = 0; p < particles_.volumes.size(); ++p) boxes_.push_back({key({box_of(p, 0), box_of(p, 1), box_of(p, 2)}), p});
    std::sort(boxes_.begin(), boxes_.end());
  }

  const ParticleList& particles() const { return particles_; }

  /// The particle at a place, -1 if there is none.
  int64_t find(const std::array<double, 3>& place) const {
    std::array<std::array<int64_t, 2>, 3> range;
    for (size_t c = 0; c < 3; ++c)
      range[c] = {box(place[c] - tolerance_), box(place[c] + tolerance_)};
    for (int64_t i = range[0][0]; i <= range[0][1]; ++i)
      for (int64_t j = range[1][0]; j <= range[1][1]; ++j)
        for (int64_t k = range[2][0]; k <= range[2][1]; ++k) {
          const uint64_t wanted = key({i, j, k});
          for (auto at = std::lower_bound(boxes_.begin(), boxes_.end(), std::pair<uint64_t, size_t>{wanted, 0});
               at != boxes_.end() && at->first == wanted; ++at) {
            const double* x = &particles_.positions[3 * at->second];
            if (std::abs(x[0] - place[0]) <= tolerance_ && std::abs(x[1] - place[1]) <= tolerance_ &&
                std::abs(x[2] - place[2]) <= tolerance_)
              return static_cast<int64_t>(at->second);
          }
        }
    return -1;
  }

 private:
  int64_t box(double coordinate) const { return static_cast<int64_t>(std::floor(coordinate / cell_)); }
  int64_t box_of(size_t particle, size_t axis) const { return box(particles_.positions[3 * particle + axis]); }
  static uint64_t key(const std::array<int64_t, 3>& box) {
    uint64_t value = 0;
    for (const int64_t index : box) value = value * 0x9E3779B97F4A7C15U + static_cast<uint64_t>(index);
    return value ^ (value >> 31);
  }

  ParticleList particles_;
  double cell_, tolerance_;
  std::vector<std::pair<uint64_t, size_t>> boxes_;  // key of its box and number, of each particle, by key
};

bool nearly(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

/// What of a motion is not the same behind the plane; "" if nothing.
std::string unsymmetric_motion(const Vector3& velocity, const Vector3& angular_velocity, int axis) {
  const auto across = static_cast<size_t>(axis);
  if (velocity[across] != 0) return "has the velocity " + brief(velocity[across]) + " along " + axis_name(axis);
  for (size_t c = 0; c < 3; ++c)
    if (c != across && angular_velocity[c] != 0) return "turns about " + axis_name(static_cast<int>(c));
  return "";
}

/// Whether two clamps, or one and itself, are each other's mirror image.
bool are_images(const ClampScene& a, const ClampScene& b, int axis, double at, double tolerance) {
  if (a.region != b.region || a.body != b.body || a.axes != b.axes || a.radius != b.radius) return false;
  const bool box = a.region == OGIVE_REGION_BOX;
  bool same = true, opposite = true;  // directions of cylinders
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<size_t>(c);
    const double sign = c == axis ? -1 : 1, shift = c == axis ? 2 * at : 0;
    const double lower = box && c == axis ? b.b[i] : b.a[i], upper = box && c == axis ? b.a[i] : b.b[i];
    if (!nearly(a.a[i], shift + sign * lower, tolerance)) return false;
    if (box && !nearly(a.b[i], shift + sign * upper, tolerance)) return false;
    same = same && nearly(a.b[i], sign * b.b[i], 1e-12);
    opposite = opposite && nearly(a.b[i], -sign * b.b[i], 1e-12);
  }
  return box || same || opposite;
}

/// What moves or pulls across a plane with this normal, wherever it lies; "" if nothing.
std::string motion_across(const Scene& scene, int axis) {
  const auto across = static_cast<size_t>(axis);
  if (scene.grid.faces[2 * across] != scene.grid.faces[2 * across + 1]) return "one face of the domain is fixed, the other free";
  if (scene.numerics.gravity[across] != 0) return "gravity pulls along " + axis_name(axis);
  for (const BodyScene& body : scene.bodies) {
    std::string problem = unsymmetric_motion(body.velocity, body.angular_velocity, axis);
    for (const MotionScene& knot : body.motion)
      if (problem.empty()) problem = unsymmetric_motion(knot.velocity, knot.angular_velocity, axis);
    if (!problem.empty()) return "body " + quoted(body.name) + ' ' + problem;
  }
  for (size_t i = 0; i < scene.walls.size(); ++i)
    if (std::abs(scene.walls[i].normal[across]) > 1e-12)
      return "wall " + std::to_string(i) + " looks along " + axis_name(axis);
  return "";
}

/// What of the scene's places is not the same on both sides of the plane; "" if nothing.
std::string unsymmetric_places(const Scene& scene, int axis, double at) {
  const auto across = static_cast<size_t>(axis);
  const GridScene& grid = scene.grid;
  const double tolerance = kTolerance * grid.cell_size;
  if (grid.faces[2 * across] == OGIVE_FACE_FIXED && !nearly(at, 0.5 * (grid.lower[across] + grid.upper[across]), tolerance))
    return "the fixed faces are not equally far from body " + quoted(scene.bodies[0].name);
  for (size_t i = 0; i < scene.clamps.size(); ++i) {
    const auto is_image = [&](const ClampScene& other) { return are_images(scene.clamps[i], other, axis, at, tolerance); };
    if (std::none_of(scene.clamps.begin(), scene.clamps.end(), is_image))
      return "clamp " + std::to_string(i) + " has no mirror image";
  }
  for (const BodyScene& body : scene.bodies) {
    if (!body.coarse) continue;
    const Vector3 &from = body.coarse->from, &to = body.coarse->to;
    bool same = true, swapped = true;  // each end its own image, or each the other's
    for (size_t c = 0; c < 3; ++c) {
      const auto image = [&](double x) { return c == across ? 2 * at - x : x; };
      same = same && nearly(image(from[c]), from[c], tolerance) && nearly(image(to[c]), to[c], tolerance);
      swapped = swapped && nearly(image(from[c]), to[c], tolerance);
    }
    if (!same && !swapped) return "body " + quoted(body.name) + " is not coarse in the same way on both sides";
  }
  return "";
}

/// What of a body's particles is not the same on both sides of the plane; "" if nothing.
std::string unsymmetric_particles(const Places& places, int axis, double at, size_t step) {
  const ParticleList& particles = places.particles();
  const auto across = static_cast<size_t>(axis);
  for (size_t p = 0; p < particles.volumes.size(); p += step) {
    const double* x = &particles.positions[3 * p];
    std::array<double, 3> image{x[0], x[1], x[2]};
    image[across] = 2 * at - image[across];
    const int64_t partner = places.find(image);
    const bool same_volume = partner >= 0 && nearly(particles.volumes[static_cast<size_t>(partner)], particles.volumes[p],
                                                    kVolumeTolerance * particles.volumes[p]);
    if (same_volume) continue;
    return std::string(partner < 0 ? "has nothing" : "has another volume") + " at the mirror image of its particle at (" +
           brief(x[0]) + ", " + brief(x[1]) + ", " + brief(x[2]) + ')';
  }
  return "";
}

}  // namespace

std::vector<MirrorPlane> mirror_planes(const Scene& scene, bool thorough) {
  const GridScene& grid = scene.grid;
  const double tolerance = kTolerance * grid.cell_size;
  std::vector<MirrorPlane> planes;
  const int axes = grid.space == OGIVE_SPACE_THREE_DIMENSIONAL ? 3 : 2;
  for (int axis = grid.space == OGIVE_SPACE_AXISYMMETRIC ? 1 : 0; axis < axes; ++axis) {
    MirrorPlane plane;
    plane.axis = axis;
    const auto face = grid.faces.begin() + 2 * axis;
    plane.already = std::find(face, face + 2, OGIVE_FACE_SYMMETRY) != face + 2;
    plane.reason = plane.already ? "the scene has a symmetry face there" : motion_across(scene, axis);
    plane.found = plane.reason.empty();
    planes.push_back(plane);
  }
  const auto any = [&] { return std::any_of(planes.begin(), planes.end(), [](const MirrorPlane& plane) { return plane.found; }); };
  const auto refute = [](MirrorPlane& plane, const std::string& problem) {
    plane.found = problem.empty();
    plane.reason = problem;
  };
  bool all = true;
  for (size_t b = 0; b < scene.bodies.size() && any(); ++b) {
    ParticleList particles = body_particles(scene, b);
    const Vector3 centre = centre_of(particles);
    for (MirrorPlane& plane : planes) {
      if (!plane.found) continue;
      const auto across = static_cast<size_t>(plane.axis);
      if (b == 0) {
        plane.at = centre[across];
        for (const double round : {0.5 * (grid.lower[across] + grid.upper[across]), 0.0})  // sums of many particles are not exact
          if (nearly(plane.at, round, tolerance)) plane.at = round;
        refute(plane, unsymmetric_places(scene, plane.axis, plane.at));
      } else if (!nearly(centre[across], plane.at, tolerance)) {
        refute(plane, "the centres of mass of " + quoted(scene.bodies[0].name) + " and " + quoted(scene.bodies[b].name) + " are " +
                          brief(std::abs(centre[across] - plane.at)) + ' ' + scene.units.length + " apart along " + axis_name(plane.axis));
      }
    }
    if (!any()) break;
    const Places places(std::move(particles), grid.cell_size, tolerance);
    const size_t step = thorough ? 1 : std::max<size_t>(1, places.particles().volumes.size() / kSample);
    all = all && step == 1;
    for (MirrorPlane& plane : planes) {
      if (!plane.found) continue;
      const std::string problem = unsymmetric_particles(places, plane.axis, plane.at, step);
      if (!problem.empty()) refute(plane, "body " + quoted(scene.bodies[b].name) + ' ' + problem);
    }
  }
  for (MirrorPlane& plane : planes)
    if (plane.found)
      plane.reason = "every body is its own mirror image, as far as " + std::string(all ? "all" : "a part") +
                     " of its particles tell, and nothing moves, pulls or holds across the plane";
  return planes;
}

}  // namespace driver
