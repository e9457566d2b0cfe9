// The particles around the nodes of one mixed block, with their images at symmetry and fixed faces, for rules that look at
// particles themselves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model.hpp"
#include "vector3.hpp"

namespace ogive {

struct State;
struct Workspace;
struct MixedBlock;

class NearbyParticles {
 public:
  struct Particle {
    Vector3 place;       // in cells from the block's first node
    std::int32_t field;
  };

  void gather(const Model& model, const State& state, const Workspace& workspace, const MixedBlock& block);
  // For tests.
  void add(const Particle& particle) { found_.push_back(particle); }
  void sort();

  // Calls visit(particle) for those whose shape functions reach the node at `node` (in cells).
  template <class Visit>
  void around(const Vector3& node, double reach, Visit&& visit) const {
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = bin_of(node[axis] - reach);
      high[axis] = bin_of(node[axis] + reach);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const int bin = (z * bins + y) * bins + x;
          for (std::int32_t i = begin_[bin]; i < begin_[bin + 1]; ++i) {
            const Vector3& p = sorted_[i].place;
            if (std::abs(p[0] - node[0]) < reach && std::abs(p[1] - node[1]) < reach && std::abs(p[2] - node[2]) < reach)
              visit(sorted_[i]);
          }
        }
  }
  double reach = 1.5;  // of the shape function, in cells

 private:
  static constexpr int bins = 8;            // cells along an edge: -2 .. 5
  static constexpr double margin = 2;
  static int bin_of(double x) {
    const int bin = static_cast<int>(x + margin);
    return bin < 0 ? 0 : bin >= bins ? bins - 1 : bin;
  }
  std::vector<Particle> found_, sorted_;
  std::array<std::int32_t, bins * bins * bins + 1> begin_{};
};

}  // namespace ogive
