/* Put before a program (LD_PRELOAD), it lets the system fail at a chosen moment. The calls that write (open to create, write,
 * pwrite, ftruncate, fsync, close of what was written, rename, remove, unlink; standard output and error apart) are counted from 1.
 *
 *   OGIVE_FAULT=ACTION:NUMBER    what happens at that call
 *     kill       the process is killed before the call            half       half of a write is made, then it is killed
 *     after      it is killed after the call                      short      half of a write is made, once
 *     intr       a write is interrupted, once                     space, io, quota, readonly, access
 *                                                                 the call and all later ones fail with that error
 *     once       the call alone fails, with an input/output error
 *   OGIVE_FAULT_COUNT=FILE       at the end the number of calls is written there
 *   OGIVE_FAULT_CLOCK=SEED       clocks jump by up to a year, back and forth, at one question in four
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static long calls, chosen;
static char action[16];
static unsigned long long clock_state;

#define REAL(type, name, ...)                                     \
  static type (*real)(__VA_ARGS__);                               \
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name)

__attribute__((constructor)) static void begin(void) {
  const char* fault = getenv("OGIVE_FAULT");
  const char* clock = getenv("OGIVE_FAULT_CLOCK");
  if (fault) sscanf(fault, "%15[a-z]:%ld", action, &chosen);
  if (clock) clock_state = strtoull(clock, NULL, 10) * 2862933555777941757ULL + 1;
}

__attribute__((destructor)) static void end(void) {
  const char* path = getenv("OGIVE_FAULT_COUNT");
  FILE* file = path ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", calls);
  fclose(file);
}

static int is(const char* name) { return strcmp(action, name) == 0; }

/* The error of this call, 0: none. Kills where that is asked for. */
static int fault(void) {
  ++calls;
  if (chosen == 0 || calls < chosen) return 0;
  if (calls == chosen) {
    if (is("kill")) kill(getpid(), SIGKILL);
    if (is("once")) return EIO;
  }
  if (is("space")) return ENOSPC;
  if (is("io")) return EIO;
  if (is("quota")) return EDQUOT;
  if (is("readonly")) return EROFS;
  if (is("access")) return EACCES;
  return 0;
}

static void after(void) {
  if (chosen > 0 && calls == chosen && is("after")) kill(getpid(), SIGKILL);
}

static int console(int descriptor) { return descriptor >= 0 && descriptor <= 2; }

int open(const char* path, int flags, ...) {
  REAL(int, open, const char*, int, ...);
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (!(flags & O_CREAT)) return real(path, flags, mode);
  errno = fault();
  if (errno) return -1;
  const int descriptor = real(path, flags, mode);
  after();
  return descriptor;
}

/* How much of a write is made: all, half, or none (-1, with the error). */
static ssize_t part(size_t size) {
  errno = fault();
  if (errno) return -1;
  const int now = chosen > 0 && calls == chosen;
  if (now && is("intr")) {
    errno = EINTR;
    return -1;
  }
  return now && (is("short") || is("half")) && size > 1 ? (ssize_t)(size / 2) : (ssize_t)size;
}

static ssize_t done(ssize_t written) {
  if (chosen > 0 && calls == chosen && is("half")) kill(getpid(), SIGKILL);
  after();
  return written;
}

ssize_t write(int descriptor, const void* data, size_t size) {
  REAL(ssize_t, write, int, const void*, size_t);
  if (console(descriptor)) return real(descriptor, data, size);
  const ssize_t wanted = part(size);
  return wanted < 0 ? -1 : done(real(descriptor, data, (size_t)wanted));
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  REAL(ssize_t, pwrite, int, const void*, size_t, off_t);
  const ssize_t wanted = part(size);
  return wanted < 0 ? -1 : done(real(descriptor, data, (size_t)wanted, offset));
}

#define WRAPPED(name, parameters, ...)   \
  int name parameters {                  \
    static int (*real) parameters;       \
    if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name); \
    errno = fault();                     \
    if (errno) return -1;                \
    const int result = real(__VA_ARGS__); \
    after();                             \
    return result;                       \
  }

WRAPPED(ftruncate, (int descriptor, off_t size), descriptor, size)
WRAPPED(fsync, (int descriptor), descriptor)
WRAPPED(rename, (const char* from, const char* to), from, to)
WRAPPED(remove, (const char* path), path)
WRAPPED(unlink, (const char* path), path)

/* Only where something was written: closing what was read cannot lose data. */
int close(int descriptor) {
  REAL(int, close, int);
  const int flags = console(descriptor) ? 0 : fcntl(descriptor, F_GETFL);
  struct stat status;
  const int written = flags != -1 && (flags & O_ACCMODE) != O_RDONLY && fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  if (!written) return real(descriptor);
  const int error = fault();
  const int result = real(descriptor);
  after();
  errno = error ? error : errno;
  return error ? -1 : result;
}

static long long jump(void) {
  if (clock_state == 0) return 0;
  clock_state = clock_state * 6364136223846793005ULL + 1442695040888963407ULL;
  if ((clock_state >> 33) % 4 != 0) return 0;
  return (long long)((clock_state >> 35) % 63072000) - 31536000;
}

int clock_gettime(clockid_t id, struct timespec* now) {
  REAL(int, clock_gettime, clockid_t, struct timespec*);
  const int result = real(id, now);
  if (result == 0) now->tv_sec += jump();
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  REAL(int, gettimeofday, struct timeval* restrict, void* restrict);
  const int result = real(now, zone);
  if (result == 0) now->tv_sec += jump();
  return result;
}

time_t time(time_t* at) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (at) *at = now.tv_sec;
  return now.tv_sec;
}
