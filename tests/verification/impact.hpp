// A steel ball against a Johnson-Cook aluminium plate that fails: contact with friction, plasticity, heat, failure, and
// free faces. Symmetric about y = 0, and about x = 0 where the ball is not put to one side.
#pragma once

#include "scene.hpp"

namespace verification {

struct Impact {
  std::int32_t shape = OGIVE_SHAPE_QUADRATIC_BSPLINE;
  std::int32_t method = OGIVE_CONTACT_HUANG_SECOND;
  std::int32_t threads = 1;
  bool half_x = false, half_y = false;
  double off_centre = 0;
  double hardening_exponent = 0.2783;

  ogive_material_def plate() const {
    ogive_material_def def = failing_aluminium();
    def.hardening_exponent = hardening_exponent;
    return def;
  }

  Scene build() const {
    Scene scene;
    std::array<std::int32_t, 6> faces = {};
    if (half_x) faces[0] = OGIVE_FACE_SYMMETRY;
    if (half_y) faces[2] = OGIVE_FACE_SYMMETRY;
    scene.grid(1, {half_x ? 0.0 : -10.0, half_y ? 0.0 : -10.0, -10}, {10, 10, 10}, faces)
        .numerics(shape, 0.4, {}, threads)
        .contact(method, OGIVE_DETECTION_GAP, 0.1);
    const ogive_material_id hard = scene.material("steel", steel());
    const ogive_material_id soft = scene.material("aluminium", plate());
    scene.add("ball", Scene::body(hard, {0, 0, -400}),
              Scene::solid(OGIVE_SOLID_SPHERE, {off_centre, 0, 3.05}, {3, 0, 0}, 0.5));
    scene.box("plate", soft, {-8, -8, -3}, {8, 8, 0}, 0.5, {0, 0, 0});
    scene.prepare();
    return scene;
  }
};

}  // namespace verification
