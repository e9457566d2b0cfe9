// Run-time choice of the kernels' instruction set.
#include <cstdlib>
#include <cstring>
#include <string>

#include "error.hpp"
#include "transfer/kernels.hpp"

namespace ogive {

namespace generic {
extern const KernelTable table;
}
#ifdef OGIVE_X86_64_LEVELS
namespace x86_64_v2 {
extern const KernelTable table;
}
namespace x86_64_v3 {
extern const KernelTable table;
}
namespace x86_64_v4 {
extern const KernelTable table;
}
#endif

namespace {

struct Candidate {
  const char* name;
  const KernelTable* table;
  bool runs;
};

// The best that this processor has, or the one that is asked for. One that it lacks is an error: taking another without a word
// would make a comparison of speeds worthless.
const KernelTable& choose() {
  const char* const wanted = std::getenv("OGIVE_ISA");
#ifdef OGIVE_X86_64_LEVELS
  __builtin_cpu_init();
  const Candidate candidates[] = {
      {"x86-64-v4", &x86_64_v4::table, __builtin_cpu_supports("x86-64-v4") != 0},
      {"x86-64-v3", &x86_64_v3::table, __builtin_cpu_supports("x86-64-v3") != 0},
      {"x86-64-v2", &x86_64_v2::table, __builtin_cpu_supports("x86-64-v2") != 0},
      {"generic", &generic::table, true},
  };
#else
  const Candidate candidates[] = {{"generic", &generic::table, true}};
#endif
  std::string names;
  for (const Candidate& candidate : candidates) {
    if (!candidate.runs) continue;
    if (!wanted || *wanted == 0 || std::strcmp(wanted, candidate.name) == 0) return *candidate.table;
    names += (names.empty() ? "" : ", ") + std::string(candidate.name);
  }
  throw Error(ErrorKind::Argument, "OGIVE_ISA (environment): must be an instruction set that this processor and this build have (" +
                                       names + "), got \"" + wanted + '"');
}

}  // namespace

const KernelTable& kernel_table() {
  static const KernelTable& table = choose();
  return table;
}

}  // namespace ogive
