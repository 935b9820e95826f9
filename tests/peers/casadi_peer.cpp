// Code that CasADi generated for some robots, behind the C interface of a peer (README.md). The table of robots is written by casadi_build.py, and so
// is an entry for each function: CasADi's code is inlined there, so that whoever calls it calls nothing else.

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#define PEER_API extern "C" __attribute__((visibility("default")))

namespace
{

struct Joint
{
  const char * name;
  int iq, iv, nq, nv;
};

// One output of a function that keeps its result: where each of its numbers stands in the registry's layout.
struct Output
{
  int base; // numbers of the outputs before it there
  bool symmetric; // its lower triangle is the upper one's
  std::vector<int> places;
};

// One function of one robot. `outputs`: none of what is written to the last argument.
struct Function
{
  const void * entry;
  int work; // length of its work array
  std::vector<Output> outputs;
};

struct Robot
{
  std::uint64_t hash; // FNV-1a of the URDF
  bool floating;
  int nq, nv;
  std::vector<Joint> joints;
  std::map<std::string, Function> functions;
};

} // namespace

#include "casadi_robots.inc"

namespace
{

// What entries get as their first argument: it begins as casadi_build.py's `struct head` does.
struct Peer
{
  std::array<double *, 3> results;
  double * work;
  const Robot & robot;
  std::vector<double> numbers, room;

  explicit Peer(const Robot & r)
  : robot(r)
  {
    std::size_t longest = 6 * r.nv;
    int most = 0;
    for (const auto & function : r.functions)
    {
      most = std::max(most, function.second.work);
      for (const Output & output : function.second.outputs)
        longest = std::max(longest, output.places.size());
    }
    numbers.resize(results.size() * longest);
    room.resize(most);
    for (std::size_t k = 0; k < results.size(); ++k)
      results[k] = numbers.data() + k * longest;
    work = room.data();
  }

  const Function * function(const char * name) const
  {
    const auto found = robot.functions.find(name);
    return found == robot.functions.end() ? nullptr : &found->second;
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
PEER_API int peer_has(void * handle, const char * function) { return peer(handle).function(function) != nullptr; }

PEER_API const void * peer_entry(void * handle, const char * function)
{
  const Function * found = peer(handle).function(function);
  return found ? found->entry : nullptr;
}

PEER_API int peer_keeps(void * handle, const char * function)
{
  const Function * found = peer(handle).function(function);
  return found && !found->outputs.empty();
}

PEER_API int peer_read(void * handle, const char * function, double * out)
{
  Peer & p = peer(handle);
  const Function * found = p.function(function);
  if (!found || found->outputs.empty())
    return 0;
  const int n = p.robot.nv;
  for (std::size_t k = 0; k < found->outputs.size(); ++k)
  {
    const Output & output = found->outputs[k];
    const int end = k + 1 < found->outputs.size() ? found->outputs[k + 1].base : output.base;
    std::fill(out + output.base, out + std::max(end, output.base + (output.symmetric ? n * n : 0)), 0.0);
    for (std::size_t i = 0; i < output.places.size(); ++i)
    {
      const int place = output.places[i];
      out[output.base + place] = p.results[k][i];
      if (output.symmetric)
        out[output.base + place % n * n + place / n] = p.results[k][i];
    }
  }
  return 1;
}
