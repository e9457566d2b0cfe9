// The kernels that few runs need, of one instruction set: compiled as kernels_isa.cpp is. In a file of their own so that
// they do not change how the compiler lays out those that every run needs.
#include "transfer/contact_stress.hpp"
#include "transfer/laws.hpp"
#include "transfer/total_lagrangian.hpp"
#include "transfer/xpic.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

#define OGIVE_KERNEL(Shape, strength, eos) update_lagrangian<Shape, strength, eos>

extern const OptionalKernels optional_kernels;
const OptionalKernels optional_kernels = {
    {map_contact_stress<LinearShape>, map_contact_stress<QuadraticBSplineShape>, map_contact_stress<GimpShape>},
    {filter_velocity<LinearShape>, filter_velocity<QuadraticBSplineShape>, filter_velocity<GimpShape>},
    {update_particles_xpic<LinearShape>, update_particles_xpic<QuadraticBSplineShape>,
     update_particles_xpic<GimpShape>},
    {OGIVE_LAWS(LinearShape, OGIVE_KERNEL), OGIVE_LAWS(QuadraticBSplineShape, OGIVE_KERNEL)},
};

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
