// Each phase of a step and each law by itself: nanoseconds a particle, bytes moved a particle and the rate of that.
//
// A cube of particles, eight a cell, fills the grid; the phases are called as lib/step.cpp calls them, one thread. Counters:
// `ns` a particle, `bytes` of particle state that the phase must read and write (a lower bound of what it moves: grid and
// tiles stay in cache), `rate` = bytes over time. Sizes: 20,000 particles stay in the last cache, a million do not.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "audit.hpp"
#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"
#include "step.hpp"

namespace {

using namespace ogive;

enum class Law { Elastic, NeoHookean, J2, JohnsonCook, JohnsonCookThermal };
constexpr const char* law_names[] = {"elastic", "neo_hookean", "j2", "johnson_cook", "johnson_cook_thermal"};

Material material_of(Law law, bool mie_gruneisen) {
  Material m;
  m.name = "metal";
  m.density = 2.7e-3;
  m.youngs_modulus = 69e3;
  m.poisson_ratio = 0.3;
  m.strength = law == Law::Elastic      ? Strength::Elastic
               : law == Law::NeoHookean ? Strength::NeoHookean
               : law == Law::J2         ? Strength::J2Power
                                        : Strength::JohnsonCook;
  if (m.plastic()) {
    m.yield_stress = 262;
    m.hardening_modulus = 52.1;
    m.hardening_exponent = 0.41;
  }
  if (law == Law::JohnsonCookThermal) {
    m.thermal_exponent = 0.859;
    m.melt_temperature = 875;
    m.specific_heat = 896;
  }
  if (mie_gruneisen) {
    m.eos = EquationOfState::MieGruneisen;
    m.eos_sound_speed = 5350;
    m.eos_slope = 1.34;
    m.gruneisen = 2;
  }
  m.validate();
  return m;
}

// A cube with `edge` particles along an edge, sheared: velocity_x = rate * z.
struct Block {
  Model model;
  State state;
  Workspace workspace;

  Block(int edge, ShapeFunction shape, Transfer transfer, Law law, bool mie_gruneisen) {
    const double spacing = 1, length = edge * spacing;
    model.grid.cell_size = 2 * spacing;
    model.grid.domain_min = {-4, -4, -4};
    for (int axis = 0; axis < 3; ++axis) model.grid.domain_max[axis] = 4 + 2 * std::ceil(length / 2);
    model.numerics.shape_function = shape;
    model.numerics.transfer = transfer;
    model.numerics.maximum_time_step = 1e-6;
    model.materials = {material_of(law, mie_gruneisen)};
    model.bodies.resize(1);
    model.bodies[0].name = "block";
    model.bodies[0].material = 0;
    model.validate_grid();
    model.validate_numerics();
    model.complete();
    state.bodies.resize(1);
    BodyState& body = state.bodies[0];
    body.particles = static_cast<std::int64_t>(edge) * edge * edge;
    allocate_particles(model.materials[0], Body{}, body.particles, body);
    std::int64_t p = 0;
    for (int k = 0; k < edge; ++k)
      for (int j = 0; j < edge; ++j)
        for (int i = 0; i < edge; ++i, ++p) {
          const double x[4] = {(i + 0.5) * spacing, (j + 0.5) * spacing, (k + 0.5) * spacing, model.materials[0].density};
          const double v[4] = {1e-2 * x[2], 0, 0, 1};
          for (int c = 0; c < 4; ++c) body.position[4 * p + c] = x[c], body.velocity[4 * p + c] = v[c];
          body.number[p] = static_cast<std::int32_t>(p);
        }
    prepare_state(model, state, workspace);
    map();
    for (NodeRecord& node : workspace.nodes)
      if (node.v[3] > 0)
        for (int c = 0; c < 3; ++c) node.v[c] /= node.v[3];
  }

  template <class Call>
  void for_groups(double dt, Call&& call) {
    for (std::size_t l = 0; l < workspace.links.size(); ++l)
      call(kernel_group(model, state, workspace, workspace.links[l], dt), kernel_particles(state.bodies[0]), l);
  }
  int shape() const { return static_cast<int>(model.numerics.shape_function); }
  void map() {
    for_groups(0, [&](const KernelGroup& group, const KernelParticles& particles, std::size_t) {
      workspace.kernels->map_momentum[shape()][model.numerics.affine()](group, particles);
    });
  }
  void stress(double dt) {
    const Material& m = model.materials[0];
    for_groups(dt, [&](const KernelGroup& group, const KernelParticles& particles, std::size_t l) {
      workspace.kernels->update_stress[shape()][static_cast<int>(m.strength)][static_cast<int>(m.eos)](
          group, particles, workspace.materials[0], workspace.stress_sums[l]);
    });
  }
};

// Floating-point operations a particle, a fused multiply-add as two, counted in the formulas of lib/transfer and lib/materials
// (additions, multiplications, divisions and roots as one each; powers as the polynomials they are). Records count with
// their fourth component, which is computed along.
struct Operations {
  bool linear, moments;  // moments: affine velocities, whose slopes are not 1 for linear functions
  explicit Operations(ShapeFunction shape, bool affine = false) : linear(shape == ShapeFunction::Linear), moments(affine) {
    weights = 3 * (linear ? 8 : shape == ShapeFunction::Gimp ? 22 : 14) + (affine ? 3 * (linear ? 2 : 8) : 0);
  }
  double weights = 0;
  // Sums along the lines of nodes in x, then y, then z (transfer.hpp: collect, spread).
  double gather_value() const { return 4 * (linear ? (4 + 2 + 1) * 3 : (9 + 3 + 1) * 6); }
  double gather_slopes() const {
    const double plain = linear ? 3 : 6, both = linear ? (moments ? 5 : 4) : 9, n = linear ? 2 : 3;
    return 4 * (n * n * both + n * (both + plain) + both + 2 * plain);
  }
  double scatter_value() const { return 4 * (linear ? 2 * (1 + 2 + 4) + 8 : 4 * (1 + 3 + 9) + 27); }
  double scatter_slopes(bool slopes_only) const {
    const double plain = linear ? 2 : 4, both = linear ? (moments ? 5 : 4) : 8, n = linear ? 2 : 3;
    const double first = slopes_only ? (linear ? 1 : 4) : both;
    return 4 * (first + 2 * plain + n * (both + plain) + n * n * both + n * n * n);
  }
};

double law_operations(const Material& m, bool yielding) {
  if (m.hyperelastic()) return 230;
  const double pressure = m.eos == EquationOfState::MieGruneisen ? 67 : 39;
  const double elastic = 184 + pressure + (m.plastic() ? 15 : 0);
  constexpr double power = 60, return_to_surface = 55;
  return elastic + (yielding ? return_to_surface + (m.thermal() ? 3 : 1) * power : 0);
}

void report(benchmark::State& bench, const Block& block, double bytes, double operations) {
  const double particles = static_cast<double>(block.state.particle_count());
  using benchmark::Counter;
  bench.counters["particles"] = particles;
  bench.counters["bytes"] = bytes;
  bench.counters["operations"] = operations;
  bench.counters["ns"] = Counter(particles * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
  bench.counters["rate"] = Counter(bytes * particles, Counter::kIsIterationInvariantRate);
}

void map_momentum(benchmark::State& bench, ShapeFunction shape, Transfer transfer, int edge) {
  Block block(edge, shape, transfer, Law::Elastic, false);
  for (auto _ : bench) block.map();
  const Operations count(shape, block.model.numerics.affine());
  report(bench, block, 64 + (block.model.numerics.affine() ? 72 : 0),
         count.weights + 4 + (count.moments ? count.scatter_slopes(false) + 12 : count.scatter_value()));
}

void map_contact(benchmark::State& bench, ShapeFunction shape, int edge) {
  Block block(edge, shape, Transfer::Flip, Law::Elastic, false);
  // A second body's slots would make these blocks mixed; here all of them get records.
  block.workspace.contacts.resize(block.workspace.nodes.size());
  for (auto _ : bench)
    block.for_groups(0, [&](KernelGroup group, const KernelParticles& particles, std::size_t) {
      for (int i = 0; i < 27; ++i)
        if (group.nodes[i]) group.contact[i] = &block.workspace.contacts[group.nodes[i] - block.workspace.nodes.data()];
      block.workspace.kernels->map_contact[block.shape()](group, particles);
    });
  const Operations count(shape);
  report(bench, block, 40, count.weights + 3 + 4 * 4 + count.scatter_slopes(false));
}

// `yielding`: every particle flows plastically in every call.
void update_stress(benchmark::State& bench, ShapeFunction shape, Law law, bool mie_gruneisen, bool yielding, int edge) {
  Block block(edge, shape, Transfer::Flip, law, mie_gruneisen);
  if (yielding)
    for (int i = 0; i < 20; ++i) block.stress(1e-1);  // 1e-3 of shear a call
  const double dt = yielding ? 1e-4 : 1e-9;
  for (auto _ : bench) block.stress(dt);
  const Material& m = block.model.materials[0];
  const double scalars = m.hyperelastic() ? 6 + 2 + 2 * 9 + 2 : 2 * 6 + 2 * 2 + (m.plastic() ? (yielding ? 4 : 2) : 0) +
                                                                     (m.thermal() ? (yielding ? 2 : 1) : 0);
  const Operations count(shape);
  report(bench, block, 32 + 8 * scalars,
         count.weights + count.gather_slopes() + law_operations(m, yielding) + 25 + count.scatter_slopes(true));
}

void update_particles(benchmark::State& bench, ShapeFunction shape, Transfer transfer, int edge) {
  Block block(edge, shape, transfer, Law::Elastic, false);
  for (NodeRecord& node : block.workspace.nodes) node.v[3] = node.f[3] = 0;
  for (auto _ : bench)
    block.for_groups(0, [&](const KernelGroup& group, const KernelParticles& particles, std::size_t l) {
      block.workspace.kernels->update_particles[block.shape()][block.model.numerics.affine()](
          group, particles, block.workspace.move_sums[l]);
    });
  const Operations count(shape, block.model.numerics.affine());
  // Velocity and acceleration are gathered; 8 operations on each of four components and 5 for the speed follow.
  report(bench, block, 128 + (block.model.numerics.affine() ? 144 : 0),
         count.weights + 2 * (count.moments ? count.gather_slopes() : count.gather_value()) + 37 + (count.moments ? 84 : 0));
}

void bin(benchmark::State& bench, Law law, Transfer transfer, int edge) {
  Block block(edge, ShapeFunction::Linear, transfer, law, false);
  const double resident = static_cast<double>(block.state.memory_bytes()) / static_cast<double>(block.state.particle_count());
  for (auto _ : bench) {
    bin_particles(block.model, block.state, block.workspace, true);
    link_grid(block.model, block.state, block.workspace);
  }
  report(bench, block, 2 * resident, 0);
}

void audit(benchmark::State& bench, Transfer transfer, int edge) {
  Block block(edge, ShapeFunction::Linear, transfer, Law::Elastic, false);
  for (auto _ : bench) benchmark::DoNotOptimize(audit_body(block.model, block.state, 0));
  report(bench, block, 72 + (block.model.numerics.affine() ? 72 : 0), 40 + (block.model.numerics.affine() ? 30 : 0));
}

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const std::string& name, auto&& run) {
    for (const int edge : {28, 100}) {
      const std::string full = name + "/" + (edge == 28 ? "20k" : "1M");
      benchmark::RegisterBenchmark(full.c_str(), [run, edge](benchmark::State& bench) { run(bench, edge); })
          ->Unit(benchmark::kMillisecond);
    }
  };
  const char* const shape_names[] = {"/linear", "/bspline", "/gimp"};
  for (const ShapeFunction shape : {ShapeFunction::Linear, ShapeFunction::QuadraticBSpline, ShapeFunction::Gimp}) {
    const std::string of = shape_names[static_cast<int>(shape)];
    for (const Transfer transfer : {Transfer::Flip, Transfer::AffineFlip}) {
      const std::string by = transfer == Transfer::Flip ? "/flip" : "/affine";
      add("map_momentum" + of + by, [=](benchmark::State& b, int edge) { map_momentum(b, shape, transfer, edge); });
      add("update_particles" + of + by, [=](benchmark::State& b, int edge) { update_particles(b, shape, transfer, edge); });
    }
    add("map_contact" + of, [=](benchmark::State& b, int edge) { map_contact(b, shape, edge); });
    for (const Law law : {Law::Elastic, Law::NeoHookean, Law::J2, Law::JohnsonCook, Law::JohnsonCookThermal})
      for (const bool mie_gruneisen : {false, true}) {
        if (law == Law::NeoHookean && mie_gruneisen) continue;
        // The law does not know the shape function: for GIMP the cheapest and the dearest.
        if (shape == ShapeFunction::Gimp && law != Law::Elastic && law != Law::JohnsonCookThermal) continue;
        const bool plastic = law != Law::Elastic && law != Law::NeoHookean;
        for (const bool yielding : {false, true}) {
          if (yielding && !plastic) continue;
          add("update_stress" + of + "/" + law_names[static_cast<int>(law)] + (mie_gruneisen ? "+mie_gruneisen" : "") +
                  (yielding ? "/yielding" : ""),
              [=](benchmark::State& b, int edge) { update_stress(b, shape, law, mie_gruneisen, yielding, edge); });
        }
      }
  }
  add("bin_and_link/johnson_cook/affine",
      [](benchmark::State& b, int edge) { bin(b, Law::JohnsonCookThermal, Transfer::AffineFlip, edge); });
  add("audit/affine", [](benchmark::State& b, int edge) { audit(b, Transfer::AffineFlip, edge); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
