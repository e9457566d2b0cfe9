/* Checks for tests in plain C: each prints what failed and where, and counts it. */
#ifndef OGIVE_TESTS_CAPI_CHECK_H
#define OGIVE_TESTS_CAPI_CHECK_H

#include <ogive.h>
#include <stdio.h>
#include <string.h>

static int failures;

#define CHECK(condition)                                                   \
  do {                                                                     \
    if (!(condition)) {                                                    \
      ++failures;                                                          \
      printf("%s:%d: failed: %s\n", __FILE__, __LINE__, #condition);       \
    }                                                                      \
  } while (0)

/* The call gives the status, and where it refuses, the world's message holds the word. */
#define CHECK_STATUS(world, call, expected, word)                                                                   \
  do {                                                                                                              \
    const ogive_status status_ = (call);                                                                            \
    const char* message_ = ogive_world_message(world);                                                              \
    if (status_ != (expected) || (status_ != OGIVE_OK && (world) && !strstr(message_, word))) {                     \
      ++failures;                                                                                                   \
      printf("%s:%d: %s\n  gave \"%s\" and the message \"%s\"; expected \"%s\" and the word \"%s\"\n", __FILE__,       \
             __LINE__, #call, ogive_status_name(status_), message_, ogive_status_name(expected), word);             \
    }                                                                                                               \
  } while (0)

#define CHECK_OK(world, call) CHECK_STATUS(world, call, OGIVE_OK, "")
#define CHECK_REFUSED(world, call, word) CHECK_STATUS(world, call, OGIVE_ERROR_ARGUMENT, word)
#define CHECK_ORDER(world, call, word) CHECK_STATUS(world, call, OGIVE_ERROR_STATE, word)

static inline void set3(double* to, double x, double y, double z) {
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

#endif
