// Files that the program carries with it, as they are in the source tree; made into study_assets.cpp by the build.
#pragma once

#include <string_view>

namespace driver {

extern const std::string_view study_page_template;  // driver/study_page.html
extern const std::string_view chart_library;        // third_party/chart.js/chart.umd.min.js

}  // namespace driver
