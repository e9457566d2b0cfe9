// The one exception of the engine. Its message names the field, the value and what was expected; the C interface turns
// the kind into a status and keeps the message with the world.
#pragma once

#include <stdexcept>
#include <string>

namespace ogive {

// The same numbers as OGIVE_ERROR_* in capi/ogive.h.
enum class ErrorKind { Argument = 1, State = 2, Memory = 3, Numerical = 4, File = 5, Format = 6, Internal = 7 };

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace ogive
