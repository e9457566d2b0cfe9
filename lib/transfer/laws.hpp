// The list of laws, for tables of kernels by strength and equation of state: KERNEL(Shape, strength, eos) each.
#pragma once

#define OGIVE_LAWS(Shape, KERNEL)                                                                                       \
  {{KERNEL(Shape, strength_elastic, eos_linear), KERNEL(Shape, strength_elastic, eos_mie_gruneisen)},                   \
   {KERNEL(Shape, strength_neo_hookean, eos_linear), nullptr},                                                          \
   {KERNEL(Shape, strength_j2_power, eos_linear), KERNEL(Shape, strength_j2_power, eos_mie_gruneisen)},                 \
   {KERNEL(Shape, strength_johnson_cook, eos_linear), KERNEL(Shape, strength_johnson_cook, eos_mie_gruneisen)},         \
   {KERNEL(Shape, strength_j2_mixed, eos_linear), nullptr},                                                             \
   {KERNEL(Shape, strength_j2_multiplicative, eos_linear), nullptr}}
