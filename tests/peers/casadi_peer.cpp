// Code that CasADi generated for some robots, behind the C interface of a peer (README.md). The table of robots is written by casadi_build.py.

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

namespace
{

struct Peer
{
  const Robot & robot;
  Entry inverse, mass, forward, inverse_slopes, forward_slopes;
  std::vector<double> work, slopes; // three square matrices, by columns

  explicit Peer(const Robot & r)
  : robot(r)
  , inverse(find("inverse_dynamics"))
  , mass(find("mass_matrix"))
  , forward(find("forward_dynamics"))
  , inverse_slopes(find("inverse_dynamics_derivatives"))
  , forward_slopes(find("forward_dynamics_derivatives"))
  , slopes(3 * r.nv * r.nv)
  {
    int longest = 0;
    for (const Entry & e : {inverse, mass, forward, inverse_slopes, forward_slopes})
      longest = e.work > longest ? e.work : longest;
    work.resize(longest);
  }

  Entry find(const char * name) const
  {
    const auto found = robot.functions.find(name);
    return found == robot.functions.end() ? Entry{nullptr, 0} : found->second;
  }

  void differentiate(const Entry & entry, const double * x, const double * y, const double * z)
  {
    const int n = robot.nv * robot.nv;
    const double * arguments[] = {x, y, z};
    double * results[] = {slopes.data(), slopes.data() + n, slopes.data() + 2 * n};
    if (entry.code)
      entry.code(arguments, results, nullptr, work.data(), 0);
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

PEER_API void peer_inverse_dynamics(void * handle, const double * q, const double * v, const double * a, double * tau)
{
  Peer & p = peer(handle);
  const double * arguments[] = {q, v, a};
  p.inverse.code(arguments, &tau, nullptr, p.work.data(), 0);
}

PEER_API void peer_mass_matrix(void * handle, const double * q, double * M)
{
  Peer & p = peer(handle);
  p.mass.code(&q, &M, nullptr, p.work.data(), 0);
}

PEER_API void peer_forward_dynamics(void * handle, const double * q, const double * v, const double * tau, double * a)
{
  Peer & p = peer(handle);
  const double * arguments[] = {q, v, tau};
  p.forward.code(arguments, &a, nullptr, p.work.data(), 0);
}

PEER_API void peer_inverse_dynamics_derivatives(void * handle, const double * q, const double * v, const double * a)
{
  peer(handle).differentiate(peer(handle).inverse_slopes, q, v, a);
}

PEER_API void peer_forward_dynamics_derivatives(void * handle, const double * q, const double * v, const double * tau)
{
  peer(handle).differentiate(peer(handle).forward_slopes, q, v, tau);
}

// whether the robot has code for it
PEER_API int peer_has(void * handle, const char * function)
{
  return peer(handle).robot.functions.count(function) != 0;
}

PEER_API int peer_read(void * handle, const char * function, double * out)
{
  Peer & p = peer(handle);
  if (!peer_has(handle, function) || !std::strstr(function, "derivatives"))
    return 0;
  const int n = p.robot.nv;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        *out++ = p.slopes[(k * n + j) * n + i];
  return 1;
}
