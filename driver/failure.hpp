// How the program ends: its exit codes, and the exception that carries one with the message for the user.
#pragma once

#include <stdexcept>
#include <string>

namespace driver {

enum ExitCode : int {
  kExitOk = 0,
  kExitInternal = 1,     // a defect of the program
  kExitInput = 2,        // a wrong command line, scene or mesh
  kExitNumerical = 3,    // the run broke down
  kExitFile = 4,         // a file cannot be read or written
  kExitDamaged = 5,      // a checkpoint or particle file is damaged, foreign or of an unknown version
  kExitMemory = 6,       // memory could not be had
  kExitInterrupted = 75  // stopped by a signal after writing a checkpoint (EX_TEMPFAIL: try again later)
};

/// Ends the program with `code` after printing the message, one line as a rule: place, value, expectation.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace driver
