// CasADi's numbers as vectors of eight, one state in each lane: what its C code is compiled with in place of `double`. GCC's vector extensions,
// and the polynomials of casadi_sine.h.
#pragma once

#include <math.h>

namespace lanes
{

constexpr int LANES = 8;

using Numbers = double __attribute__((vector_size(8 * LANES)));
using Whole = long long __attribute__((vector_size(8 * LANES)));

#define INLINE inline __attribute__((always_inline))

// What a C++ compiler takes for a number where CasADi writes one.
struct Real
{
  Numbers x;

  Real() = default;
  INLINE Real(Numbers y)
  : x(y)
  {
  }
  INLINE Real(double y)
  : x(y - Numbers{})
  {
  }
};

INLINE Real operator+(Real a, Real b) { return a.x + b.x; }
INLINE Real operator-(Real a, Real b) { return a.x - b.x; }
INLINE Real operator*(Real a, Real b) { return a.x * b.x; }
INLINE Real operator/(Real a, Real b) { return a.x / b.x; }
INLINE Real operator-(Real a) { return -a.x; }

template<typename Of>
INLINE Numbers each(Of of)
{
  Numbers result;
  for (int i = 0; i < LANES; ++i)
    result[i] = of(i);
  return result;
}

INLINE Numbers fused(Numbers a, Numbers b, Numbers c)
{
  return each([&](int i) { return __builtin_fma(a[i], b[i], c[i]); });
}

// sin(x + quarters pi/2)
INLINE Real sine(Real angle, int quarters)
{
  const Numbers x = angle.x, zero = {};
  const Numbers turns = x * 0.6366197723675814;
  const Numbers n = each([&](int i) { return __builtin_rint(turns[i]); });
  const Numbers r = fused(-n, zero + 6.123233995736766e-17, fused(-n, zero + 1.5707963267948966, x)), z = r * r;
  const Numbers s = -0.16666666666666666 + z * (0.008333333333330948 + z * (-0.00019841269836758574 + z * (2.755731610255244e-06
                    + z * (-2.5051131845003624e-08 + z * 1.5918129294866608e-10))));
  const Numbers c = 0.041666666666666664 + z * (-0.0013888888888887398 + z * (2.480158729876569e-05 + z * (-2.7557317271729793e-07
                    + z * (2.08761462684032e-09 + z * -1.1382632425521717e-11))));
  const Whole k = __builtin_convertvector(n, Whole) + quarters;
  const Numbers y = (k & 1) != 0 ? 1 - 0.5 * z + z * z * c : r + r * z * s;
  return (k & 2) != 0 ? -y : y;
}

INLINE Real sin(Real x) { return sine(x, 0); }
INLINE Real cos(Real x) { return sine(x, 1); }
INLINE Real sqrt(Real x)
{
  return each([&](int i) { return __builtin_sqrt(x.x[i]); });
}

} // namespace lanes

using lanes::cos;
using lanes::sin;
using lanes::sqrt;

#define casadi_real lanes::Real
