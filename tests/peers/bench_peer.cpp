// Times the functions of one peer library:  bench_peer LIBRARY URDF fixed|floating
// 64 random states in turn, 41 batches of about a millisecond; prints the median batch in nanoseconds a call.
// Or, under callgrind, counts the instructions of each function that is there:  bench_peer LIBRARY URDF fixed|floating FUNCTION...

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <random>
#include <string>
#include <vector>
#include <xmmintrin.h>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name)
#endif

namespace
{

constexpr int STATES = 64, BATCHES = 41;
void * library;

template<typename F>
F * symbol(const char * name)
{
  void * found = dlsym(library, name);
  if (!found)
  {
    std::fprintf(stderr, "%s\n", dlerror());
    std::exit(1);
  }
  return reinterpret_cast<F *>(found);
}

// A function of the peer's robot: what peer_entry says, or peer_<name>.
template<typename F>
F * function(void * peer, const std::string & name)
{
  using Entry = const void * (void *, const char *);
  auto * entry = reinterpret_cast<Entry *>(dlsym(library, "peer_entry"));
  return entry ? reinterpret_cast<F *>(const_cast<void *>(entry(peer, name.c_str()))) : symbol<F>(("peer_" + name).c_str());
}

template<typename Call>
double nanoseconds(Call call)
{
  using Clock = std::chrono::steady_clock;
  const auto batch = [&](int rounds) {
    const auto start = Clock::now();
    for (int round = 0; round < rounds; ++round)
      for (int state = 0; state < STATES; ++state)
        call(state);
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / rounds / STATES;
  };
  const int rounds = std::max(1, static_cast<int>(1e6 / STATES / std::max(1.0, batch(20))));
  std::vector<double> times;
  for (int i = 0; i < BATCHES; ++i)
    times.push_back(batch(rounds));
  std::nth_element(times.begin(), times.begin() + BATCHES / 2, times.end());
  return times[BATCHES / 2];
}

} // namespace

int main(int count, char ** words)
{
  if (count < 4)
  {
    std::fprintf(stderr, "bench_peer LIBRARY URDF fixed|floating [FUNCTION...]\n");
    return 2;
  }
  const unsigned before = _mm_getcsr();
  library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
  if (!library)
  {
    std::fprintf(stderr, "%s\n", dlerror());
    return 1;
  }
  const bool floating = !std::strcmp(words[3], "floating");
  void * peer = symbol<void *(const char *, int, double, double, double)>("peer_open")(words[2], floating, 0, 0, -9.81);
  if (!peer)
    return 3;
  const int nq = symbol<int(void *)>("peer_nq")(peer), nv = symbol<int(void *)>("peer_nv")(peer);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<std::vector<double>> q(STATES), v(STATES), a(STATES);
  for (int i = 0; i < STATES; ++i)
  {
    for (int k = 0; k < nq; ++k)
      q[i].push_back(uniform(random));
    for (int k = 0; k < nv; ++k)
      v[i].push_back(uniform(random)), a[i].push_back(uniform(random));
    if (floating)
    {
      double * u = &q[i][3];
      const double length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + u[3] * u[3]);
      for (int k = 0; k < 4; ++k)
        u[k] /= length;
    }
  }
  std::vector<double> out(nv * nv);
  auto * has = reinterpret_cast<int (*)(void *, const char *)>(dlsym(library, "peer_has"));
  const bool told = dlsym(library, "peer_entry");
  const auto there = [&](const char * name) {
    return (told || dlsym(library, (std::string("peer_") + name).c_str())) && (!has || has(peer, name));
  };
  if (count > 4)
  {
    for (int word = 4; word < count; ++word)
    {
      if (!there(words[word]))
        continue;
      // Functions that keep their results leave the last argument alone.
      const std::string name = words[word];
      auto * one = function<void(void *, const double *, double *)>(peer, name);
      auto * three = function<void(void *, const double *, const double *, const double *, double *)>(peer, name);
      const bool lone = name == "mass_matrix";
      const auto all = [&] {
        for (int i = 0; i < STATES; ++i)
          lone ? one(peer, q[i].data(), out.data()) : three(peer, q[i].data(), v[i].data(), a[i].data(), out.data());
      };
      all(); // what is done at the first call only is not counted
      CALLGRIND_START_INSTRUMENTATION; // for the first function, and for good
      CALLGRIND_ZERO_STATS;
      all();
      CALLGRIND_DUMP_STATS_AT(words[word]);
    }
    return 0;
  }
  auto * id = function<void(void *, const double *, const double *, const double *, double *)>(peer, "inverse_dynamics");
  auto * fd = function<void(void *, const double *, const double *, const double *, double *)>(peer, "forward_dynamics");
  auto * mass = function<void(void *, const double *, double *)>(peer, "mass_matrix");
  using Kept = void(void *, const double *, const double *, const double *);
  std::printf("%s\n", symbol<const char *(void)>("peer_name")());
  std::printf("  nv %d: inverse dynamics %.0f", nv, nanoseconds([&](int i) { id(peer, q[i].data(), v[i].data(), a[i].data(), out.data()); }));
  std::printf(", forward dynamics %.0f", nanoseconds([&](int i) { fd(peer, q[i].data(), v[i].data(), a[i].data(), out.data()); }));
  std::printf(", mass matrix %.0f", nanoseconds([&](int i) { mass(peer, q[i].data(), out.data()); }));
  if (there("placements"))
  {
    auto * placements = function<void(void *, const double *)>(peer, "placements");
    std::printf(", placements %.0f", nanoseconds([&](int i) { placements(peer, q[i].data()); }));
  }
  for (const std::string name : {"inverse_dynamics_derivatives", "forward_dynamics_derivatives"})
    if (there(name.c_str()))
    {
      auto * slopes = function<Kept>(peer, name);
      std::printf(", %s %.0f", name.c_str(), nanoseconds([&](int i) { slopes(peer, q[i].data(), v[i].data(), a[i].data()); }));
    }
  std::printf(" ns\n");
  symbol<void(void *)>("peer_close")(peer);
  // denormals are numbers: a library that switches them off would change everybody else's results and times
  if ((_mm_getcsr() & 0x8040) != (before & 0x8040))
    return std::fprintf(stderr, "%s changed the floating-point mode of the process\n", words[1]), 1;
  return 0;
}
