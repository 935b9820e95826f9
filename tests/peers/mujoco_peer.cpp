// MuJoCo behind the C interface of a peer (README.md): its steps for kinematics and smooth dynamics one by one, without sensors, contacts,
// limits, springs, tendons or actuators.
//
// Its free joint moves by (velocity of the origin in world axes; angular velocity in body axes), a peer's by (linear; angular) in body axes:
// with R the base's rotation, v' = R v, a' = R (a + w x v), f' = R f for the linear parts, which is done inside the timed calls.

#include <mujoco/mujoco.h>

#include <cstring>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#define PEER_API extern "C" __attribute__((visibility("default")))

namespace
{

struct Deleter
{
  void operator()(mjSpec * x) const { mj_deleteSpec(x); }
  void operator()(mjModel * x) const { mj_deleteModel(x); }
  void operator()(mjData * x) const { mj_deleteData(x); }
};

template<typename T>
using Owned = std::unique_ptr<T, Deleter>;

// removes what only collides or is seen, and would have its meshes loaded
void strip(mjSpec * spec)
{
  for (const mjtObj kind : {mjOBJ_GEOM, mjOBJ_MESH})
  {
    std::vector<mjsElement *> all;
    for (mjsElement * x = mjs_firstElement(spec, kind); x; x = mjs_nextElement(spec, x))
      all.push_back(x);
    for (mjsElement * x : all)
      mjs_delete(spec, x);
  }
}

Owned<mjModel> read(const char * path, bool floating, double gx, double gy, double gz)
{
  char error[1000] = "";
  const Owned<mjSpec> spec(mj_parseXML(path, nullptr, error, sizeof error));
  if (!spec)
    throw std::runtime_error(error);
  strip(spec.get());
  spec->compiler.fusestatic = 1;
  spec->compiler.balanceinertia = 0;
  spec->compiler.boundmass = spec->compiler.boundinertia = 0;
  if (floating)
  {
    mjsElement * first = mjs_firstChild(mjs_findBody(spec.get(), "world"), mjOBJ_BODY, 0);
    mjsBody * root = first ? mjs_asBody(first) : nullptr;
    if (!root)
      throw std::runtime_error("no root body");
    mjs_setName(mjs_addFreeJoint(root)->element, "__floating_base__");
  }
  Owned<mjModel> model(mj_compile(spec.get(), nullptr));
  if (!model)
    throw std::runtime_error(mjs_getError(spec.get()));
  const mjtNum gravity[] = {gx, gy, gz};
  mju_copy3(model->opt.gravity, gravity);
  model->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_CONTACT | mjDSBL_LIMIT | mjDSBL_EQUALITY | mjDSBL_FRICTIONLOSS | mjDSBL_ACTUATION;
  for (mjtNum * x : {model->dof_armature, model->dof_damping, model->dof_frictionloss})
    mju_zero(x, static_cast<int>(model->nv));
  return model;
}

struct Peer
{
  Owned<mjModel> model;
  Owned<mjData> data;
  bool floating;
  int nq, nv;
  const mjtNum * R; // of the base, row by row; mj_kinematics renews it
  std::vector<mjtNum> force;

  Peer(Owned<mjModel> m, bool f)
  : model(std::move(m))
  , data(mj_makeData(model.get()))
  , floating(f)
  , nq(static_cast<int>(model->nq))
  , nv(static_cast<int>(model->nv))
  , R(f ? data->xmat + 9 * model->jnt_bodyid[0] : nullptr)
  , force(nv)
  {
    if (!data)
      throw std::runtime_error("no data");
  }

  // placements, and all about the centre of mass
  void place(const double * q)
  {
    mju_copy(data->qpos, q, nq);
    if (floating) // x y z w to w x y z
    {
      data->qpos[3] = q[6];
      mju_copy(data->qpos + 4, q + 3, 3);
    }
    mj_kinematics(model.get(), data.get());
    mj_comPos(model.get(), data.get());
  }

  // the linear part of the base turned into world axes, the rest as it is
  void to_world(mjtNum * out, const double * x) const
  {
    mju_copy(out, x, nv);
    if (floating)
      mju_mulMatVec3(out, R, x);
  }

  void to_body(double * out, const mjtNum * x) const
  {
    mju_copy(out, x, nv);
    if (floating)
      mju_mulMatTVec3(out, R, x);
  }

  void move(const double * v)
  {
    to_world(data->qvel, v);
    mj_comVel(model.get(), data.get());
  }
};

Peer & peer(void * handle)
{
  return *static_cast<Peer *>(handle);
}

} // namespace

PEER_API const char * peer_name(void) { return PEER_NAME; }

PEER_API void * peer_open(const char * urdf_path, int floating, double gx, double gy, double gz)
try
{
  return new Peer(read(urdf_path, floating != 0, gx, gy, gz), floating != 0);
}
catch (const std::exception & error)
{
  std::cerr << PEER_NAME << ": " << urdf_path << ": " << error.what() << "\n";
  return nullptr;
}

PEER_API void peer_close(void * handle) { delete static_cast<Peer *>(handle); }
PEER_API int peer_nq(void * handle) { return peer(handle).nq; }
PEER_API int peer_nv(void * handle) { return peer(handle).nv; }
PEER_API int peer_joint_count(void * handle) { return static_cast<int>(peer(handle).model->njnt); }
PEER_API const char * peer_joint_name(void * handle, int i) { return mj_id2name(peer(handle).model.get(), mjOBJ_JOINT, i); }
PEER_API int peer_joint_iq(void * handle, int i) { return peer(handle).model->jnt_qposadr[i]; }
PEER_API int peer_joint_iv(void * handle, int i) { return peer(handle).model->jnt_dofadr[i]; }
PEER_API int peer_joint_nq(void * handle, int i) { return peer(handle).model->jnt_type[i] == mjJNT_FREE ? 7 : 1; }
PEER_API int peer_joint_nv(void * handle, int i) { return peer(handle).model->jnt_type[i] == mjJNT_FREE ? 6 : 1; }

PEER_API void peer_inverse_dynamics(void * handle, const double * q, const double * v, const double * a, double * tau)
{
  Peer & p = peer(handle);
  p.place(q);
  p.move(v);
  if (p.floating)
  {
    double turned[3];
    mju_cross(turned, v + 3, v);
    mju_addTo3(turned, a);
    mju_copy(p.data->qacc, a, p.nv);
    mju_mulMatVec3(p.data->qacc, p.R, turned);
  }
  else
    mju_copy(p.data->qacc, a, p.nv);
  mj_rne(p.model.get(), p.data.get(), 1, p.force.data());
  p.to_body(tau, p.force.data());
}

PEER_API void peer_mass_matrix(void * handle, const double * q, double * M)
{
  Peer & p = peer(handle);
  p.place(q);
  mj_makeM(p.model.get(), p.data.get());
  mj_fullM(p.model.get(), p.data.get(), M);
  if (!p.floating)
    return;
  const int n = p.nv;
  for (int i = 0; i < n; ++i) // the first three columns of each row, and then the first three rows, which are symmetric to them
    mju_mulMatTVec3(M + i * n, p.R, M + i * n);
  for (int j = 0; j < n; ++j)
  {
    const double column[] = {M[j], M[n + j], M[2 * n + j]};
    double turned[3];
    mju_mulMatTVec3(turned, p.R, column);
    M[j] = turned[0], M[n + j] = turned[1], M[2 * n + j] = turned[2];
  }
}

PEER_API void peer_forward_dynamics(void * handle, const double * q, const double * v, const double * tau, double * a)
{
  Peer & p = peer(handle);
  mjModel * m = p.model.get();
  mjData * d = p.data.get();
  p.place(q);
  mj_makeM(m, d);
  mj_factorM(m, d);
  p.move(v);
  mj_rne(m, d, 0, d->qfrc_bias);
  p.to_world(p.force.data(), tau);
  mju_subFrom(p.force.data(), d->qfrc_bias, p.nv);
  mj_solveM(m, d, d->qacc, p.force.data(), 1);
  p.to_body(a, d->qacc);
  if (p.floating)
  {
    double turned[3];
    mju_cross(turned, v + 3, v);
    mju_subFrom3(a, turned);
  }
}

namespace
{

struct Method
{
  const char * name;
  int integrator, order, evaluations;
};

constexpr Method methods[] = {{"RK4", mjINT_RK4, 4, 4}, {"Euler", mjINT_EULER, 1, 1}, {"implicitfast", mjINT_IMPLICITFAST, 1, 1}};

const Method * method(int i)
{
  return i >= 0 && i < static_cast<int>(std::size(methods)) ? methods + i : nullptr;
}

} // namespace

PEER_API const char * peer_method_name(int i) { return method(i) ? method(i)->name : nullptr; }
PEER_API int peer_method_order(int i) { return method(i) ? method(i)->order : 0; }
PEER_API int peer_method_evaluations(int i) { return method(i) ? method(i)->evaluations : 0; }

// So many steps, all of them in MuJoCo's own loop: from (q, v) to (q_end, v_end), no torques.
PEER_API int peer_simulate(
  void * handle, int method_number, const double * q, const double * v, double step, int steps, double * q_end, double * v_end)
{
  const Method * way = method(method_number);
  if (!way)
    return 0;
  Peer & p = peer(handle);
  mjModel * m = p.model.get();
  mjData * d = p.data.get();
  mju_user_warning = [](const char *) {}; // it would write a file where it stands; who asks for too few steps is told below
  const mjOption kept = m->opt;
  m->opt.integrator = way->integrator;
  m->opt.timestep = step;
  mj_resetData(m, d);
  p.place(q);
  p.to_world(d->qvel, v);
  for (int i = 0; i < steps; ++i)
    mj_step(m, d);
  m->opt = kept;
  mju_copy(q_end, d->qpos, p.nq);
  if (p.floating) // w x y z to x y z w
  {
    mju_copy(q_end + 3, d->qpos + 4, 3);
    q_end[6] = d->qpos[3];
  }
  mj_kinematics(m, d);
  p.to_body(v_end, d->qvel);
  return d->warning[mjWARN_BADQACC].number == 0 && d->warning[mjWARN_BADQPOS].number == 0;
}
