// A URDF, as Pinocchio's own reader takes it, save that a continuous joint is one angle, that `spherical` and `floating` joints are known,
// and that the order is the file's.
#pragma once

#include <pinocchio/multibody.hpp>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <locale>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pin = pinocchio;

namespace
{

using boost::property_tree::ptree;

const char * const FLOATING_BASE = "__floating_base__";

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
  if (type == "spherical") return pin::JointModelSpherical();
  if (type == "floating") return pin::JointModelFreeFlyer();
  throw std::runtime_error("joint type " + type + " is not known here");
}

struct Reader
{
  pin::Model model;
  std::map<std::string, const ptree *> links;
  std::vector<std::string> order; // of the links in the file
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

// the model, and its frames in the order of the file's links
std::pair<pin::Model, std::vector<pin::FrameIndex>> read(const char * path, bool floating)
{
  ptree tree;
  boost::property_tree::read_xml(path, tree, boost::property_tree::xml_parser::no_comments);
  const ptree & robot = tree.get_child("robot");
  Reader reader;
  std::map<std::string, bool> is_child;
  for (const auto & entry : robot)
  {
    if (entry.first == "link")
    {
      reader.order.push_back(entry.second.get<std::string>("<xmlattr>.name"));
      reader.links[reader.order.back()] = &entry.second;
    }
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
  std::vector<pin::FrameIndex> frames;
  for (const std::string & link : reader.order)
    frames.push_back(reader.model.getFrameId(link, pin::BODY));
  return {reader.model, frames};
}

} // namespace
