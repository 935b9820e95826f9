// The functions, by their names in the registry; part of pinocchio_peer.cpp. What is one row of numbers, or the Coriolis
// matrix, is written to the last argument; all else stays in Pinocchio's data, and peer_read hands it out.

using In = const double *;

// ---- kinematics of frames

namespace
{

void place(Peer & p)
{
  for (const pin::FrameIndex frame : p.frames)
    pin::updateFramePlacement(p.model, p.data, frame);
}

} // namespace

PEER_API void peer_placements(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::forwardKinematics(p.model, p.data, p.q(q));
  place(p);
}

namespace
{

void twists(Peer & p, In q, In v, pin::ReferenceFrame reference)
{
  pin::forwardKinematics(p.model, p.data, p.q(q), p.v(v));
  if (reference != body)
    place(p);
  for (std::size_t k = 0; k < p.frames.size(); ++k)
    p.motions[k] = pin::getFrameVelocity(p.model, p.data, p.frames[k], reference);
}

template<typename A>
void accelerations(Peer & p, In q, In v, const A & a, pin::ReferenceFrame reference)
{
  pin::forwardKinematics(p.model, p.data, p.q(q), p.v(v), a);
  if (reference != body)
    place(p);
  for (std::size_t k = 0; k < p.frames.size(); ++k)
    p.motions[k] = reference == world_aligned ? pin::getFrameClassicalAcceleration(p.model, p.data, p.frames[k], reference)
                                              : pin::getFrameAcceleration(p.model, p.data, p.frames[k], reference);
}

// entries that are zero for every q are not written and stay zero
void jacobians(Peer & p, In q, pin::ReferenceFrame reference)
{
  if (p.frames.size() == 1) // the joints that carry it are enough
  {
    pin::computeFrameJacobian(p.model, p.data, p.q(q), p.frames[0], reference, p.jacobians[0]);
    return;
  }
  pin::computeJointJacobians(p.model, p.data, p.q(q));
  place(p);
  for (std::size_t k = 0; k < p.frames.size(); ++k)
    pin::getFrameJacobian(p.model, p.data, p.frames[k], reference, p.jacobians[k]);
}

void jacobian_rates(Peer & p, In q, In v, pin::ReferenceFrame reference)
{
  pin::computeJointJacobiansTimeVariation(p.model, p.data, p.q(q), p.v(v));
  place(p);
  for (std::size_t k = 0; k < p.frames.size(); ++k)
    pin::getFrameJacobianTimeVariation(p.model, p.data, p.frames[k], reference, p.jacobians[k]);
}

} // namespace

#define IN_REFERENCE(R)                                                                                                           \
  PEER_API void peer_twists_##R(void * handle, In q, In v) { twists(peer(handle), q, v, R); }                                      \
  PEER_API void peer_accelerations_##R(void * handle, In q, In v, In a) { accelerations(peer(handle), q, v, peer(handle).v(a), R); } \
  PEER_API void peer_bias_accelerations_##R(void * handle, In q, In v) { accelerations(peer(handle), q, v, peer(handle).zero, R); } \
  PEER_API void peer_jacobians_##R(void * handle, In q) { jacobians(peer(handle), q, R); }                                         \
  PEER_API void peer_jacobian_rates_##R(void * handle, In q, In v) { jacobian_rates(peer(handle), q, v, R); }

IN_REFERENCE(body)
IN_REFERENCE(world)
IN_REFERENCE(world_aligned)

// ---- forces

#define INTO(out) Eigen::Map<Vector>(out, p.model.nv)
#define INTO_MATRIX(out) Eigen::Map<Rows>(out, p.model.nv, p.model.nv)

PEER_API void peer_inverse_dynamics(void * handle, In q, In v, In a, double * tau)
{
  Peer & p = peer(handle);
  INTO(tau) = pin::rnea(p.model, p.data, p.q(q), p.v(v), p.v(a));
}

PEER_API void peer_inverse_dynamics_with_wrenches(void * handle, In q, In v, In a, In wrenches, double * tau)
{
  Peer & p = peer(handle);
  INTO(tau) = pin::rnea(p.model, p.data, p.q(q), p.v(v), p.v(a), p.carried(wrenches));
}

PEER_API void peer_joint_wrenches(void * handle, In q, In v, In a)
{
  Peer & p = peer(handle);
  pin::rnea(p.model, p.data, p.q(q), p.v(v), p.v(a));
}

PEER_API void peer_bias_forces(void * handle, In q, In v, double * tau)
{
  Peer & p = peer(handle);
  INTO(tau) = pin::nonLinearEffects(p.model, p.data, p.q(q), p.v(v));
}

PEER_API void peer_gravity_torque(void * handle, In q, double * tau)
{
  Peer & p = peer(handle);
  INTO(tau) = pin::computeGeneralizedGravity(p.model, p.data, p.q(q));
}

PEER_API void peer_static_torque(void * handle, In q, In wrenches, double * tau)
{
  Peer & p = peer(handle);
  INTO(tau) = pin::computeStaticTorque(p.model, p.data, p.q(q), p.carried(wrenches));
}

// ---- matrices and forward dynamics; of symmetric matrices only the upper triangle is computed

// Both stay in Pinocchio's data: to write out the lower triangle is no part of what is timed.
PEER_API void peer_mass_matrix(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::crba(p.model, p.data, p.q(q));
}

PEER_API void peer_mass_matrix_inverse(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::computeMinverse(p.model, p.data, p.q(q));
}

PEER_API int peer_keeps(void *, const char * function)
{
  const std::string name = function;
  return name == "mass_matrix" || name == "mass_matrix_inverse";
}

PEER_API void peer_coriolis_matrix(void * handle, In q, In v, double * C)
{
  Peer & p = peer(handle);
  INTO_MATRIX(C) = pin::computeCoriolisMatrix(p.model, p.data, p.q(q), p.v(v));
}

PEER_API void peer_forward_dynamics(void * handle, In q, In v, In tau, double * a)
{
  Peer & p = peer(handle);
  INTO(a) = pin::aba(p.model, p.data, p.q(q), p.v(v), p.v(tau));
}

PEER_API void peer_forward_dynamics_with_wrenches(void * handle, In q, In v, In tau, In wrenches, double * a)
{
  Peer & p = peer(handle);
  INTO(a) = pin::aba(p.model, p.data, p.q(q), p.v(v), p.v(tau), p.carried(wrenches));
}

PEER_API void peer_solve_mass_matrix(void * handle, In q, In tau, double * a)
{
  Peer & p = peer(handle);
  pin::crba(p.model, p.data, p.q(q));
  pin::cholesky::decompose(p.model, p.data);
  Eigen::Map<Vector> x(a, p.model.nv);
  x = p.v(tau);
  pin::cholesky::solve(p.model, p.data, x);
}

// ---- derivatives

PEER_API void peer_inverse_dynamics_derivatives(void * handle, In q, In v, In a)
{
  Peer & p = peer(handle);
  pin::computeRNEADerivatives(p.model, p.data, p.q(q), p.v(v), p.v(a));
}

PEER_API void peer_inverse_dynamics_derivatives_with_wrenches(void * handle, In q, In v, In a, In wrenches)
{
  Peer & p = peer(handle);
  pin::computeRNEADerivatives(p.model, p.data, p.q(q), p.v(v), p.v(a), p.carried(wrenches));
}

PEER_API void peer_forward_dynamics_derivatives(void * handle, In q, In v, In tau)
{
  Peer & p = peer(handle);
  pin::computeABADerivatives(p.model, p.data, p.q(q), p.v(v), p.v(tau));
}

PEER_API void peer_forward_dynamics_derivatives_with_wrenches(void * handle, In q, In v, In tau, In wrenches)
{
  Peer & p = peer(handle);
  pin::computeABADerivatives(p.model, p.data, p.q(q), p.v(v), p.v(tau), p.carried(wrenches));
}

PEER_API void peer_static_torque_derivative(void * handle, In q, In wrenches, double * out)
{
  Peer & p = peer(handle);
  p.data.dtau_dq.setZero();
  pin::computeStaticTorqueDerivatives(p.model, p.data, p.q(q), p.carried(wrenches), p.data.dtau_dq);
  INTO_MATRIX(out) = p.data.dtau_dq;
}

// ---- energies and momentum

PEER_API void peer_kinetic_energy(void * handle, In q, In v, double * out)
{
  Peer & p = peer(handle);
  *out = pin::computeKineticEnergy(p.model, p.data, p.q(q), p.v(v));
}

PEER_API void peer_potential_energy(void * handle, In q, double * out)
{
  Peer & p = peer(handle);
  *out = pin::computePotentialEnergy(p.model, p.data, p.q(q));
}

PEER_API void peer_center_of_mass(void * handle, In q, double * out)
{
  Peer & p = peer(handle);
  Eigen::Map<Eigen::Vector3d> into(out);
  into = pin::centerOfMass(p.model, p.data, p.q(q), false);
}

PEER_API void peer_center_of_mass_velocity(void * handle, In q, In v, double * out)
{
  Peer & p = peer(handle);
  pin::centerOfMass(p.model, p.data, p.q(q), p.v(v), false);
  Eigen::Map<Eigen::Vector3d> into(out);
  into = p.data.vcom[0];
}

PEER_API void peer_center_of_mass_acceleration(void * handle, In q, In v, In a, double * out)
{
  Peer & p = peer(handle);
  pin::centerOfMass(p.model, p.data, p.q(q), p.v(v), p.v(a), false);
  Eigen::Map<Eigen::Vector3d> into(out);
  into = p.data.acom[0];
}

PEER_API void peer_center_of_mass_jacobian(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::jacobianCenterOfMass(p.model, p.data, p.q(q), false);
}

namespace
{

void momentum(const pin::Force & h, double * out)
{
  Eigen::Map<Six> six(out);
  six.head<3>() = h.angular();
  six.tail<3>() = h.linear();
}

} // namespace

PEER_API void peer_centroidal_momentum(void * handle, In q, In v, double * out)
{
  Peer & p = peer(handle);
  momentum(pin::computeCentroidalMomentum(p.model, p.data, p.q(q), p.v(v)), out);
}

PEER_API void peer_centroidal_momentum_rate(void * handle, In q, In v, In a, double * out)
{
  Peer & p = peer(handle);
  momentum(pin::computeCentroidalMomentumTimeVariation(p.model, p.data, p.q(q), p.v(v), p.v(a)), out);
}

PEER_API void peer_centroidal_momentum_matrix(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::computeCentroidalMap(p.model, p.data, p.q(q));
}

// ---- regressors

PEER_API void peer_torque_regressor(void * handle, In q, In v, In a)
{
  Peer & p = peer(handle);
  pin::computeJointTorqueRegressor(p.model, p.data, p.q(q), p.v(v), p.v(a));
}

PEER_API void peer_kinetic_energy_regressor(void * handle, In q, In v)
{
  Peer & p = peer(handle);
  pin::computeKineticEnergyRegressor(p.model, p.data, p.q(q), p.v(v));
}

PEER_API void peer_potential_energy_regressor(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::computePotentialEnergyRegressor(p.model, p.data, p.q(q));
}

// ---- operational space: no function of Pinocchio's, but made of them as its users do

PEER_API void peer_operational_space_inertia_inverse(void * handle, In q)
{
  Peer & p = peer(handle);
  pin::computeMinverse(p.model, p.data, p.q(q));
  p.data.Minv.triangularView<Eigen::StrictlyLower>() = p.data.Minv.transpose().triangularView<Eigen::StrictlyLower>();
  pin::computeJointJacobians(p.model, p.data);
  place(p);
  for (std::size_t k = 0; k < p.frames.size(); ++k)
  {
    Matrix6x & J = p.jacobians[k];
    pin::getFrameJacobian(p.model, p.data, p.frames[k], world_aligned, J);
    p.data.dFdv.noalias() = J * p.data.Minv;
    p.inertias[k].noalias() = p.data.dFdv * J.transpose();
  }
}

PEER_API void peer_operational_space_inertia(void * handle, In q)
{
  peer_operational_space_inertia_inverse(handle, q);
  for (Matrix6 & inverse : peer(handle).inertias)
    inverse = inverse.llt().solve(Matrix6::Identity());
}

// ---- configurations

PEER_API void peer_integrate(void * handle, In q, In step, double * out)
{
  Peer & p = peer(handle);
  Eigen::Map<Vector> into(out, p.model.nq);
  pin::integrate(p.model, p.q(q), p.v(step), into);
}

PEER_API void peer_difference(void * handle, In q, In target, double * out)
{
  Peer & p = peer(handle);
  Eigen::Map<Vector> into(out, p.model.nv);
  pin::difference(p.model, p.q(q), p.q(target), into);
}
