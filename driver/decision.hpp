// One decision of the plan of a run (plan.hpp).
#pragma once

#include <string>

namespace driver {

struct Decision {
  std::string subject;   // accuracy, dimensions, symmetry in x, body "rod"
  std::string decision;  // what is done, or could be
  std::string reason;
  std::string overrule;  // what to write for another decision; "" where nothing else is to be had
  bool taken = false;    // false: said only
};

}  // namespace driver
