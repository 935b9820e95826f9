// Code that CasADi generated for some robots, behind the C interface of a peer (README.md). The table of robots is written by casadi_build.py.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#define PEER_API extern "C" __attribute__((visibility("default")))

namespace
{

using Code = int (*)(const double **, double **, long long *, double *, int);

struct Joint
{
  const char * name;
  int iq, iv, nq, nv;
};

// one function of one robot, with the length of its work array
struct Entry
{
  Code code;
  int work;
};

struct Robot
{
  std::uint64_t hash; // FNV-1a of the URDF
  bool floating;
  int nq, nv;
  std::vector<Joint> joints;
  std::map<std::string, Entry> functions;
};

} // namespace

#include "casadi_robots.inc"

// name, number of arguments: results of one row of numbers, or [nv][nv] by rows
#define PLAIN_FUNCTIONS(F) \
  F(inverse_dynamics, 3) F(mass_matrix, 1) F(forward_dynamics, 3) F(bias_forces, 2) F(gravity_torque, 1) F(mass_matrix_inverse, 1) \
  F(solve_mass_matrix, 2) F(coriolis_matrix, 2) F(kinetic_energy, 2) F(potential_energy, 1) F(center_of_mass, 1) \
  F(center_of_mass_velocity, 2) F(center_of_mass_acceleration, 3) F(centroidal_momentum, 2) F(centroidal_momentum_rate, 3)

// what stays inside until it is asked for
#define KEPT_FUNCTIONS(F) \
  F(inverse_dynamics_derivatives, 3) F(forward_dynamics_derivatives, 3) F(center_of_mass_jacobian, 1) F(centroidal_momentum_matrix, 1)

namespace
{

enum Name
{
#define NAME(name, takes) NAME_##name,
  PLAIN_FUNCTIONS(NAME) KEPT_FUNCTIONS(NAME) NAMES
};

const char * const names[] = {
#define TEXT(name, takes) #name,
  PLAIN_FUNCTIONS(TEXT) KEPT_FUNCTIONS(TEXT)
};

struct Peer
{
  const Robot & robot;
  std::array<Entry, NAMES> entries{};
  std::vector<double> work, kept; // of derivatives three square matrices by columns, else as it is read

  explicit Peer(const Robot & r)
  : robot(r)
  , kept(std::max(3 * r.nv, 6) * r.nv)
  {
    int longest = 0;
    for (int i = 0; i < NAMES; ++i)
    {
      const auto found = robot.functions.find(names[i]);
      if (found == robot.functions.end())
        continue;
      entries[i] = found->second;
      longest = std::max(longest, entries[i].work);
    }
    work.resize(longest);
  }

  void call(Name name, std::array<const double *, 3> arguments, double * out)
  {
    entries[name].code(arguments.data(), &out, nullptr, work.data(), 0);
  }

  void keep(Name name, std::array<const double *, 3> arguments)
  {
    const int n = robot.nv * robot.nv;
    double * results[] = {kept.data(), kept.data() + n, kept.data() + 2 * n};
    entries[name].code(arguments.data(), results, nullptr, work.data(), 0);
  }
};

Peer & peer(void * handle)
{
  return *static_cast<Peer *>(handle);
}

std::uint64_t hash_of(const char * path)
{
  std::ifstream file(path, std::ios::binary);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::istreambuf_iterator<char> c(file), end; c != end; ++c)
    hash = (hash ^ static_cast<unsigned char>(*c)) * 0x100000001b3u;
  return hash;
}

} // namespace

PEER_API const char * peer_name(void) { return PEER_NAME; }

PEER_API void * peer_open(const char * urdf_path, int floating, double gx, double gy, double gz)
{
  const std::uint64_t hash = hash_of(urdf_path);
  const bool standard = gx == 0 && gy == 0 && gz == -9.81;
  for (const Robot & robot : robots())
    if (robot.hash == hash && robot.floating == (floating != 0) && standard)
      return new Peer(robot);
  std::cerr << PEER_NAME << ": " << urdf_path << ": no code of this robot with this base and gravity\n";
  return nullptr;
}

PEER_API void peer_close(void * handle) { delete static_cast<Peer *>(handle); }
PEER_API int peer_nq(void * handle) { return peer(handle).robot.nq; }
PEER_API int peer_nv(void * handle) { return peer(handle).robot.nv; }
PEER_API int peer_joint_count(void * handle) { return static_cast<int>(peer(handle).robot.joints.size()); }
PEER_API const char * peer_joint_name(void * handle, int i) { return peer(handle).robot.joints[i].name; }
PEER_API int peer_joint_iq(void * handle, int i) { return peer(handle).robot.joints[i].iq; }
PEER_API int peer_joint_iv(void * handle, int i) { return peer(handle).robot.joints[i].iv; }
PEER_API int peer_joint_nq(void * handle, int i) { return peer(handle).robot.joints[i].nq; }
PEER_API int peer_joint_nv(void * handle, int i) { return peer(handle).robot.joints[i].nv; }

// whether the robot has code for it
PEER_API int peer_has(void * handle, const char * function)
{
  return peer(handle).robot.functions.count(function) != 0;
}

#define TAKES_1 const double * x
#define TAKES_2 TAKES_1, const double * y
#define TAKES_3 TAKES_2, const double * z
#define GIVEN_1 {x, nullptr, nullptr}
#define GIVEN_2 {x, y, nullptr}
#define GIVEN_3 {x, y, z}

#define PLAIN(name, takes) \
  PEER_API void peer_##name(void * handle, TAKES_##takes, double * out) { peer(handle).call(NAME_##name, GIVEN_##takes, out); }
#define KEPT(name, takes) \
  PEER_API void peer_##name(void * handle, TAKES_##takes) { peer(handle).keep(NAME_##name, GIVEN_##takes); }

PLAIN_FUNCTIONS(PLAIN)
KEPT_FUNCTIONS(KEPT)

PEER_API int peer_read(void * handle, const char * function, double * out)
{
  Peer & p = peer(handle);
  const int n = p.robot.nv;
  if (!peer_has(handle, function))
    return 0;
  const int rows = !std::strcmp(function, "center_of_mass_jacobian") ? 3 : !std::strcmp(function, "centroidal_momentum_matrix") ? 6 : 0;
  std::copy_n(p.kept.data(), rows * n, out);
  if (rows)
    return 1;
  if (!std::strstr(function, "derivatives"))
    return 0;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        *out++ = p.kept[(k * n + j) * n + i];
  return 1;
}
