// Laws of a quadruped on a floating base, compiled as C: quaternions, twists and Jacobians.
#include "laws.hpp"

#include <legs.h>

#include <articulated/eigen.hpp>

namespace view = articulated::eigen;
using Configuration = view::Vector<LEGS_NQ>;
using Rates = view::Vector<LEGS_NV>;
using Placements = view::Matrix<LEGS_FRAMES, 12>;

static Configuration moved(const Configuration &q, const Rates &step) {
    Configuration result;
    legs_integrate(view::in<LEGS_NQ>(q), view::in<LEGS_NV>(step), view::out<LEGS_NQ>(result));
    return result;
}

static Placements placements(const Configuration &q) {
    Placements result;
    legs_placements(view::in<LEGS_NQ>(q), view::out<LEGS_FRAMES * 12>(result));
    return result;
}

/// The numbers of a floating base are a position and a quaternion, which Eigen reads in place, and
/// writes.
static void check_base(Configuration q) {
    const Placements at = placements(q);
    const auto trunk = view::quaternion(q, LEGS_Q_INDEX___FLOATING_BASE__ + 3);
    expect("rotation of the base", (trunk.toRotationMatrix() - view::rotation(at, LEGS_FRAME_TRUNK)).norm(), 1e-14);
    expect("position of the base", (q.head<3>() - view::position(at, LEGS_FRAME_TRUNK)).norm(), 0.0);
    // A turn in the axes of the base is a factor on the right.
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d(2.0, 1.0, 2.0) / 3.0));
    Rates step = Rates::Zero();
    view::angular(step.head<6>()) = 0.3 * Eigen::Vector3d(2.0, 1.0, 2.0) / 3.0;
    const Configuration turned = moved(q, step);
    expect("integrate", (view::quaternion(turned, 3).coeffs() - (trunk * turn).coeffs()).norm(), 1e-14);
    view::quaternion(q, 3) = turn;
    expect("a quaternion is written in place", std::abs(q[6] - std::cos(0.15)), 1e-15);
}

/// Twists are the rates of placements, and Jacobians times rates.
static void check_twists(const Configuration &q, const Rates &v) {
    view::Matrix<LEGS_FRAMES, 6> twists;
    legs_twists_world_aligned(view::in<LEGS_NQ>(q), view::in<LEGS_NV>(v), view::out<LEGS_FRAMES * 6>(twists));
    view::Matrix<LEGS_FRAMES * 6, LEGS_NV> jacobians;
    legs_jacobians_world_aligned(view::in<LEGS_NQ>(q), view::out<LEGS_FRAMES * 6 * LEGS_NV>(jacobians));
    const double h = 1e-6;
    const Placements at = placements(q), ahead = placements(moved(q, h * v)), behind = placements(moved(q, -h * v));
    for (int frame = 0; frame < LEGS_FRAMES; frame++) {
        const Eigen::Vector3d rate = (view::position(ahead, frame) - view::position(behind, frame)) / (2.0 * h);
        expect("linear part of a twist", (view::linear(twists, frame) - rate).norm(), 1e-8);
        const Eigen::Matrix3d turn = (view::rotation(ahead, frame) - view::rotation(behind, frame)) / (2.0 * h);
        const Eigen::Matrix3d cross = turn * view::rotation(at, frame).transpose();
        const Eigen::Vector3d spin(cross(2, 1), cross(0, 2), cross(1, 0));
        expect("angular part of a twist", (view::angular(twists, frame) - spin).norm(), 1e-8);
        view::Vector<6> expected = view::jacobian<LEGS_NV>(jacobians, frame) * v;
        expect("J v", (expected - twists.row(frame).transpose()).norm(), 1e-13);
    }
}

/// The holding torques are the slope of the potential energy.
static void check_slope(const Configuration &q) {
    Rates slope, torques;
    const Rates still = Rates::Zero();
    legs_slope(view::in<LEGS_NQ>(q), view::out<LEGS_NV>(slope));
    legs_inverse_dynamics(view::in<LEGS_NQ>(q), view::in<LEGS_NV>(still), view::in<LEGS_NV>(still), view::out<LEGS_NV>(torques));
    expect("dU/dq = g", (slope - torques).norm(), 1e-10);
}

int main() {
    unsigned seed = 2;
    Configuration neutral;
    for (int k = 0; k < LEGS_NQ; k++) {
        neutral[k] = legs_neutral[k];
    }
    for (int k = 0; k < 20; k++) {
        const Configuration q = moved(neutral, 1.5 * draw<LEGS_NV>(seed));
        check_base(q);
        check_twists(q, draw<LEGS_NV>(seed));
        check_slope(q);
    }
    std::printf("floating: ok\n");
    return 0;
}
