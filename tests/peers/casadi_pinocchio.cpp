// C code by CasADi of Pinocchio's algorithms: its templates run on casadi::SX for one robot, each function is written to <folder>/<robot>_<function>_code.c,
// and what that took is printed as JSON. The wheel of Pinocchio has the headers that this needs, though no pinocchio.casadi. Functions of more
// operations than MOST are left out.
//
//     casadi_pinocchio FOLDER ROBOT URDF fixed|floating MOST [FUNCTION...]

#include <pinocchio/autodiff/casadi.hpp>

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/center-of-mass.hpp>
#include <pinocchio/algorithm/centroidal.hpp>
#include <pinocchio/algorithm/cholesky.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/energy.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio_model.hpp"

#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <iostream>
#include <set>

namespace
{

using SX = ::casadi::SX;
using Model = pin::ModelTpl<SX>;
using Data = pin::DataTpl<SX>;
using Vector = Model::VectorXs;
using Matrix = Data::MatrixXs;
using Outputs = std::vector<SX>;
using Clock = std::chrono::steady_clock;

constexpr double EXACT = 1e-15; // numbers this near to 0, 1 or -1 are meant to be that

double exact(double x)
{
  return std::abs(x - std::round(x)) < EXACT && std::abs(x) < 1.5 ? std::round(x) : x;
}

template<typename M>
M exact_all(const M & m)
{
  return m.unaryExpr([](double x) { return exact(x); });
}

// Without the rounding of right angles, so that CasADi folds zeros and ones.
pin::Model cleaned(pin::Model model)
{
  for (pin::SE3 & place : model.jointPlacements)
    place = pin::SE3(exact_all(place.rotation()), exact_all(place.translation()));
  for (pin::Inertia & inertia : model.inertias)
  {
    const pin::Symmetric3::Vector6 moments = exact_all(inertia.inertia().data());
    inertia = pin::Inertia(inertia.mass(), exact_all(inertia.lever()), pin::Symmetric3(moments));
  }
  return model;
}

Vector elements(const SX & x)
{
  Vector result(x.numel());
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result[i] = x(i);
  return result;
}

// dense, by columns
template<typename M>
SX plain(const Eigen::MatrixBase<M> & m)
{
  std::vector<SX> all;
  for (Eigen::Index j = 0; j < m.cols(); ++j)
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      all.push_back(m(i, j));
  return SX::reshape(densify(SX::vertcat(all)), m.rows(), m.cols());
}

// without zeros
template<typename M>
SX sparse(const Eigen::MatrixBase<M> & m)
{
  return SX::sparsify(plain(m));
}

// its upper triangle
SX symmetric(const Matrix & m)
{
  return SX::sparsify(SX::triu(plain(m)));
}

// by rows, (linear; angular) turned to (angular; linear)
template<typename M>
SX swapped_rows(const M & m)
{
  Matrix turned(m.cols(), 6);
  turned << m.template bottomRows<3>().transpose(), m.template topRows<3>().transpose();
  return plain(turned);
}

// one way to compute a function
using Way = std::function<Outputs(Data &)>;

struct Task
{
  std::string function;
  std::vector<SX> arguments;
  std::vector<Way> ways; // that with the fewest operations is taken
};

struct Robot
{
  Model model;
  SX sq, sv, sa, stau; // symbols
  Vector q, v, a, tau; // their elements

  explicit Robot(const pin::Model & numbers)
  : model(cleaned(numbers).cast<SX>())
  , sq(SX::sym("q", model.nq))
  , sv(SX::sym("v", model.nv))
  , sa(SX::sym("a", model.nv))
  , stau(SX::sym("tau", model.nv))
  , q(elements(sq))
  , v(elements(sv))
  , a(elements(sa))
  , tau(elements(stau))
  {
  }

  Outputs mass(Data & d, pin::Convention convention) const { return {symmetric(pin::crba(model, d, q, convention))}; }
  Outputs forward(Data & d, pin::Convention convention) const { return {plain(pin::aba(model, d, q, v, tau, convention))}; }

  // M⁻¹ b by Cholesky's factors, which keep the zeros of branches
  Outputs solved(Data & d, Vector b) const
  {
    pin::crba(model, d, q);
    pin::cholesky::decompose(model, d);
    pin::cholesky::solve(model, d, b);
    return {plain(b)};
  }

  Outputs forward_by_mass(Data & d) const
  {
    Data other(model);
    return solved(d, tau - pin::nonLinearEffects(model, other, q, v));
  }

  Outputs inverse_slopes(Data & d) const
  {
    pin::computeRNEADerivatives(model, d, q, v, a);
    return {sparse(d.dtau_dq), sparse(d.dtau_dv), symmetric(d.M)};
  }

  Outputs forward_slopes(Data & d) const
  {
    pin::computeABADerivatives(model, d, q, v, tau);
    return {sparse(d.ddq_dq), sparse(d.ddq_dv), symmetric(d.Minv)};
  }

  std::vector<Task> tasks() const
  {
    const auto local = pin::Convention::LOCAL, world = pin::Convention::WORLD;
    const std::vector<SX> of_q = {sq}, of_v = {sq, sv}, of_a = {sq, sv, sa}, of_tau = {sq, sv, stau};
    const auto six = [](const pin::ForceTpl<SX> & h) { return Outputs{swapped_rows(h.toVector())}; };
    return {
      {"inverse_dynamics", of_a, {[&](Data & d) -> Outputs { return {plain(pin::rnea(model, d, q, v, a))}; }}},
      {"mass_matrix", of_q, {[=](Data & d) { return mass(d, local); }, [=](Data & d) { return mass(d, world); }}},
      {"forward_dynamics", of_tau,
       {[=](Data & d) { return forward(d, local); }, [=](Data & d) { return forward(d, world); }, [&](Data & d) { return forward_by_mass(d); }}},
      {"inverse_dynamics_derivatives", of_a, {[&](Data & d) { return inverse_slopes(d); }}},
      {"forward_dynamics_derivatives", of_tau, {[&](Data & d) { return forward_slopes(d); }}},
      {"bias_forces", of_v, {[&](Data & d) -> Outputs { return {plain(pin::nonLinearEffects(model, d, q, v))}; }}},
      {"gravity_torque", of_q, {[&](Data & d) -> Outputs { return {plain(pin::computeGeneralizedGravity(model, d, q))}; }}},
      {"mass_matrix_inverse", of_q, {[&](Data & d) -> Outputs { return {symmetric(pin::computeMinverse(model, d, q))}; }}},
      {"solve_mass_matrix", {sq, stau}, {[&](Data & d) { return solved(d, tau); }}},
      {"coriolis_matrix", of_v, {[&](Data & d) -> Outputs { return {plain(pin::computeCoriolisMatrix(model, d, q, v).transpose())}; }}},
      {"kinetic_energy", of_v, {[&](Data & d) -> Outputs { return {pin::computeKineticEnergy(model, d, q, v)}; }}},
      {"potential_energy", of_q, {[&](Data & d) -> Outputs { return {pin::computePotentialEnergy(model, d, q)}; }}},
      {"center_of_mass", of_q, {[&](Data & d) -> Outputs { return {plain(pin::centerOfMass(model, d, q, false))}; }}},
      {"center_of_mass_velocity", of_v,
       {[&](Data & d) -> Outputs { pin::centerOfMass(model, d, q, v, false); return {plain(d.vcom[0])}; }}},
      {"center_of_mass_acceleration", of_a,
       {[&](Data & d) -> Outputs { pin::centerOfMass(model, d, q, v, a, false); return {plain(d.acom[0])}; }}},
      {"center_of_mass_jacobian", of_q,
       {[&](Data & d) -> Outputs { return {plain(pin::jacobianCenterOfMass(model, d, q, false).transpose())}; }}},
      {"centroidal_momentum", of_v, {[=](Data & d) { return six(pin::computeCentroidalMomentum(model, d, q, v)); }}},
      {"centroidal_momentum_rate", of_a, {[=](Data & d) { return six(pin::computeCentroidalMomentumTimeVariation(model, d, q, v, a)); }}},
      {"centroidal_momentum_matrix", of_q, {[&](Data & d) -> Outputs { return {swapped_rows(pin::computeCentroidalMap(model, d, q))}; }}},
    };
  }
};

// how many there are, without reading arguments, writing results and constants
int operations(const ::casadi::Function & code)
{
  int count = 0;
  for (int k = 0; k < code.n_instructions(); ++k)
  {
    const auto id = code.instruction_id(k);
    count += id != ::casadi::OP_INPUT && id != ::casadi::OP_OUTPUT && id != ::casadi::OP_CONST;
  }
  return count;
}

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// of each output its rows, its columns, and those of each number that is there
std::string outputs(const ::casadi::Function & code)
{
  std::ostringstream out;
  for (int k = 0; k < static_cast<int>(code.n_out()); ++k)
  {
    const ::casadi::Sparsity & there = code.sparsity_out(k);
    const auto rows = there.get_row(), columns = there.get_col();
    out << (k ? ", " : "") << "[" << there.size1() << ", " << there.size2() << ", [";
    for (std::size_t i = 0; i < rows.size(); ++i)
      out << (i ? ", " : "") << "[" << rows[i] << ", " << columns[i] << "]";
    out << "]]";
  }
  return out.str();
}

// The C code in the folder; what it cost, as JSON, or nothing if there are more operations than `most`. What other ways would have cost does not
// count. `before`: seconds that are this function's too.
std::string generate(const Robot & robot, const Task & task, const std::string & folder, const std::string & symbol, int most, double before)
{
  ::casadi::Function best;
  int fewest = 0;
  double took = 0;
  for (const Way & way : task.ways)
  {
    const auto start = Clock::now();
    Data data(robot.model);
    const ::casadi::Function code(symbol, task.arguments, way(data), {{"cse", true}});
    const double so_long = seconds_since(start);
    const int count = operations(code);
    if (best.is_null() || count < fewest)
      best = code, fewest = count, took = so_long;
  }
  if (fewest > most)
    return "";
  const auto start = Clock::now();
  ::casadi::CodeGenerator file(symbol + "_code.c");
  file.add(best);
  file.generate(folder + "/");
  took += before + seconds_since(start);
  std::ostringstream out;
  out << "\"" << task.function << "\": {\"work\": " << best.sz_w() << ", \"takes\": " << best.n_in() << ", \"outputs\": [" << outputs(best)
      << "], \"operations\": " << fewest << ", \"generation_seconds\": " << took << "}";
  return out.str();
}

std::string joints(const Model & model)
{
  std::ostringstream out;
  for (pin::JointIndex i = 1; i < static_cast<pin::JointIndex>(model.njoints); ++i)
    out << (i > 1 ? ", " : "") << "[\"" << model.names[i] << "\", " << model.joints[i].idx_q() << ", " << model.joints[i].idx_v() << ", "
        << model.joints[i].nq() << ", " << model.joints[i].nv() << "]";
  return out.str();
}

} // namespace

int main(int count, char ** words)
try
{
  if (count < 6)
    throw std::runtime_error("casadi_pinocchio FOLDER ROBOT URDF fixed|floating MOST [FUNCTION...]");
  const std::set<std::string> wanted(words + 6, words + count);
  const std::string folder = words[1], name = words[2];
  const auto start = Clock::now();
  const Robot robot(read(words[3], std::string(words[4]) == "floating").first);
  double before = seconds_since(start); // the first function pays for the reading
  std::cout << "{\"nq\": " << robot.model.nq << ", \"nv\": " << robot.model.nv << ", \"joints\": [" << joints(robot.model) << "], \"functions\": {";
  const char * separator = "";
  for (const Task & task : robot.tasks())
  {
    if (!wanted.empty() && !wanted.count(task.function))
      continue;
    const std::string made = generate(robot, task, folder, name + "_" + task.function, std::stoi(words[5]), before);
    if (!made.empty())
      std::cout << separator << made;
    before = 0, separator = ", ";
  }
  std::cout << "}}\n";
  return 0;
}
catch (const std::exception & error)
{
  std::cerr << (count > 3 ? words[3] : words[0]) << ": " << error.what() << "\n";
  return 1;
}
