// The XDMF index that lets ParaView open particle files as one time series.
#pragma once

#include <string>
#include <vector>

namespace ogive::io {

// Writes the index at `path`, whole or not at all. `files`: particle files, relative to the directory of `path` or
// absolute; times, bodies, counts and fields are read from them. Throws Failure.
void write_series(const std::string& path, const std::vector<std::string>& files);

}  // namespace ogive::io
