// What the tables of kernels share: the list of laws by strength and equation of state, KERNEL(Shape, strength, eos) each, and
// the name of an instruction set as text.
#pragma once

#define OGIVE_TEXT_OF(name) #name
#define OGIVE_TEXT(name) OGIVE_TEXT_OF(name)

#define OGIVE_LAWS(Shape, KERNEL)                                                                                       \
  {{KERNEL(Shape, strength_elastic, eos_linear), KERNEL(Shape, strength_elastic, eos_mie_gruneisen)},                   \
   {KERNEL(Shape, strength_neo_hookean, eos_linear), nullptr},                                                          \
   {KERNEL(Shape, strength_j2_power, eos_linear), KERNEL(Shape, strength_j2_power, eos_mie_gruneisen)},                 \
   {KERNEL(Shape, strength_johnson_cook, eos_linear), KERNEL(Shape, strength_johnson_cook, eos_mie_gruneisen)},         \
   {KERNEL(Shape, strength_j2_mixed, eos_linear), nullptr},                                                             \
   {KERNEL(Shape, strength_j2_multiplicative, eos_linear), nullptr}}
