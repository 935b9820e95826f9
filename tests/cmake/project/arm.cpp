// Laws of the arm of three joints, by its generated C through views of Eigen.
#include "laws.hpp"

#include <Eigen/Cholesky>

#include <arm.h>
#include <articulated/eigen.hpp>

namespace view = articulated::eigen;
using Joints = view::Vector<ARM_NV>;
using Mass = view::Matrix<ARM_NV, ARM_NV>;

static Mass mass(const Joints &q) {
    Mass result;
    arm_mass_matrix(view::in<ARM_NQ>(q), view::out<ARM_NV * ARM_NV>(result));
    return result;
}

static Joints torques(const Joints &q, const Joints &v, const Joints &a) {
    Joints result;
    arm_inverse_dynamics(view::in<ARM_NQ>(q), view::in<ARM_NV>(v), view::in<ARM_NV>(a), view::out<ARM_NV>(result));
    return result;
}

static Joints accelerations(const Joints &q, const Joints &v, const Joints &tau) {
    Joints result;
    arm_forward_dynamics(view::in<ARM_NQ>(q), view::in<ARM_NV>(v), view::in<ARM_NV>(tau), view::out<ARM_NV>(result));
    return result;
}

/// M is symmetric, positive definite, and the derivative of the torques by the accelerations, which
/// are linear.
static void check_mass(const Joints &q, const Joints &v, const Joints &a) {
    const Mass m = mass(q);
    expect("M = transpose of M", (m - m.transpose()).norm(), 1e-15);
    expect("M is positive definite", m.llt().info() == Eigen::Success ? 0.0 : 1.0, 0.0);
    const Joints expected = torques(q, v, a) - torques(q, v, Joints::Zero());
    expect("M a = ID(a) - ID(0)", (m * a - expected).norm(), 1e-13);
}

static void check_dynamics(const Joints &q, const Joints &v, const Joints &tau) {
    const Joints a = accelerations(q, v, tau);
    expect("ID(FD(tau)) = tau", (torques(q, v, a) - tau).norm(), 1e-12);
    // The power of the torques is the rate of the kinetic energy and the power against gravity, by
    // central differences along the motion.
    const double h = 1e-6;
    const Joints change = h * v + 0.5 * h * h * a, back = -h * v + 0.5 * h * h * a;
    const auto kinetic = [](const Joints &at, const Joints &rate) { return 0.5 * rate.dot(mass(at) * rate); };
    const double rate = (kinetic(q + change, v + h * a) - kinetic(q + back, v - h * a)) / (2.0 * h);
    const Joints gravity = torques(q, Joints::Zero(), Joints::Zero());
    expect("dT/dt = v (tau - g)", std::abs(rate - v.dot(tau - gravity)), 1e-6);
}

/// The tool is 0.35 m along the fore, which is on the upper at 0.4 m, which is on the base at 0.3
/// m.
static void check_placements(const Joints &q) {
    view::Matrix<ARM_FRAMES, 12> placements;
    arm_placements(view::in<ARM_NQ>(q), view::out<ARM_FRAMES * 12>(placements));
    const double yaw = q[ARM_Q_INDEX_YAW], elbow = q[ARM_Q_INDEX_ELBOW], wrist = q[ARM_Q_INDEX_WRIST];
    const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d where = turn * Eigen::Vector3d(0.35 * std::sin(elbow), 0.0, 0.7 + 0.35 * std::cos(elbow));
    const Eigen::Matrix3d axes = (turn * Eigen::AngleAxisd(elbow + wrist, Eigen::Vector3d::UnitY())).toRotationMatrix();
    expect("position of the tool", (view::position(placements, ARM_FRAME_TOOL) - where).norm(), 1e-15);
    expect("rotation of the tool", (view::rotation(placements, ARM_FRAME_TOOL) - axes).norm(), 1e-15);
    const Eigen::Isometry3d tool = view::isometry(placements, ARM_FRAME_TOOL);
    const Eigen::Vector3d tip(0.0, 0.1, 0.2);
    expect("placement of the tool", (tool * tip - (axes * tip + where)).norm(), 1e-15);
    for (int frame = 0; frame < ARM_FRAMES; frame++) {
        const Eigen::Matrix3d rotation = view::rotation(placements, frame);
        expect("R is orthonormal", (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
        expect("det R = 1", std::abs(rotation.determinant() - 1.0), 1e-14);
    }
}

/// Views of arrays that are no matrices of Eigen, and of those whose size is known at run time.
static void check_arrays(const Joints &q) {
    double flat[ARM_NV * ARM_NV], *const pointer = flat;
    arm_mass_matrix(q.data(), view::out<ARM_NV * ARM_NV>(flat));
    expect("a view of a C array", (view::matrix<ARM_NV, ARM_NV>(flat) - mass(q)).norm(), 0.0);
    view::matrix<ARM_NV, ARM_NV>(pointer)(1, 2) = 7.0;
    expect("a view of a pointer", std::abs(flat[ARM_NV + 2] - 7.0), 0.0);
    const Eigen::VectorXd dynamic = q;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> m(ARM_NV, ARM_NV);
    arm_mass_matrix(view::in<ARM_NQ>(dynamic), view::out<ARM_NV * ARM_NV>(m));
    expect("dynamic matrices", (m - mass(q)).norm(), 0.0);
    arm_mass_matrix(view::in<ARM_NQ>(dynamic), view::out<ARM_NV * ARM_NV>(view::matrix<ARM_NV, ARM_NV>(flat)));
    expect("maps", (view::matrix<ARM_NV, ARM_NV>(flat) - mass(q)).norm(), 0.0);
    // Constant arrays and single precision have views of their own kind.
    const float single[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 3, 4};
    static_assert(std::is_same<decltype(view::position(single)), Eigen::Map<const Eigen::Vector3f>>::value, "a constant view");
    expect("single precision", static_cast<double>((view::isometry(single).translation() - Eigen::Vector3f(2, 3, 4)).norm()), 0.0);
}

int main() {
    unsigned seed = 1;
    for (int k = 0; k < 20; k++) {
        const Joints q = 2.0 * draw<ARM_NQ>(seed), v = 2.0 * draw<ARM_NV>(seed), other = 10.0 * draw<ARM_NV>(seed);
        check_mass(q, v, other);
        check_dynamics(q, v, other);
        check_placements(q);
        check_arrays(q);
    }
    std::printf("fixed: ok\n");
    return 0;
}
