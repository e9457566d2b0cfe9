// The kernel table of one instruction set: the build compiles this file once for each, with OGIVE_ISA_NAMESPACE naming it.
#include "transfer/laws.hpp"
#include "transfer/stress.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

#define OGIVE_KERNEL(Shape, strength, eos) update_stress<Shape, strength, eos>

extern const OptionalKernels optional_kernels;  // optional_kernels_isa.cpp
extern const KernelTable planar_table;              // planar_kernels_isa.cpp
extern const KernelTable table;
const KernelTable table = {
    OGIVE_TEXT(OGIVE_ISA_NAMESPACE),
    {{map_momentum<LinearShape, false>, map_momentum<LinearShape, true>},
     {map_momentum<QuadraticBSplineShape, false>, map_momentum<QuadraticBSplineShape, true>},
     {map_momentum<GimpShape, false>, map_momentum<GimpShape, true>}},
    {map_contact<LinearShape>, map_contact<QuadraticBSplineShape>, map_contact<GimpShape>},
    {OGIVE_LAWS(LinearShape, OGIVE_KERNEL), OGIVE_LAWS(QuadraticBSplineShape, OGIVE_KERNEL),
     OGIVE_LAWS(GimpShape, OGIVE_KERNEL)},
    {map_internal_force<LinearShape>, map_internal_force<QuadraticBSplineShape>, map_internal_force<GimpShape>},
    {{update_particles<LinearShape, false>, update_particles<LinearShape, true>},
     {update_particles<QuadraticBSplineShape, false>, update_particles<QuadraticBSplineShape, true>},
     {update_particles<GimpShape, false>, update_particles<GimpShape, true>}},
    &optional_kernels,
    &planar_table,
};

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
