// Numbers written as expressions: "V0*sin(obliquity*deg)" over the scene's [parameters] and the constants pi and deg.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace driver {

class Expressions {
 public:
  /// Makes `name` known to later expressions. Returns why it cannot be, "" if it can.
  std::string define(const std::string& name, double value);
  /// Value of an expression. On failure `problem` says why, otherwise it is empty.
  double evaluate(const std::string& text, std::string& problem) const;
  /// Names that an expression uses, whether known or not; empty if it cannot be read.
  static std::vector<std::string> names_used(const std::string& text);
  const std::map<std::string, double>& parameters() const { return parameters_; }

 private:
  std::map<std::string, double> parameters_;
};

}  // namespace driver
