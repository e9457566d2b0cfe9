// ogive study: a sweep over the settings of a scene, its results as tables, charts and a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "failure.hpp"

namespace driver {

struct StudyOptions {
  std::string study_file;
  std::optional<std::string> output;  // directory; default: the study's name + "-study"
  std::optional<std::string> cache;   // directory of cases; default: "cases" in the output
  int jobs = 1;
  std::optional<double> timeout;      // processor seconds a case; default: the study's
  std::vector<std::string> only;      // axis=label
  bool pictures = true;
  bool list = false;                  // tell the cases, run none
};
ExitCode study(const StudyOptions& options);

}  // namespace driver
