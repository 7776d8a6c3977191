/* Preloaded into programs (LD_PRELOAD): their CLOCK_REALTIME is off by
 *   HYDRO_CLOCK_OFFSET_S + HYDRO_CLOCK_DRIFT x the time since the start + HYDRO_CLOCK_STEP_S from
 * HYDRO_CLOCK_STEP_AFTER_S on, as on a host whose clock is wrong, drifts or is set while the program runs.
 * CLOCK_MONOTONIC is left alone, as there. (A time namespace shifts only the monotonic and the boot clock.)
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static double Variable(const char* name) {
  const char* text = getenv(name);
  return text ? atof(text) : 0;
}

static double offset, drift, step, step_after, started;

static double Monotonic(void) {
  struct timespec now;
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

__attribute__((constructor)) static void Prepare(void) {
  offset = Variable("HYDRO_CLOCK_OFFSET_S");
  drift = Variable("HYDRO_CLOCK_DRIFT");
  step = Variable("HYDRO_CLOCK_STEP_S");
  step_after = Variable("HYDRO_CLOCK_STEP_AFTER_S");
  started = Monotonic();
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  const int result = (int)syscall(SYS_clock_gettime, clock, time);
  if (result != 0 || (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE)) return result;
  const double age = Monotonic() - started;
  const double shift = offset + drift * age + (step != 0 && age >= step_after ? step : 0);
  const double whole = floor(shift);
  time->tv_sec += (time_t)whole;
  time->tv_nsec += (long)((shift - whole) * 1e9);
  if (time->tv_nsec >= 1000000000L) {
    time->tv_nsec -= 1000000000L;
    ++time->tv_sec;
  }
  return 0;
}

int gettimeofday(struct timeval* restrict time, void* restrict zone) {
  (void)zone;
  struct timespec now;
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return result;
}

time_t time(time_t* out) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (out) *out = now.tv_sec;
  return now.tv_sec;
}
