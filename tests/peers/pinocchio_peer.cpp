// Pinocchio behind the C interface of a peer (README.md).
//
// Everything of Pinocchio that runs here is instantiated in this file, so the flags of this file are the flags of the
// algorithms: no library of Pinocchio is linked, and no template of it is declared extern.

#ifdef PINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION
#error "the algorithms would come from the wheel's library, compiled for any machine"
#endif

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <exception>
#include <iostream>
#include <limits>
#include <locale>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#ifndef PEER_NAME
#define PEER_NAME "pinocchio " PINOCCHIO_VERSION
#endif

#define PEER_API extern "C" __attribute__((visibility("default")))

namespace pin = pinocchio;
using boost::property_tree::ptree;
using Vector = Eigen::VectorXd;
using Input = Eigen::Map<const Vector>;

namespace
{

const char * const FLOATING_BASE = "__floating_base__";

struct Peer
{
  pin::Model model;
  pin::Data data;

  explicit Peer(const pin::Model & m)
  : model(m)
  , data(model)
  {
  }

  Input q(const double * x) const { return Input(x, model.nq); }
  Input v(const double * x) const { return Input(x, model.nv); }
};

// ---- URDF, as Pinocchio's own reader takes it, save that a continuous joint is one angle and that the order is the file's

std::string attribute(const ptree & element, const char * child, const char * key, const std::string & otherwise)
{
  const auto found = element.get_child_optional(child);
  return found ? found->get("<xmlattr>." + std::string(key), otherwise) : otherwise;
}

std::vector<double> numbers(const std::string & text)
{
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> result;
  for (double x; stream >> x;)
    result.push_back(x);
  return result;
}

Eigen::Vector3d three(const std::string & text)
{
  const std::vector<double> x = numbers(text);
  if (x.size() != 3)
    throw std::runtime_error("three numbers wanted, got \"" + text + "\"");
  return Eigen::Vector3d(x[0], x[1], x[2]);
}

double one(const ptree & element, const char * child, const char * key)
{
  const std::vector<double> x = numbers(attribute(element, child, key, "0"));
  return x.empty() ? 0.0 : x[0];
}

// R = Rz(yaw) Ry(pitch) Rx(roll)
pin::SE3 origin(const ptree & element)
{
  using Turn = Eigen::AngleAxisd;
  const Eigen::Vector3d xyz = three(attribute(element, "origin", "xyz", "0 0 0"));
  const Eigen::Vector3d rpy = three(attribute(element, "origin", "rpy", "0 0 0"));
  const Eigen::Matrix3d turn = Turn(rpy[2], Eigen::Vector3d::UnitZ()).toRotationMatrix()
                               * Turn(rpy[1], Eigen::Vector3d::UnitY()).toRotationMatrix()
                               * Turn(rpy[0], Eigen::Vector3d::UnitX()).toRotationMatrix();
  return pin::SE3(turn, xyz);
}

pin::Inertia inertia(const ptree & link)
{
  const auto found = link.get_child_optional("inertial");
  if (!found)
    return pin::Inertia::Zero();
  const auto i = [&](const char * key) { return one(*found, "inertia", key); };
  Eigen::Matrix3d tensor;
  tensor << i("ixx"), i("ixy"), i("ixz"), i("ixy"), i("iyy"), i("iyz"), i("ixz"), i("iyz"), i("izz");
  const pin::SE3 place = origin(*found);
  const Eigen::Matrix3d turned = place.rotation() * tensor * place.rotation().transpose();
  return pin::Inertia(one(*found, "mass", "value"), place.translation(), turned);
}

pin::JointModel joint_model(const std::string & type, const Eigen::Vector3d & axis)
{
  const bool x = axis == Eigen::Vector3d::UnitX(), y = axis == Eigen::Vector3d::UnitY(), z = axis == Eigen::Vector3d::UnitZ();
  if (type == "revolute" || type == "continuous")
  {
    if (x) return pin::JointModelRX();
    if (y) return pin::JointModelRY();
    if (z) return pin::JointModelRZ();
    return pin::JointModelRevoluteUnaligned(axis);
  }
  if (type == "prismatic")
  {
    if (x) return pin::JointModelPX();
    if (y) return pin::JointModelPY();
    if (z) return pin::JointModelPZ();
    return pin::JointModelPrismaticUnaligned(axis);
  }
  throw std::runtime_error("joint type " + type + " is not known here");
}

struct Reader
{
  pin::Model model;
  std::map<std::string, const ptree *> links;
  std::vector<const ptree *> joints;

  // `link` stands still in the frame of `joint`, at `place`
  void attach(const std::string & link, pin::JointIndex joint, const pin::SE3 & place)
  {
    const auto found = links.find(link);
    if (found == links.end())
      throw std::runtime_error("link " + link + " is missing");
    model.appendBodyToJoint(joint, inertia(*found->second), place);
    model.addBodyFrame(link, joint, place, 0);
    for (const ptree * element : joints)
    {
      if (attribute(*element, "parent", "link", "") != link)
        continue;
      const std::string type = element->get<std::string>("<xmlattr>.type");
      const std::string child = attribute(*element, "child", "link", "");
      const pin::SE3 there = place * origin(*element);
      if (type == "fixed")
      {
        attach(child, joint, there);
        continue;
      }
      const Eigen::Vector3d axis = three(attribute(*element, "axis", "xyz", "1 0 0")).normalized();
      const std::string name = element->get<std::string>("<xmlattr>.name");
      attach(child, model.addJoint(joint, joint_model(type, axis), there, name), pin::SE3::Identity());
    }
  }
};

pin::Model read(const char * path, bool floating)
{
  ptree tree;
  boost::property_tree::read_xml(path, tree, boost::property_tree::xml_parser::no_comments);
  const ptree & robot = tree.get_child("robot");
  Reader reader;
  std::map<std::string, bool> is_child;
  for (const auto & entry : robot)
  {
    if (entry.first == "link")
      reader.links[entry.second.get<std::string>("<xmlattr>.name")] = &entry.second;
    if (entry.first == "joint")
    {
      reader.joints.push_back(&entry.second);
      is_child[attribute(entry.second, "child", "link", "")] = true;
    }
  }
  std::string root;
  for (const auto & link : reader.links)
    if (!is_child.count(link.first))
      root = link.first;
  pin::JointIndex base = 0;
  if (floating)
    base = reader.model.addJoint(0, pin::JointModelFreeFlyer(), pin::SE3::Identity(), FLOATING_BASE);
  reader.attach(root, base, pin::SE3::Identity());
  return reader.model;
}

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
  pin::Model model = read(urdf_path, floating != 0);
  model.gravity.linear() = Eigen::Vector3d(gx, gy, gz);
  return new Peer(model);
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

PEER_API void peer_inverse_dynamics(void * handle, const double * q, const double * v, const double * a, double * tau)
{
  Peer & p = peer(handle);
  Eigen::Map<Vector>(tau, p.model.nv) = pin::rnea(p.model, p.data, p.q(q), p.v(v), p.v(a));
}

PEER_API void peer_placements(void * handle, const double * q)
{
  Peer & p = peer(handle);
  pin::forwardKinematics(p.model, p.data, p.q(q));
  pin::updateFramePlacements(p.model, p.data);
}

PEER_API void peer_mass_matrix(void * handle, const double * q, double * M)
{
  Peer & p = peer(handle);
  pin::crba(p.model, p.data, p.q(q));
  Eigen::Map<Eigen::MatrixXd> full(M, p.model.nv, p.model.nv);
  full = p.data.M.selfadjointView<Eigen::Upper>(); // only the upper triangle is computed
}

PEER_API void peer_forward_dynamics(void * handle, const double * q, const double * v, const double * tau, double * a)
{
  Peer & p = peer(handle);
  Eigen::Map<Vector>(a, p.model.nv) = pin::aba(p.model, p.data, p.q(q), p.v(v), p.v(tau));
}
