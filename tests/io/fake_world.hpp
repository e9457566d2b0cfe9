// A world without an engine: named arrays, bodies and fields that a test sets, and failures at its command. It stands
// in for libogive, so that the file functions are tested by themselves.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "ogive.h"

namespace fake {

using Values =
    std::variant<std::vector<double>, std::vector<std::int32_t>, std::vector<std::int64_t>, std::vector<std::uint8_t>>;

struct Field {
  std::string name;
  std::int32_t components;
  std::vector<double> values;
};

struct Body {
  std::string name;
  std::int64_t particles;
  std::vector<Field> fields;
};

}  // namespace fake

struct ogive_world {
  std::string message;
  double time = 0.5;
  std::int64_t steps = 12;
  std::vector<std::pair<std::string, fake::Values>> arrays;  // saved in this order
  std::vector<std::string> wanted;                           // what a load asks for
  std::map<std::string, fake::Values> loaded;
  std::vector<fake::Body> bodies;
  mutable std::vector<std::int32_t> numbers;                 // of a view: every other number is gone

  ogive_status fail_progress = OGIVE_OK;
  ogive_status fail_save = OGIVE_OK;  // after all arrays were put
  ogive_status fail_load = OGIVE_OK;  // after all arrays were got
  std::string fail_field;             // ogive_field_get and ogive_field_view_get of this one fail
};
