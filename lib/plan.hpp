// The plan of a run in words: what is modelled, what is left out, and why.
#pragma once

#include <string>

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

std::string describe_plan(const Model& model, const State& state, const Workspace& workspace);

}  // namespace ogive
