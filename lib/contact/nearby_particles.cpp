#include "contact/nearby_particles.hpp"

#include <algorithm>

#include "grid.hpp"

namespace ogive {

void NearbyParticles::gather(const Model& model, const State& state, const Workspace& workspace, const MixedBlock& block) {
  const Grid& grid = model.grid;
  const double inverse = 1.0 / grid.cell_size;
  reach = model.numerics.reach();
  found_.clear();
  const auto near = [](const Vector3& x) {
    for (const double c : x)
      if (!(c > -margin && c < bins - margin)) return false;
    return true;
  };
  for (std::int32_t s = block.first_slot; s < block.first_slot + block.count; ++s) {
    const Slot& slot = workspace.slots[s];
    for (std::int32_t i = workspace.slot_links_begin[s]; i < workspace.slot_links_begin[s + 1]; ++i) {
      const GroupLinks& link = workspace.links[workspace.slot_links[i]];
      const BodyState& body = workspace.particles_of(state, link.body);
      const Group& group = body.groups[link.group];
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        std::array<Vector3, 8> images;
        int count = 1;
        for (int axis = 0; axis < 3; ++axis)
          images[0][axis] = (body.position[4 * p + axis] - grid.domain_min[axis]) * inverse - 4.0 * slot.block[axis];
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            if (grid.face[2 * axis + side] == Face::Free) continue;
            const double plane =
                (side == 0 ? 0 : (grid.domain_max[axis] - grid.domain_min[axis]) * inverse) - 4.0 * slot.block[axis];
            if (std::abs(plane - images[0][axis]) > margin || count > 4) continue;
            for (int k = 0; k < count; ++k) {
              images[count + k] = images[k];
              images[count + k][axis] = 2 * plane - images[k][axis];
            }
            count *= 2;
          }
        for (int k = 0; k < count; ++k)
          if (near(images[k])) found_.push_back({images[k], slot.field});
      }
    }
  }
  sort();
}

void NearbyParticles::sort() {
  begin_.fill(0);
  const auto bin = [](const Particle& p) {
    return (bin_of(p.place[2]) * bins + bin_of(p.place[1])) * bins + bin_of(p.place[0]);
  };
  for (const Particle& p : found_) ++begin_[bin(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  sorted_.resize(found_.size());
  auto next = begin_;
  for (const Particle& p : found_) sorted_[next[bin(p)]++] = p;
}

}  // namespace ogive
