// Scenes of bodies of revolution: spheres with their centres on one axis, cylinders and ogive rods along it, motion, gravity and
// walls along it, clamps round it or across all of it.
#include "revolution.hpp"

#include <ogive.h>

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace driver {
namespace {

constexpr double kTolerance = 1e-9;

/// One axis of the model, and the scene looked at from it.
class Axis {
 public:
  Axis(const Scene& scene, size_t along) : scene_(scene), along_(along), across_{along == 0 ? 1U : 0U, along == 2 ? 1U : 2U} {}

  /// "" or what stands against it; fills the settings.
  std::string look(std::vector<Setting>& settings) {
    settings_ = &settings;
    std::string problem = bodies();
    if (problem.empty()) problem = grid();
    if (problem.empty()) problem = rules();
    for (size_t i = 0; i < scene_.clamps.size() && problem.empty(); ++i) problem = clamp(i);
    return problem;
  }

 private:
  void set(const std::string& path, const std::string& value) { settings_->push_back({path, value}); }
  double scale() const { return kTolerance * scene_.grid.cell_size; }
  bool on_axis(const Vector3& place) const {
    return std::abs(place[across_[0]] - at_[0]) <= scale() && std::abs(place[across_[1]] - at_[1]) <= scale();
  }
  bool is_along(const Vector3& direction) const {
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    return std::abs(direction[across_[0]]) <= kTolerance * length && std::abs(direction[across_[1]]) <= kTolerance * length;
  }
  std::string in_plane(const Vector3& along) const { return list_text({0, along[along_], 0}); }

  std::string bodies() {
    for (const BodyScene& body : scene_.bodies) {
      const std::string name = "body \"" + body.name + "\" ";
      const auto* solid = std::get_if<SolidShape>(&body.shape);
      if (!solid || solid->solid == OGIVE_SOLID_BOX)
        return name + (solid ? "is a box" : "is not one of the solids of revolution that the scene knows");
      if (&body == &scene_.bodies.front()) at_ = {solid->centre[across_[0]], solid->centre[across_[1]]};
      if (!on_axis(solid->centre)) return name + "lies beside the axis of the first";
      if (solid->solid != OGIVE_SOLID_SPHERE && !is_along(solid->axis)) return name + "has another axis";
      if (body.formulation == OGIVE_FORMULATION_TOTAL_LAGRANGIAN) return name + "is total Lagrangian, which needs three dimensions";
      const std::string path = "bodies." + body.name;
      const std::string shape = path + '.' + solid->kind;
      const bool sphere = solid->solid == OGIVE_SOLID_SPHERE;
      set(shape + ".centre", in_plane(solid->centre));
      set(shape + ".axis", sphere ? "[0, 0, 1]" : list_text({0, solid->axis[along_] > 0 ? 1.0 : -1.0, 0}));
      set(shape + ".reference", "[0, 0, 0]");
      if (solid->lattice != OGIVE_LATTICE_CARTESIAN) set(path + ".lattice", "cartesian");
      if (sphere) {
        const double across = solid->spacing[across_[0]], along = solid->spacing[along_];
        set(path + ".spacing", list_text({across, along, across}));
      }
      const std::string problem = motion(body, path);
      if (!problem.empty()) return name + problem;
    }
    return "";
  }

  std::string motion(const BodyScene& body, const std::string& path) {
    const auto only_along = [&](const Vector3& velocity, const Vector3& angular_velocity) -> std::string {
      if (!is_along(velocity)) return "does not move along the axis";
      if (angular_velocity != Vector3{}) return "turns";
      return "";
    };
    std::string problem = only_along(body.velocity, body.angular_velocity);
    if (body.motion.empty() && body.velocity != Vector3{}) set(path + ".velocity", in_plane(body.velocity));
    for (size_t k = 0; k < body.motion.size() && problem.empty(); ++k) {
      problem = only_along(body.motion[k].velocity, body.motion[k].angular_velocity);
      if (body.motion[k].velocity != Vector3{})
        set(path + ".motion." + std::to_string(k) + ".velocity", in_plane(body.motion[k].velocity));
    }
    return problem;
  }

  std::string grid() {
    const GridScene& grid = scene_.grid;
    static const char* const kinds[] = {"free", "symmetry", "fixed"};
    double reach = 0;
    int32_t outside = -1;
    for (size_t i = 0; i < 2; ++i)
      for (size_t side = 0; side < 2; ++side) {
        const double distance = std::abs((side == 0 ? grid.lower : grid.upper)[across_[i]] - at_[i]);
        const int32_t face = grid.faces[2 * across_[i] + side];
        if (face == OGIVE_FACE_SYMMETRY) {
          if (distance > scale()) return "a symmetry face does not hold the axis";
          continue;
        }
        if (outside >= 0 && face != outside) return "the domain's faces round the axis are of two kinds";
        outside = face;
        reach = std::max(reach, distance);
      }
    set("grid.space", "axisymmetric");
    set("grid.lower", list_text({0, grid.lower[along_], 0}));
    set("grid.upper", list_text({reach, grid.upper[along_], 0}));
    const int32_t faces[4] = {OGIVE_FACE_FREE, outside < 0 ? OGIVE_FACE_FREE : outside, grid.faces[2 * along_],
                              grid.faces[2 * along_ + 1]};
    static const char* const names[4] = {"x_min", "x_max", "y_min", "y_max"};
    for (size_t f = 0; f < 4; ++f) set(std::string("grid.faces.") + names[f], kinds[faces[f]]);
    for (const char* name : {"z_min", "z_max"}) set(std::string("grid.faces.") + name, "free");
    reach_ = reach;
    return "";
  }

  std::string rules() {
    const Vector3& gravity = scene_.numerics.gravity;
    if (!is_along(gravity) && gravity != Vector3{}) return "gravity does not pull along the axis";
    if (gravity != Vector3{}) set("numerics.gravity", in_plane(gravity));
    for (size_t i = 0; i < scene_.walls.size(); ++i) {
      if (!is_along(scene_.walls[i].normal)) return "wall " + std::to_string(i) + " does not lie across the axis";
      set("walls." + std::to_string(i) + ".point", in_plane(scene_.walls[i].point));
      set("walls." + std::to_string(i) + ".normal", list_text({0, scene_.walls[i].normal[along_] > 0 ? 1.0 : -1.0, 0}));
    }
    return "";
  }

  std::string clamp(size_t index) {
    const ClampScene& clamp = scene_.clamps[index];
    const std::string path = "clamps." + std::to_string(index), name = "clamp " + std::to_string(index) + ' ';
    if (clamp.region == OGIVE_REGION_OUTSIDE_CYLINDER) {
      if (!is_along(clamp.b) || !on_axis(clamp.a)) return name + "does not lie round the axis";
      set(path + ".centre", in_plane(clamp.a));
      set(path + ".axis", "[0, 1, 0]");
    } else {
      for (size_t i = 0; i < 2; ++i)
        if (clamp.a[across_[i]] > scene_.grid.lower[across_[i]] || clamp.b[across_[i]] < scene_.grid.upper[across_[i]])
          return name + "does not reach across all of the domain";
      set(path + ".lower", list_text({0, clamp.a[along_], 0}));
      set(path + ".upper", list_text({reach_, clamp.b[along_], 0}));
    }
    const bool first = clamp.axes >> across_[0] & 1, second = clamp.axes >> across_[1] & 1;
    if (first != second) return name + "holds one of the directions across the axis alone";
    set(path + ".axes", std::string(first ? "x" : "") + (clamp.axes >> along_ & 1 ? "y" : ""));
    return "";
  }

  const Scene& scene_;
  size_t along_;
  std::array<size_t, 2> across_;
  std::array<double, 2> at_{};  // of the axis, along across_
  double reach_ = 0;
  std::vector<Setting>* settings_ = nullptr;
};

}  // namespace

Revolution find_revolution(const Scene& scene) {
  Revolution found;
  if (scene.grid.space != OGIVE_SPACE_THREE_DIMENSIONAL) {
    found.reason = "the scene has two dimensions";
    return found;
  }
  // The direction of flight first, so that what is told is about the axis that the user thinks of.
  size_t first = 2;
  for (const BodyScene& body : scene.bodies)
    for (size_t c = 0; c < 3; ++c)
      if (std::abs(body.velocity[c]) > std::abs(body.velocity[first])) first = c;
  for (size_t turn = 0; turn < 3; ++turn) {
    const size_t axis = (first + turn) % 3;
    std::vector<Setting> settings;
    const std::string problem = Axis(scene, axis).look(settings);
    if (problem.empty()) {
      found.axis = static_cast<int>(axis);
      found.reason = std::string("every body is a solid of revolution about ") + "xyz"[axis] + ", and so are motion, walls and clamps";
      found.settings = std::move(settings);
      return found;
    }
    if (turn == 0) found.reason = std::string("about ") + "xyz"[axis] + ": " + problem;
  }
  return found;
}

}  // namespace driver
