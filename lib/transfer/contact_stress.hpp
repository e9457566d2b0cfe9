// Nodal sums of the stress, for contact methods that ask for the normal traction: sum of V_p sigma_p N and sum of V_p N.
#pragma once

#include "transfer/stress.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

template <class Shape>
void map_contact_stress(const KernelGroup& group, const KernelParticles& particles, ContactStress* const (&nodes)[27]) {
  alignas(64) Record direct[tile_size], shear[tile_size];
  clear_tile(group, direct);
  clear_tile(group, shear);
  Scatter<Shape> direct_sums, shear_sums;
  Scatter<Shape>::begin(direct_sums, direct);
  Scatter<Shape>::begin(shear_sums, shear);
  Weights weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<Shape, Beside::Nothing>(weights, group, x, y, z);
    const Lanes volume = mass * group.inverse_density * load_aligned<Lanes>(particles.volume_ratio + p);
    const Symmetric<Lanes> s = load_stress<Lanes>(particles, p);
    Lanes first[4] = {volume * s.xx, volume * s.yy, volume * s.zz, volume};
    Lanes second[4] = {volume * s.yz, volume * s.xz, volume * s.xy, Lanes{}};
    transpose(first[0], first[1], first[2], first[3]);
    transpose(second[0], second[1], second[2], second[3]);
#pragma GCC unroll 1
    for (int lane = 0; lane < lane_count; ++lane) {
      scatter_value<Shape>(weights, lane, first[lane], direct_sums);
      scatter_value<Shape>(weights, lane, second[lane], shear_sums);
    }
  }
  Scatter<Shape>::end(direct_sums);
  Scatter<Shape>::end(shear_sums);
  constexpr int stride = sizeof(ContactStress) / sizeof(double);
  add_tile(group, direct, [&](const KernelGroup&, int block) { return nodes[block] ? nodes[block]->direct : nullptr; },
           stride);
  add_tile(group, shear, [&](const KernelGroup&, int block) { return nodes[block] ? nodes[block]->shear : nullptr; },
           stride);
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
