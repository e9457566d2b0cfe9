// The functions of libogive that ogive_io calls, over fake_world.hpp.
#include "fake_world.hpp"

#include <algorithm>

namespace {

template <class Element>
constexpr std::int32_t type_of(const std::vector<Element>&) {
  if constexpr (std::is_same_v<Element, double>) return OGIVE_TYPE_FLOAT64;
  if constexpr (std::is_same_v<Element, std::int32_t>) return OGIVE_TYPE_INT32;
  if constexpr (std::is_same_v<Element, std::int64_t>) return OGIVE_TYPE_INT64;
  return OGIVE_TYPE_UINT8;
}

template <class Element>
ogive_status get_into(ogive_world* world, const ogive_reader* reader, const std::string& name, std::int64_t count) {
  std::vector<Element> values(static_cast<std::size_t>(count));
  const ogive_status status = reader->get(reader->user, name.c_str(), count, values.data());
  if (status == OGIVE_OK) world->loaded[name] = std::move(values);
  return status;
}

const fake::Body* body_of(const ogive_world* world, ogive_body_id id) {
  return id.index >= 0 && id.index < ogive_body_count(world) ? &world->bodies[static_cast<std::size_t>(id.index)]
                                                             : nullptr;
}

}  // namespace

extern "C" {

const char* ogive_version(void) { return "9.8.7"; }
const char* ogive_status_name(ogive_status) { return "a status"; }
const char* ogive_world_message(const ogive_world* world) { return world->message.c_str(); }

ogive_status ogive_world_report(ogive_world* world, ogive_status status, const char* message) {
  world->message = message ? message : "";
  return status;
}

ogive_status ogive_world_progress(const ogive_world* world, ogive_progress* progress) {
  progress->time = world->time;
  progress->steps = world->steps;
  progress->particles = 0;
  for (const auto& body : world->bodies) progress->particles += body.particles;
  return world->fail_progress;
}

ogive_status ogive_world_save(const ogive_world* world, const ogive_writer* writer) {
  for (const auto& [name, values] : world->arrays) {
    const ogive_status status = std::visit(
        [&, &array_name = name](const auto& array) {
          return writer->put(writer->user, array_name.c_str(), type_of(array), static_cast<std::int64_t>(array.size()),
                             array.data());
        },
        values);
    if (status != OGIVE_OK) return status;
  }
  return world->fail_save;
}

ogive_status ogive_world_load(ogive_world* world, const ogive_reader* reader) {
  for (const auto& name : world->wanted) {
    std::int32_t type = 0;
    std::int64_t count = -1;
    ogive_status status = reader->find(reader->user, name.c_str(), &type, &count);
    if (status == OGIVE_OK) {
      switch (type) {
        case OGIVE_TYPE_FLOAT64:
          status = get_into<double>(world, reader, name, count);
          break;
        case OGIVE_TYPE_INT32:
          status = get_into<std::int32_t>(world, reader, name, count);
          break;
        case OGIVE_TYPE_INT64:
          status = get_into<std::int64_t>(world, reader, name, count);
          break;
        default:
          status = get_into<std::uint8_t>(world, reader, name, count);
      }
    }
    if (status != OGIVE_OK) return status;
  }
  if (world->fail_load != OGIVE_OK) world->message = "the model is not what it says";
  return world->fail_load;
}

std::int32_t ogive_body_count(const ogive_world* world) { return static_cast<std::int32_t>(world->bodies.size()); }

const char* ogive_body_name(const ogive_world* world, ogive_body_id id) {
  const auto* body = body_of(world, id);
  return body ? body->name.c_str() : nullptr;
}

ogive_status ogive_body_add_particles(ogive_world*, const char*, const ogive_body_def*, int64_t, const double*,
                                      const double*, ogive_body_id*) {
  return OGIVE_ERROR_STATE;  // no test with a fake world adds bodies
}

ogive_status ogive_body_result_get(const ogive_world* world, ogive_body_id id, ogive_body_result* result) {
  const auto* body = body_of(world, id);
  if (!body) return OGIVE_ERROR_ARGUMENT;
  result->particles = body->particles;
  return OGIVE_OK;
}

std::int32_t ogive_field_count(const ogive_world* world, ogive_body_id id) {
  return static_cast<std::int32_t>(body_of(world, id)->fields.size());
}

const char* ogive_field_name(const ogive_world* world, ogive_body_id id, std::int32_t index, std::int32_t* components) {
  const auto& field = body_of(world, id)->fields[static_cast<std::size_t>(index)];
  *components = field.components;
  return field.name.c_str();
}

ogive_status ogive_field_get(const ogive_world* world, ogive_body_id id, const char* name, double* values,
                             std::int64_t count) {
  if (world->fail_field == name) {
    const_cast<ogive_world*>(world)->message = "no such field today";
    return OGIVE_ERROR_STATE;
  }
  for (const auto& field : body_of(world, id)->fields) {
    if (field.name != name) continue;
    if (!values || count != static_cast<std::int64_t>(field.values.size())) return OGIVE_ERROR_ARGUMENT;
    std::copy(field.values.begin(), field.values.end(), values);
    return OGIVE_OK;
  }
  return OGIVE_ERROR_ARGUMENT;
}

ogive_status ogive_field_view_get(const ogive_world* world, ogive_body_id id, const char* name, ogive_field_view* view) {
  if (world->fail_field == name) {
    const_cast<ogive_world*>(world)->message = "no such field today";
    return OGIVE_ERROR_STATE;
  }
  for (const auto& field : body_of(world, id)->fields) {
    if (field.name != name) continue;
    view->components = field.components;
    view->places = static_cast<std::int64_t>(field.values.size()) / field.components;
    view->stride = field.components;
    for (std::int32_t c = 0; c < field.components; ++c) view->component[c] = field.values.data() + c;
    world->numbers.clear();
    for (std::int64_t i = 0; i < view->places; ++i) world->numbers.push_back(static_cast<std::int32_t>(2 * i + 1));
    view->number = world->numbers.data();
    return OGIVE_OK;
  }
  return OGIVE_ERROR_ARGUMENT;
}

}  // extern "C"
