// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Views of the arrays of generated C for Eigen (3.3 or later). C++14.
//
//     #include <arm.h>                  // articulated generate arm.urdf --language c -o arm.h
//     #include <articulated/eigen.hpp>
//     namespace view = articulated::eigen;
//
//     view::Vector<ARM_NQ> q = view::Vector<ARM_NQ>::Zero();
//     view::Matrix<ARM_NV, ARM_NV> mass;
//     view::Matrix<ARM_FRAMES, 12> placements;
//     arm_mass_matrix(view::in<ARM_NQ>(q), view::out<ARM_NV * ARM_NV>(mass));
//     arm_placements(view::in<ARM_NQ>(q), view::out<ARM_FRAMES * 12>(placements));
//     Eigen::Vector3d tool = view::position(placements, ARM_FRAME_TOOL); // m, in the world frame
//
// Views are maps: they copy nothing, and are valid as long as the array. Views of constant arrays
// are constant. An array is a matrix, vector or map of Eigen, a C array, or a pointer (`data()` of
// a std::vector). Its length is compared when the program is compiled, that of a dynamic matrix by
// eigen_assert, and that of a pointer not at all.
//
// Units are SI and radians. 6-vectors are (angular; linear), quaternions (x, y, z, w), and matrices
// go row by row.

#ifndef ARTICULATED_EIGEN_HPP
#define ARTICULATED_EIGEN_HPP

#include <cstddef>
#include <type_traits>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace articulated {
namespace eigen {

/// A vector that owns its numbers: q [NQ]; v, a, tau [NV].
template <int Size, typename Scalar = double>
using Vector = Eigen::Matrix<Scalar, Size, 1>;

/// A matrix that owns its numbers, row by row as generated C has them: the mass matrix [NV][NV],
/// placements [FRAMES][12], twists [FRAMES][6]. An array of three dimensions is one below the
/// other: Jacobians [FRAMES * 6][NV].
template <int Rows, int Columns, typename Scalar = double>
using Matrix = Eigen::Matrix<Scalar, Rows, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

namespace detail {

/// The type of the numbers of an array, how many they are (`size` of the type, `count` of an
/// array), and where. This one is for matrices and maps of Eigen.
template <typename Array>
struct Numbers {
    using Plain = std::remove_cv_t<Array>;
    using Type = std::remove_pointer_t<decltype(std::declval<Array &>().data())>;
    static constexpr int size = Plain::SizeAtCompileTime;
    static constexpr bool is_vector = Plain::IsVectorAtCompileTime;
    static_assert(is_vector || Plain::IsRowMajor,
                  "articulated: this matrix goes column by column; use articulated::eigen::Matrix, or Eigen::RowMajor");
    static_assert(Plain::InnerStrideAtCompileTime == 1, "articulated: the numbers of this array are not one after the other");
    static_assert(is_vector || size == Eigen::Dynamic || int(Plain::OuterStrideAtCompileTime) == int(Plain::InnerSizeAtCompileTime),
                  "articulated: the rows of this matrix are not one after the other");

    static Eigen::Index count(Array &array) { return array.size(); }
    static Type *of(Array &array) {
        eigen_assert(is_vector || array.outerStride() == array.cols());
        return array.data();
    }
};

template <typename T, int N>
struct Pointed {
    using Type = T;
    static constexpr int size = N;
    static Eigen::Index count(T *) { return N; }
    static T *of(T *array) { return array; }
};

template <typename T, std::size_t N>
struct Numbers<T[N]> : Pointed<T, static_cast<int>(N)> {};

/// Pointers: the number of numbers is not known.
template <typename T>
struct Numbers<T *> : Pointed<T, Eigen::Dynamic> {};

template <typename T>
struct Numbers<T *const> : Pointed<T, Eigen::Dynamic> {};

template <typename Array>
using NumbersOf = Numbers<std::remove_reference_t<Array>>;

/// `Size` numbers, which are the whole array.
template <int Size, typename Array>
typename NumbersOf<Array>::Type *whole(Array &array) {
    using Its = NumbersOf<Array>;
    static_assert(Its::size == Size || Its::size == Eigen::Dynamic, "articulated: the array has another length than the function's");
    eigen_assert(Its::count(array) == Size || Its::count(array) == Eigen::Dynamic);
    return Its::of(array);
}

/// `Width` numbers of an array of several, beginning at number `Width * index + offset`.
template <int Width, typename Array>
typename NumbersOf<Array>::Type *part(Array &array, int index, int offset = 0) {
    using Its = NumbersOf<Array>;
    static_assert(Its::size == Eigen::Dynamic || Its::size % Width == 0, "articulated: the array has rows of another length");
    eigen_assert(index >= 0 && (Its::count(array) == Eigen::Dynamic || (index + 1) * Width <= Its::count(array)));
    return Its::of(array) + Width * index + offset;
}

/// A map of numbers of type T; constant if T is.
template <typename T, int Rows, int Columns>
using Map = Eigen::Map<std::conditional_t<std::is_const<T>::value, const Matrix<Rows, Columns, std::remove_const_t<T>>,
                                          Matrix<Rows, Columns, std::remove_const_t<T>>>>;

} // namespace detail

/// The pointer to an argument of `Size` numbers. `array` stays as it is.
template <int Size, typename Array>
const typename detail::NumbersOf<Array>::Type *in(const Array &array) {
    return detail::whole<Size>(array);
}

/// The pointer to a result of `Size` numbers, which the function writes. It must not overlap
/// arguments.
template <int Size, typename Array>
auto out(Array &&array) {
    static_assert(!std::is_const<typename detail::NumbersOf<Array>::Type>::value, "articulated: a function cannot write a constant array");
    return detail::whole<Size>(array);
}

/// An array [Rows][Columns].
template <int Rows, int Columns, typename Array>
auto matrix(Array &&array) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, Rows, Columns>(detail::whole<Rows * Columns>(array));
}

/// The rotation of a frame [3][3]: its columns are the axes of the frame in the world frame.
/// `placements`: [FRAMES][12].
template <typename Array>
auto rotation(Array &&placements, int frame = 0) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, 3, 3>(detail::part<12>(placements, frame));
}

/// The origin of a frame [3], m, in the world frame. `placements`: [FRAMES][12].
template <typename Array>
auto position(Array &&placements, int frame = 0) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, 3, 1>(detail::part<12>(placements, frame, 9));
}

/// The placement of a frame, from its axes to those of the world frame. Eigen has these numbers in
/// another order, so this is a copy. `placements`: [FRAMES][12].
template <typename Array>
auto isometry(Array &&placements, int frame = 0) {
    using Scalar = std::remove_const_t<typename detail::NumbersOf<Array>::Type>;
    Eigen::Transform<Scalar, 3, Eigen::Isometry> copy = Eigen::Transform<Scalar, 3, Eigen::Isometry>::Identity();
    copy.linear() = rotation(placements, frame);
    copy.translation() = position(placements, frame);
    return copy;
}

/// The first three numbers of a 6-vector: angular velocity (rad/s) or acceleration, moment (N m).
/// `sixes`: [FRAMES][6].
template <typename Array>
auto angular(Array &&sixes, int frame = 0) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, 3, 1>(detail::part<6>(sixes, frame));
}

/// The last three numbers of a 6-vector: velocity (m/s) or acceleration, force (N). `sixes`:
/// [FRAMES][6].
template <typename Array>
auto linear(Array &&sixes, int frame = 0) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, 3, 1>(detail::part<6>(sixes, frame, 3));
}

/// The Jacobian of a frame [6][Nv], rows (angular; linear). `jacobians`: [FRAMES][6][Nv].
template <int Nv, typename Array>
auto jacobian(Array &&jacobians, int frame = 0) {
    return detail::Map<typename detail::NumbersOf<Array>::Type, 6, Nv>(detail::part<6 * Nv>(jacobians, frame));
}

/// The quaternion (x, y, z, w) at number `first` of a configuration. A floating base has three
/// numbers before its own: `quaternion(q, 3)`, from the axes of the root link to those of the world
/// frame.
template <typename Array>
auto quaternion(Array &&q, int first) {
    using Its = detail::NumbersOf<Array>;
    using Plain = Eigen::Quaternion<std::remove_const_t<typename Its::Type>>;
    eigen_assert(first >= 0 && (Its::count(q) == Eigen::Dynamic || first + 4 <= Its::count(q)));
    return Eigen::Map<std::conditional_t<std::is_const<typename Its::Type>::value, const Plain, Plain>>(Its::of(q) + first);
}

} // namespace eigen
} // namespace articulated

#endif
