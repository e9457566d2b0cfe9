// What went wrong with a file, thrown inside this library and turned into a status and a message by its caller.
#pragma once

#include <stdexcept>
#include <string>

namespace ogive::io {

enum class Fault {
  argument,  // the caller asked for something that no file can hold
  file,      // the system refused: missing, no permission, no space
  format     // the content is damaged, foreign or of an unknown version
};

class Failure : public std::runtime_error {
 public:
  Failure(Fault fault, const std::string& reason) : std::runtime_error(reason), fault_(fault) {}
  Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

}  // namespace ogive::io
