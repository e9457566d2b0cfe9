// Files that travel inside the program; see embed.cmake.
#pragma once

#include <string_view>

namespace driver {

extern const std::string_view study_page_template, chart_library;
extern const std::string_view resolution_data;  // docs/data/resolution.csv
extern const std::string_view factor_data;      // docs/data/time_step_factor.csv

}  // namespace driver
