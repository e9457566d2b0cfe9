// Numbers written as expressions, evaluated by muParser.
#include "expression.hpp"

#include <muParser.h>

#include <cmath>
#include <numbers>

#include "text.hpp"

namespace driver {
namespace {

const std::map<std::string, double> kConstants = {{"pi", std::numbers::pi}, {"deg", std::numbers::pi / 180.0}};

void define_constants(mu::Parser& parser) {
  for (const auto& [name, value] : kConstants) parser.DefineConst(name, value);
}

}  // namespace

std::string Expressions::define(const std::string& name, double value) {
  if (kConstants.count(name)) return "is a constant of its own; choose another name";
  try {
    mu::Parser parser;
    define_constants(parser);
    parser.DefineConst(name, value);
    parser.SetExpr(name);
    if (parser.Eval() != value) return "cannot be used as a name in an expression; choose another";
  } catch (const mu::Parser::exception_type&) {
    return "cannot be used as a name in an expression; expected letters, digits and _, and no function's name";
  }
  parameters_[name] = value;
  return "";
}

double Expressions::evaluate(const std::string& text, std::string& problem) const {
  problem.clear();
  std::vector<std::string> known;
  for (const auto& [name, value] : parameters_) known.push_back(name);
  for (const auto& [name, value] : kConstants) known.push_back(name);
  try {
    for (const std::string& name : names_used(text)) {
      if (!kConstants.count(name) && !parameters_.count(name)) {
        problem = "the name \"" + name + "\" is unknown" + suggestion(name, known) + " (known: " + joined(known) + ")";
        return 0;
      }
    }
    mu::Parser parser;
    define_constants(parser);
    for (const auto& [name, value] : parameters_) parser.DefineConst(name, value);
    parser.SetExpr(text);
    const double value = parser.Eval();
    // muParser takes "1, 2" as two expressions and returns the last.
    if (parser.GetNumResults() != 1) problem = "expected one number";
    return value;
  } catch (const mu::Parser::exception_type& error) {
    problem = error.GetMsg();
    while (!problem.empty() && (problem.back() == '.' || problem.back() == '\n')) problem.pop_back();
    return 0;
  }
}

std::vector<std::string> Expressions::names_used(const std::string& text) {
  std::vector<std::string> names;
  try {
    mu::Parser parser;
    parser.SetExpr(text);
    for (const auto& [name, address] : parser.GetUsedVar()) names.push_back(name);
  } catch (const mu::Parser::exception_type&) {
    names.clear();
  }
  return names;
}

}  // namespace driver
