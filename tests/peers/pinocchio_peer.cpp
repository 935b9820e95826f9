// Pinocchio behind the C interface of a peer (README.md).
//
// Everything of Pinocchio that runs here is instantiated in this file, so the flags of this file are the flags of the
// algorithms: no library of Pinocchio is linked, and no template of it is declared extern.

#ifdef PINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION
#error "the algorithms would come from the wheel's library, compiled for any machine"
#endif

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/center-of-mass.hpp>
#include <pinocchio/algorithm/centroidal.hpp>
#include <pinocchio/algorithm/cholesky.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/energy.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio_model.hpp"

#include <exception>
#include <functional>
#include <iostream>

#ifndef PEER_NAME
#define PEER_NAME "pinocchio " PINOCCHIO_VERSION
#endif

#define PEER_API extern "C" __attribute__((visibility("default")))

namespace
{

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Six = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix6x = pin::Data::Matrix6x;
using Input = Eigen::Map<const Vector>;

constexpr pin::ReferenceFrame body = pin::LOCAL, world = pin::WORLD, world_aligned = pin::LOCAL_WORLD_ALIGNED;

struct Peer
{
  pin::Model model;
  pin::Data data;
  std::vector<pin::FrameIndex> frames; // all, in the order of the file, or those that were chosen
  PINOCCHIO_ALIGNED_STD_VECTOR(pin::Force) forces; // on each joint
  PINOCCHIO_ALIGNED_STD_VECTOR(pin::Motion) motions; // of each frame
  std::vector<Matrix6x> jacobians; // of each frame
  std::vector<Matrix6> inertias; // of each frame
  Vector zero;

  Peer(const pin::Model & m, const std::vector<pin::FrameIndex> & f)
  : model(m)
  , data(model)
  , forces(model.njoints, pin::Force::Zero())
  , zero(Vector::Zero(model.nv))
  {
    choose(f);
  }

  void choose(const std::vector<pin::FrameIndex> & f)
  {
    frames = f;
    motions.assign(f.size(), pin::Motion::Zero());
    jacobians.assign(f.size(), Matrix6x::Zero(6, model.nv));
    inertias.assign(f.size(), Matrix6::Zero());
  }

  Input q(const double * x) const { return Input(x, model.nq); }
  Input v(const double * x) const { return Input(x, model.nv); }

  // wrenches on the frames, in their axes: what Pinocchio wants to know of each joint
  const PINOCCHIO_ALIGNED_STD_VECTOR(pin::Force) & carried(const double * wrenches)
  {
    for (pin::Force & force : forces)
      force.setZero();
    for (std::size_t k = 0; k < frames.size(); ++k)
    {
      const Eigen::Map<const Six> w(wrenches + 6 * k);
      const pin::Frame & frame = model.frames[frames[k]];
      forces[frame.parentJoint] += frame.placement.act(pin::Force(w.tail<3>(), w.head<3>()));
    }
    return forces;
  }
};

Peer & peer(void * handle)
{
  return *static_cast<Peer *>(handle);
}

// joint 0 is the universe
pin::JointIndex index(int i)
{
  return static_cast<pin::JointIndex>(i) + 1;
}

} // namespace

PEER_API const char * peer_name(void)
{
  return PEER_NAME;
}

PEER_API void * peer_open(const char * urdf_path, int floating, double gx, double gy, double gz)
try
{
  auto [model, frames] = read(urdf_path, floating != 0);
  model.gravity.linear() = Eigen::Vector3d(gx, gy, gz);
  return new Peer(model, frames);
}
catch (const std::exception & error)
{
  std::cerr << PEER_NAME << ": " << urdf_path << ": " << error.what() << "\n";
  return nullptr;
}

PEER_API void peer_close(void * handle)
{
  delete static_cast<Peer *>(handle);
}

PEER_API int peer_nq(void * handle)
{
  return peer(handle).model.nq;
}

PEER_API int peer_nv(void * handle)
{
  return peer(handle).model.nv;
}

PEER_API int peer_joint_count(void * handle)
{
  return peer(handle).model.njoints - 1;
}

PEER_API const char * peer_joint_name(void * handle, int i)
{
  return peer(handle).model.names[index(i)].c_str();
}

PEER_API int peer_joint_iq(void * handle, int i)
{
  return peer(handle).model.idx_qs[index(i)];
}

PEER_API int peer_joint_iv(void * handle, int i)
{
  return peer(handle).model.idx_vs[index(i)];
}

PEER_API int peer_joint_nq(void * handle, int i)
{
  return peer(handle).model.nqs[index(i)];
}

PEER_API int peer_joint_nv(void * handle, int i)
{
  return peer(handle).model.nvs[index(i)];
}

PEER_API int peer_frame_count(void * handle)
{
  return static_cast<int>(peer(handle).frames.size());
}

PEER_API const char * peer_frame_name(void * handle, int i)
{
  Peer & p = peer(handle);
  return p.model.frames[p.frames[i]].name.c_str();
}

PEER_API int peer_choose_frames(void * handle, int count, const char * const * names)
{
  Peer & p = peer(handle);
  std::vector<pin::FrameIndex> frames;
  for (int i = 0; i < count; ++i)
  {
    if (!p.model.existFrame(names[i], pin::BODY))
      return 0;
    frames.push_back(p.model.getFrameId(names[i], pin::BODY));
  }
  p.choose(frames);
  return 1;
}

#include "pinocchio_functions.hpp"
#include "pinocchio_read.hpp"
