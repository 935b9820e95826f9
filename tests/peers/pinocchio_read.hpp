// peer_read: results that the functions keep, in the registry's layout (angular before linear, row by row, moments as m, h, xx xy xz yy yz
// zz), columns in the order of the peer's own v; part of pinocchio_peer.cpp. Not timed.

namespace
{

struct Writer
{
  double * out;

  void number(double x) { *out++ = x; }

  template<typename M>
  void matrix(const M & m)
  {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j)
        number(m(i, j));
  }

  // rows (linear; angular) as (angular; linear)
  template<typename M>
  void swapped(const M & m)
  {
    matrix(m.template bottomRows<3>());
    matrix(m.template topRows<3>());
  }

  // ten columns for each joint; theirs: m h xx xy yy xz yz zz
  template<typename M>
  void moments(const M & m)
  {
    const int order[] = {0, 1, 2, 3, 4, 5, 7, 6, 8, 9};
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j)
        number(m(i, j / 10 * 10 + order[j % 10]));
  }

  void symmetric(const Matrix & m) { matrix(Matrix(m.selfadjointView<Eigen::Upper>())); }
};

void read_placements(Peer & p, Writer & w)
{
  for (const pin::FrameIndex k : p.frames)
  {
    w.matrix(p.data.oMf[k].rotation());
    w.matrix(p.data.oMf[k].translation());
  }
}

void read_motions(Peer & p, Writer & w)
{
  for (const pin::Motion & m : p.motions)
    w.swapped(m.toVector());
}

void read_jacobians(Peer & p, Writer & w)
{
  for (const Matrix6x & J : p.jacobians)
    w.swapped(J);
}

void read_inertias(Peer & p, Writer & w)
{
  for (const Matrix6 & m : p.inertias)
  {
    Matrix6 turned; // both sides (angular; linear)
    turned << m.bottomRightCorner<3, 3>(), m.bottomLeftCorner<3, 3>(), m.topRightCorner<3, 3>(), m.topLeftCorner<3, 3>();
    w.matrix(turned);
  }
}

void read_inverse_slopes(Peer & p, Writer & w)
{
  w.matrix(p.data.dtau_dq);
  w.matrix(p.data.dtau_dv);
  w.symmetric(p.data.M);
}

void read_forward_slopes(Peer & p, Writer & w)
{
  w.matrix(p.data.ddq_dq);
  w.matrix(p.data.ddq_dv);
  w.symmetric(p.data.Minv);
}

void read_joint_wrenches(Peer & p, Writer & w)
{
  for (int i = 1; i < p.model.njoints; ++i)
    w.swapped(p.data.f[i].toVector());
}

using Read = std::function<void(Peer &, Writer &)>;

const std::map<std::string, Read> & readers()
{
  static const std::map<std::string, Read> known = [] {
    std::map<std::string, Read> all = {
      {"placements", read_placements},
      {"joint_wrenches", read_joint_wrenches},
      {"mass_matrix", [](Peer & p, Writer & w) { w.symmetric(p.data.M); }},
      {"mass_matrix_inverse", [](Peer & p, Writer & w) { w.symmetric(p.data.Minv); }},
      {"inverse_dynamics_derivatives", read_inverse_slopes},
      {"inverse_dynamics_derivatives_with_wrenches", read_inverse_slopes},
      {"forward_dynamics_derivatives", read_forward_slopes},
      {"forward_dynamics_derivatives_with_wrenches", read_forward_slopes},
      {"operational_space_inertia", read_inertias},
      {"operational_space_inertia_inverse", read_inertias},
      {"center_of_mass_jacobian", [](Peer & p, Writer & w) { w.matrix(p.data.Jcom); }},
      {"centroidal_momentum_matrix", [](Peer & p, Writer & w) { w.swapped(p.data.Ag); }},
      {"torque_regressor", [](Peer & p, Writer & w) { w.moments(p.data.jointTorqueRegressor); }},
      {"kinetic_energy_regressor", [](Peer & p, Writer & w) { w.moments(p.data.kineticEnergyRegressor); }},
      {"potential_energy_regressor", [](Peer & p, Writer & w) { w.moments(p.data.potentialEnergyRegressor); }},
    };
    for (const std::string reference : {"body", "world", "world_aligned"})
    {
      for (const std::string name : {"twists_", "accelerations_", "bias_accelerations_"})
        all[name + reference] = read_motions;
      for (const std::string name : {"jacobians_", "jacobian_rates_"})
        all[name + reference] = read_jacobians;
    }
    return all;
  }();
  return known;
}

} // namespace

PEER_API int peer_read(void * handle, const char * function, double * out)
{
  const auto found = readers().find(function);
  if (found == readers().end())
    return 0;
  Writer writer{out};
  found->second(peer(handle), writer);
  return 1;
}
