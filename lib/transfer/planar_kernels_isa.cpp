// The kernels of two-dimensional models, of one instruction set: compiled as kernels_isa.cpp is. Plane strain and
// axisymmetry share them: what the axis adds is a term that a group asks for (KernelGroup::axisymmetric).
#include "transfer/contact_stress.hpp"
#include "transfer/laws.hpp"
#include "transfer/stress.hpp"
#include "transfer/xpic.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

using PlanarLinear = Planar<LinearShape>;
using PlanarBSpline = Planar<QuadraticBSplineShape>;
using PlanarGimp = Planar<GimpShape>;

#define OGIVE_KERNEL(Shape, strength, eos) update_stress<Shape, strength, eos>

static const OptionalKernels planar_optional_kernels = {
    {map_contact_stress<PlanarLinear>, map_contact_stress<PlanarBSpline>, map_contact_stress<PlanarGimp>},
    {filter_velocity<PlanarLinear>, filter_velocity<PlanarBSpline>, filter_velocity<PlanarGimp>},
    {update_particles_xpic<PlanarLinear>, update_particles_xpic<PlanarBSpline>, update_particles_xpic<PlanarGimp>},
    {},  // total Lagrangian bodies are three-dimensional
};

extern const KernelTable planar_table;
const KernelTable planar_table = {
    OGIVE_TEXT(OGIVE_ISA_NAMESPACE),
    {{map_momentum<PlanarLinear, false>, map_momentum<PlanarLinear, true>},
     {map_momentum<PlanarBSpline, false>, map_momentum<PlanarBSpline, true>},
     {map_momentum<PlanarGimp, false>, map_momentum<PlanarGimp, true>}},
    {map_contact<PlanarLinear>, map_contact<PlanarBSpline>, map_contact<PlanarGimp>},
    {OGIVE_LAWS(PlanarLinear, OGIVE_KERNEL), OGIVE_LAWS(PlanarBSpline, OGIVE_KERNEL), OGIVE_LAWS(PlanarGimp, OGIVE_KERNEL)},
    {map_internal_force<PlanarLinear>, map_internal_force<PlanarBSpline>, map_internal_force<PlanarGimp>},
    {{update_particles<PlanarLinear, false>, update_particles<PlanarLinear, true>},
     {update_particles<PlanarBSpline, false>, update_particles<PlanarBSpline, true>},
     {update_particles<PlanarGimp, false>, update_particles<PlanarGimp, true>}},
    &planar_optional_kernels,
    nullptr,
};

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
